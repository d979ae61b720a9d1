"""Recordings in CSV: a column ``time`` in seconds, and one for each variable."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, TextIO

from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import YamlSource
from rosa_streams.errors import StreamError
from rosa_streams.temporal import Formula, Monitor, Verdict, variables
from rosa_streams.temporal.evaluation import text_variables
from rosa_streams.temporal.formula import Comparison, Distance, Number, Spatial, atoms

_ROWS_AT_ONCE = 20_000
_LONGEST_FIELD = 1_000_000
_WORDS = {"true": 1.0, "false": 0.0}


@dataclass(frozen=True, slots=True)
class Rows:
    """Some rows of a recording: times, and the values of each variable; ``line`` is that of the first row."""

    line: int
    times: list[float]
    columns: Mapping[str, list[Any]]


def monitor_recording(formula: Formula, file: str | PathLike[str], regions: Mapping[str, Any] | None = None) -> Monitor:
    """Evaluate a formula at the first state of a recording.

    Args:
        formula: its variables are columns of the recording, or regions.
        file: CSV; an empty field is an unknown value.
        regions: see :class:`~rosa_streams.temporal.Monitor`.

    Returns:
        the monitor after the recording; ``verdict`` and ``known_at`` say what came out.

    Raises:
        StreamError: for a recording that cannot be read, with the line.
    """
    monitor = Monitor(formula, regions)
    needed = [name for name in variables(formula) if name not in (regions or {})]
    for rows in read_rows(file, needed, formula):
        monitor.run(rows.times, rows.columns)
        if monitor.verdict is not Verdict.UNKNOWN:
            break
    return monitor


def read_rows(file: str | PathLike[str], needed: list[str], formula: Formula) -> Iterator[Rows]:
    """The rows of a recording in pieces, values read as the formula's atoms take them.

    Raises:
        StreamError: if the file or a value cannot be read, a column is missing, or times do not grow.
    """
    path = Path(file)
    where = Location(str(file))
    if path.suffix.lower() not in {".csv", ".txt"}:
        hint = "write it as CSV with a column 'time' in seconds"
        raise StreamError(Problem(f"a recording of the kind '{path.suffix}' cannot be read", where, hint))
    try:
        with path.open(encoding="utf-8-sig", newline="") as text:
            yield from _Reader(text, str(file), needed, formula).pieces()
    except OSError as error:
        raise StreamError(Problem(f"cannot read it: {error.strerror}", where)) from None
    except UnicodeDecodeError:
        raise StreamError(Problem("it is not UTF-8 text", where)) from None


def read_regions(file: str | PathLike[str]) -> dict[str, Any]:
    """Regions by name from YAML: each a list of points, or WKT.

    Raises:
        StreamError: if one of them is no region.
    """
    from rosa_streams.temporal.spatial import geometry

    source = YamlSource(file)
    if not isinstance(source.data, dict):
        raise StreamError(Problem("regions are a mapping from names", source.location(())))
    regions = {}
    for name, value in source.data.items():
        try:
            regions[str(name)] = geometry(value)
        except StreamError as error:
            first = error.problems[0]
            raise StreamError(Problem(first.what, source.location((name,)), first.hint)) from None
    return regions


class _Reader:
    """Reads one file."""

    def __init__(self, text: TextIO, file: str, needed: list[str], formula: Formula) -> None:
        csv.field_size_limit(_LONGEST_FIELD)
        self._rows = csv.reader(text)
        self._file = file
        self._needed = needed
        self._texts = text_variables(atoms(formula)) | _spatial_variables(formula)
        self._numbers = _number_variables(formula)
        self._last = -math.inf

    def pieces(self) -> Iterator[Rows]:
        header = [name.strip() for name in self._next_row() or []]
        indices = {name: self._index(header, name) for name in ("time", *self._needed)}
        times: list[float] = []
        columns: dict[str, list[Any]] = {name: [] for name in self._needed}
        line = self._rows.line_num + 1
        while (row := self._next_row()) is not None:
            if not row:
                continue
            if len(row) != len(header):
                raise self._wrong(f"a row has {len(row)} fields, and the header {len(header)}")
            times.append(self._time(row[indices["time"]]))
            for name in self._needed:
                columns[name].append(self._value(name, row[indices[name]].strip()))
            if len(times) == _ROWS_AT_ONCE:
                yield Rows(line, times, columns)
                times, columns = [], {name: [] for name in self._needed}
                line = self._rows.line_num + 1
        if times:
            yield Rows(line, times, columns)

    def _next_row(self) -> list[str] | None:
        try:
            return next(self._rows, None)
        except csv.Error as error:
            raise self._wrong(f"not valid CSV: {error}") from None

    def _index(self, header: list[str], name: str) -> int:
        if header.count(name) != 1:
            what = f"there is no column '{name}'" if name not in header else f"two columns are named '{name}'"
            hint = nearest(name, header) or f"the columns are {', '.join(header) or 'none'}"
            raise StreamError(Problem(what, Location(self._file, 1), hint))
        return header.index(name)

    def _time(self, text: str) -> float:
        try:
            time = float(text)
        except ValueError:
            time = math.nan
        if not math.isfinite(time):
            raise self._wrong(f"the time '{text[:60]}' is no number of seconds")
        if time <= self._last:
            raise self._wrong(f"times grow: {text} does not come after {self._last:.9g}")
        self._last = time
        return time

    def _value(self, name: str, text: str) -> Any:
        if not text:
            return None if name in self._texts or name not in self._numbers else math.nan
        if name in self._texts:
            return text
        if text.lower() in _WORDS:
            return _WORDS[text.lower()]
        try:
            return float(text)
        except ValueError:
            if name in self._numbers:
                raise self._wrong(f"'{text[:60]}' in the column '{name}' is no number, true or false") from None
            return text

    def _wrong(self, what: str) -> StreamError:
        return StreamError(Problem(what, Location(self._file, self._rows.line_num)))


def _spatial_variables(formula: Formula) -> frozenset[str]:
    names: set[str] = set()
    for atom in atoms(formula):
        sides = (atom.left, atom.right) if isinstance(atom, Comparison) else (atom,)
        for side in sides:
            if isinstance(side, Distance | Spatial):
                names.update((side.first.name, side.second.name))
    return frozenset(names)


def _number_variables(formula: Formula) -> frozenset[str]:
    """The variables that stand alone or are compared with numbers; the others may be numbers or texts."""
    names = set(variables(formula))
    for atom in atoms(formula):
        if isinstance(atom, Comparison) and not isinstance(atom.left, Number) and not isinstance(atom.right, Number):
            names -= set(variables(atom))
    return frozenset(names)
