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
import operator
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import (
    AfterValidator,
    Discriminator,
    Field,
    RootModel,
    Tag,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)

from rosa_core.errors import Location
from rosa_core.formats.checked_file import Entry, Name, Number, Text, Whole, read_yaml_file
from rosa_core.formats.misfits import MisfitError

_DIGITS = 4
"""Draws are rounded to this many decimals: no uncertainty is known better, and people read and type them."""

DISTRIBUTIONS: Mapping[str, Callable[[np.random.Generator, tuple[Any, ...]], Any]] = {
    "uniform": lambda rng, of: round(float(rng.uniform(*of)), _DIGITS),
    "normal": lambda rng, of: round(float(rng.normal(*of)), _DIGITS),
    "integer": lambda rng, of: int(rng.integers(of[0], of[1] + 1)),
    "choice": lambda rng, of: of[int(rng.integers(len(of)))],
}


@dataclass(frozen=True, slots=True)
class Distribution:
    """What a value is drawn from: ``kind`` is a key of ``DISTRIBUTIONS``, ``of`` its list in the file."""

    kind: str
    of: tuple[Any, ...]

    def draw(self, rng: np.random.Generator) -> Any:
        """One value."""
        return DISTRIBUTIONS[self.kind](rng, self.of)


def _pair(form: str, fits: Callable[[Any, Any], bool]) -> WrapValidator:
    """Two numbers that fit together; whatever else there is, the form is the hint."""

    def check(value: object, read: ValidatorFunctionWrapHandler) -> tuple[float, ...]:
        with suppress(ValidationError):
            numbers: tuple[float, ...] = read(value)
            if len(numbers) == 2 and fits(*numbers):
                return numbers
        raise ValueError(f"write it as {{{form}}}")

    return WrapValidator(check)


def _plain(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("write a finite number")
    if not isinstance(value, None | bool | int | float | str):
        raise ValueError("quote it if it is text")
    return value


def _shape(value: object) -> str:
    return "distribution" if isinstance(value, dict) else "list" if isinstance(value, list) else "plain"


_ROOT = AfterValidator(lambda value: value.root)


class _Value(RootModel[Any]):
    """What a parameter may be: a distribution, a list of values, or a plain value."""

    root: Annotated[
        Annotated[Any, AfterValidator(_plain), Tag("plain")]
        | Annotated[list[Annotated[_Value, _ROOT]], Tag("list")]
        | Annotated[_DistributionEntry, AfterValidator(lambda entry: entry.distribution()), Tag("distribution")],
        Discriminator(_shape),
    ]


_Figure = Annotated[Number, Field(ge=-1e15, le=1e15)]
_Integer = Annotated[Whole, Field(ge=-(10**15), le=10**15)]


_NORMAL = _pair("normal: [mean, standard deviation]", lambda _, width: width >= 0)


class _DistributionEntry(Entry):
    uniform: Annotated[tuple[_Figure, ...], _pair("uniform: [low, high]", operator.le)] | None = None
    normal: Annotated[tuple[_Figure, ...], _NORMAL] | None = None
    integer: Annotated[tuple[_Integer, ...], _pair("integer: [lowest, highest]", operator.le)] | None = None
    choice: Annotated[tuple[Annotated[_Value, _ROOT], ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> _DistributionEntry:
        if len(self.model_fields_set) != 1:
            raise MisfitError("a mapping here is a distribution with one key", f"one of {', '.join(DISTRIBUTIONS)}")
        return self

    def distribution(self) -> Distribution:
        (kind,) = self.model_fields_set
        return Distribution(kind, getattr(self, kind))


class _ExperimentEntry(Entry):
    name: Text = ""
    parameters: dict[Name, Annotated[_Value, _ROOT]]


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

        Args:
            path: of the file, in YAML.

        Raises:
            InputError: if it cannot be read or is not of that form; file, line and hint.
        """
        form = "it looks like 'parameters: {time_limit: 250, water_visibility_sec_shift: {uniform: [0, 80]}}'"
        file = read_yaml_file(path, _ExperimentEntry, "an experiment", form)
        entry = file.content
        locations = {name: file.location("parameters", name) for name in entry.parameters}
        return Experiment(entry.name or Path(path).stem, entry.parameters, file.document, locations)

    def draw(self, seed: int) -> dict[str, Any]:
        """The values for a run with that seed.

        Args:
            seed: of the run.

        Returns:
            values by parameter; each depends on the seed and on the parameter's name alone.
        """
        return {name: _drawn(value, seed, name) for name, value in self.parameters.items()}

    def where(self, parameter: str) -> Location | None:
        """In which line of the file a parameter stands.

        Args:
            parameter: its name.

        Returns:
            None if it is not in the file, or there is no file.
        """
        return self.locations.get(parameter)


def _drawn(value: Any, seed: int, path: str) -> Any:
    match value:
        case Distribution():
            # A stream of its own: neither the run's noise nor another draw shares it.
            return _drawn(value.draw(np.random.default_rng([seed, zlib.crc32(path.encode())])), seed, f"{path}*")
        case list():
            return [_drawn(item, seed, f"{path}.{index}") for index, item in enumerate(value)]
    return value
