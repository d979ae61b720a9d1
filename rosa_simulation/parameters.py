"""What the parameters of a scenario may be, and files that set them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from os import PathLike
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.yaml_source import YamlSource
from rosa_simulation.scenario import Parameter, RunRequest, read_parameters


def number(low: float = -math.inf, high: float = math.inf) -> Callable[[object], float]:
    """Reads a finite number from ``low`` to ``high``."""

    def read(raw: object) -> float:
        if isinstance(raw, bool) or not isinstance(raw, int | float) or not low <= raw <= high or abs(raw) == math.inf:
            raise ValueError(f"a number{_within(low, high)} is expected")
        return float(raw)

    return read


def whole_number(low: float = -math.inf, high: float = math.inf) -> Callable[[object], int]:
    """Reads a whole number from ``low`` to ``high``."""

    def read(raw: object) -> int:
        if isinstance(raw, bool) or not isinstance(raw, int) or not low <= raw <= high:
            raise ValueError(f"a whole number{_within(low, high)} is expected")
        return raw

    return read


def truth(raw: object) -> bool:
    """Reads ``true`` or ``false``."""
    if not isinstance(raw, bool):
        raise ValueError("true or false is expected")
    return raw


def requested_parameters(known: Mapping[str, Parameter], request: RunRequest) -> dict[str, Any]:
    """The values of a scenario whose mission configuration is a file of parameters, such as experiments are.

    The file ``request.mission_config`` has the form ``parameters: {name: value}``; ``request.parameters`` and, if
    there is a parameter ``time_limit``, ``request.time_limit`` count before it.

    Raises:
        InputError: if the file cannot be read, there is no such parameter, or a value does not fit.
    """
    values = {} if request.mission_config is None else _from_file(known, request.mission_config)
    values |= read_parameters(known, request.parameters)
    if request.time_limit is not None:
        values["time_limit"] = request.time_limit
    return values


def _from_file(known: Mapping[str, Parameter], path: str | PathLike[str]) -> dict[str, Any]:
    source = YamlSource(path)
    data = source.data
    if not isinstance(data, dict) or set(data) != {"parameters"} or not isinstance(data["parameters"], dict):
        hint = f"it looks like 'parameters: {{{next(iter(known), 'name')}: ...}}'"
        raise InputError(Problem("not a file of parameters", Location(source.file, 1), hint))
    given = {str(name): value for name, value in data["parameters"].items()}
    return read_parameters(known, given, lambda name: source.location(("parameters", name)))


def _within(low: float, high: float) -> str:
    if low == -math.inf:
        return "" if high == math.inf else f" up to {high:g}"
    return f" from {low:g}" + ("" if high == math.inf else f" to {high:g}")
