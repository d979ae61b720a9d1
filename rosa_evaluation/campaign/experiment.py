"""Experiment files: which of a scenario's parameters are set, and which are drawn anew for every run.

::

    name: varied uncertainties
    parameters:
      time_limit: 250
      water_visibility_sec_shift: {uniform: [0, 80]}
      thruster_events: [[1, failure, {uniform: [20, 60]}]]

A distribution may stand wherever a value may. What is drawn depends on the run's seed and on where the distribution
stands, so that every managing system meets the same, and another parameter more changes no other draw.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource

_DIGITS = 4
"""Draws are rounded to this many decimals: no uncertainty is known better, and people read and type them."""
_LARGEST = 1e15


@dataclass(frozen=True, slots=True)
class Distribution:
    """What a value is drawn from: ``kind`` is a key of ``DISTRIBUTIONS``, ``of`` its list in the file."""

    kind: str
    of: tuple[Any, ...]

    def draw(self, rng: np.random.Generator) -> Any:
        """One value."""
        return DISTRIBUTIONS[self.kind].draw(rng, self.of)


@dataclass(frozen=True, slots=True)
class _Kind:
    form: str
    fits: Callable[[tuple[Any, ...]], bool]
    draw: Callable[[np.random.Generator, tuple[Any, ...]], Any]


def _are_numbers(values: tuple[Any, ...]) -> bool:
    return all(
        isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= _LARGEST for value in values
    )


def _is_range(values: tuple[Any, ...]) -> bool:
    return len(values) == 2 and _are_numbers(values) and values[0] <= values[1]


def _is_integer_range(values: tuple[Any, ...]) -> bool:
    return _is_range(values) and all(isinstance(value, int) for value in values)


def _is_normal(values: tuple[Any, ...]) -> bool:
    return len(values) == 2 and _are_numbers(values) and values[1] >= 0


DISTRIBUTIONS: Mapping[str, _Kind] = {
    "uniform": _Kind("[low, high]", _is_range, lambda rng, of: round(float(rng.uniform(*of)), _DIGITS)),
    "normal": _Kind("[mean, standard deviation]", _is_normal, lambda rng, of: round(float(rng.normal(*of)), _DIGITS)),
    "integer": _Kind("[lowest, highest]", _is_integer_range, lambda rng, of: int(rng.integers(of[0], of[1] + 1))),
    "choice": _Kind("[one, another, ...]", lambda of: len(of) > 0, lambda rng, of: of[int(rng.integers(len(of)))]),
}


@dataclass(frozen=True, slots=True)
class Experiment:
    """What is set and what is varied; without a file, nothing.

    Attributes:
        name: what a report calls these conditions; empty when nothing is set.
        parameters: plain values, lists and ``Distribution``, by the parameter's name.
        document: the file's content as plain values.
    """

    name: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    document: Mapping[str, Any] = field(default_factory=dict)
    locations: Mapping[str, Location] = field(default_factory=dict)

    @staticmethod
    def load(path: str | PathLike[str]) -> Experiment:
        """Read an experiment file.

        Raises:
            InputError: if it cannot be read or is not of that form; file, line and hint.
        """
        return _Reader(YamlSource(path)).experiment()

    def draw(self, seed: int) -> dict[str, Any]:
        """The values for a run with that seed."""
        return {name: _drawn(value, seed, name) for name, value in self.parameters.items()}

    def where(self, parameter: str) -> Location | None:
        """In which line of the file a parameter stands."""
        return self.locations.get(parameter)


def _drawn(value: Any, seed: int, path: str) -> Any:
    match value:
        case Distribution():
            # A stream of its own: neither the run's noise nor another draw shares it.
            return _drawn(value.draw(np.random.default_rng([seed, zlib.crc32(path.encode())])), seed, f"{path}*")
        case list():
            return [_drawn(item, seed, f"{path}.{index}") for index, item in enumerate(value)]
    return value


class _Reader:
    """Checks a parsed file; problems are gathered, so that all of them can be fixed at once."""

    def __init__(self, source: YamlSource) -> None:
        self._source = source
        self._problems: list[Problem] = []

    def experiment(self) -> Experiment:
        data = self._source.data
        if not isinstance(data, dict) or not isinstance(data.get("parameters"), dict):
            hint = "it looks like 'parameters: {time_limit: 250, water_visibility_sec_shift: {uniform: [0, 80]}}'"
            raise InputError(Problem("not an experiment", Location(self._source.file, 1), hint))
        for key in data:
            if key not in ("name", "parameters"):
                self._refuse((key,), f"unknown key '{key}'", nearest(str(key), ("name", "parameters")))
        name = data.get("name", Path(self._source.file).stem)
        if not isinstance(name, str) or not name:
            self._refuse(("name",), f"the name is {name!r}", "text is expected")
        parameters = {str(key): self._value(value, ("parameters", key)) for key, value in data["parameters"].items()}
        locations = {str(key): self._source.location(("parameters", key)) for key in data["parameters"]}
        if self._problems:
            raise InputError(self._problems)
        return Experiment(name, parameters, data, locations)

    def _value(self, value: Any, path: KeyPath) -> Any:
        match value:
            case dict():
                return self._distribution(value, path)
            case list():
                return [self._value(item, (*path, index)) for index, item in enumerate(value)]
            case float() if not math.isfinite(value):
                self._refuse(path, f"{value} is not a number that can be set", "write a finite number")
            case None | bool() | int() | float() | str():
                pass
            case _:
                self._refuse(path, f"{value} is a {type(value).__name__}", "quote it if it is text")
        return value

    def _distribution(self, value: dict[Any, Any], path: KeyPath) -> Any:
        kinds = ", ".join(DISTRIBUTIONS)
        if len(value) != 1:
            self._refuse(path, "a mapping here is a distribution with one key", f"one of {kinds}")
            return None
        ((key, of),) = value.items()
        if key not in DISTRIBUTIONS:
            self._refuse(
                path, f"there is no distribution '{key}'", nearest(str(key), DISTRIBUTIONS) or f"one of {kinds}"
            )
            return None
        items = [
            self._value(item, (*path, key, index)) for index, item in enumerate(of if isinstance(of, list) else ())
        ]
        if not isinstance(of, list) or not DISTRIBUTIONS[key].fits(tuple(items)):
            self._refuse(path, f"{key} is {of!r}", f"write it as {{{key}: {DISTRIBUTIONS[key].form}}}")
        return Distribution(key, tuple(items))

    def _refuse(self, path: KeyPath, what: str, hint: str | None) -> None:
        self._problems.append(Problem(what, self._source.location(path), hint))
