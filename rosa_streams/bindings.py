"""What is bound to streams, in YAML: measures by tag or by formula, and components by the measures that they need.

::

    measures:
      ball_x: {tag: "Position and (hasSource some Ball)", field: x}
      ball_near: {formula: "O[0,3] ball > 0", streams: {ball: {tag: Position, field: x}}, max_age: 2}
    components:
      tracker: [ball_x]
"""

from __future__ import annotations

from dataclasses import dataclass
from os import PathLike
from typing import Any

from rosa_core.errors import InputError, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource
from rosa_streams.errors import StreamError
from rosa_streams.join import FormulaMeasure, StreamMeasure
from rosa_streams.query import StreamOf
from rosa_streams.tags import parse_tag
from rosa_streams.temporal import parse_formula, variables

_STREAM = ("tag", "field", "refresh")
_FORMULA = ("formula", "streams", "policy", "period", "max_age", "tick_period", "lateness")


@dataclass(frozen=True)
class Bindings:
    """The arguments of :class:`~rosa_streams.join.Join`."""

    measures: tuple[StreamMeasure | FormulaMeasure, ...]
    components: dict[str, tuple[str, ...]]


def load_bindings(file: str | PathLike[str]) -> Bindings:
    """Read bindings.

    Raises:
        InputError: with every problem that was found, each with its line.
    """
    source = YamlSource(file)
    reader = _Reader(source)
    bindings = reader.whole(source.data)
    if reader.problems:
        raise StreamError(reader.problems)
    return bindings


class _Reader:
    """Reads entries and collects what is wrong."""

    def __init__(self, source: YamlSource) -> None:
        self.problems: list[Problem] = []
        self._source = source

    def whole(self, data: Any) -> Bindings:
        top = self._mapping(data, ("measures", "components"), ())
        measures = [
            self._measure(str(name), entry, ("measures", name))
            for name, entry in self._mapping(top.get("measures") or {}, None, ("measures",)).items()
        ]
        components = {}
        for name, needs in self._mapping(top.get("components") or {}, None, ("components",)).items():
            if not isinstance(needs, list) or not all(isinstance(need, str) for need in needs):
                self._problem("a component has a list of measures", ("components", name))
                continue
            components[str(name)] = tuple(needs)
        return Bindings(tuple(each for each in measures if each is not None), components)

    def _measure(self, name: str, entry: Any, path: KeyPath) -> StreamMeasure | FormulaMeasure | None:
        by_formula = isinstance(entry, dict) and "formula" in entry
        entry = self._mapping(entry, _FORMULA if by_formula else _STREAM, path)
        if by_formula:
            return self._formula(name, entry, path)
        stream = self._stream(entry, path)
        refresh = entry.get("refresh")
        if refresh is not None and not _positive(refresh):
            self._problem("'refresh' is a number of seconds over 0", (*path, "refresh"))
            return None
        return None if stream is None else StreamMeasure(name, stream.tag, stream.field, refresh)

    def _formula(self, name: str, entry: dict[Any, Any], path: KeyPath) -> FormulaMeasure | None:
        streams = {
            str(variable): self._stream(self._mapping(stream, ("tag", "field"), (*path, "streams", variable)), path)
            for variable, stream in self._mapping(entry.get("streams") or {}, None, (*path, "streams")).items()
        }
        options = {key: value for key, value in entry.items() if key not in {"formula", "streams"}}
        for key, value in options.items():
            if key in _FORMULA and key != "policy" and not _positive(value):
                self._problem(f"'{key}' is a number of seconds over 0", (*path, key))
        try:
            found = variables(parse_formula(str(entry["formula"])))
        except InputError as error:
            where = self._source.location((*path, "formula"))
            self.problems += [Problem(each.what, where, each.hint) for each in error.problems]
            return None
        for variable in found:
            if variable not in streams:
                hint = nearest(variable, streams) or "give the tag of its stream"
                self._problem(f"the variable '{variable}' of the formula has no stream", (*path, "formula"), hint)
        known = {variable: stream for variable, stream in streams.items() if stream is not None}
        return FormulaMeasure(name, str(entry["formula"]), known, options)

    def _stream(self, entry: dict[Any, Any], path: KeyPath) -> StreamOf | None:
        tag, field = entry.get("tag"), entry.get("field")
        if not isinstance(tag, str) or not isinstance(field, str | None):
            self._problem("a stream has a 'tag', and may have a 'field', which are texts", path)
            return None
        try:
            return StreamOf(parse_tag(tag, self._source.location((*path, "tag"))), field)
        except InputError as error:
            self.problems += error.problems
            return None

    def _mapping(self, entry: Any, known: tuple[str, ...] | None, path: KeyPath) -> dict[Any, Any]:
        if not isinstance(entry, dict):
            self._problem("expected a mapping" + (f" with {', '.join(known)}" if known else ""), path)
            return {}
        for key in entry if known else ():
            if known and key not in known:
                hint = nearest(str(key), known) or f"known are {', '.join(known)}"
                self._problem(f"unknown key '{key}'", (*path, key), hint)
        return entry

    def _problem(self, what: str, path: KeyPath, hint: str | None = None) -> None:
        self.problems.append(Problem(what, self._source.location(path), hint))


def _positive(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and value > 0
