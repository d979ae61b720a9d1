"""What the parameters of a scenario may be, and files that set them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from os import PathLike
from typing import Annotated, Any

from rosa_core.formats.checked_file import Entry, Flag, Name, Number, Whole, read_yaml_file, value_reader, within
from rosa_simulation.scenario import Parameter, RunRequest, read_parameters

truth = value_reader(Flag)
"""Reads ``true`` or ``false``."""


def number(low: float = -math.inf, high: float = math.inf) -> Callable[[object], float]:
    """A reader of finite numbers, for a :class:`~rosa_simulation.scenario.Parameter`.

    Args:
        low: the least that is allowed.
        high: the most that is allowed.

    Returns:
        a function from what stands in a file to the number; it raises ``ValueError`` with what is expected.

    Example:
        >>> number(0.0, 1.0)(0.25)
        0.25
    """
    return value_reader(Annotated[Number, within(low, high)])


def whole_number(low: float = -math.inf, high: float = math.inf) -> Callable[[object], int]:
    """A reader of whole numbers, for a :class:`~rosa_simulation.scenario.Parameter`.

    Args:
        low: the least that is allowed.
        high: the most that is allowed.

    Returns:
        a function from what stands in a file to the number; it raises ``ValueError`` with what is expected.

    Example:
        >>> whole_number(1)(3.0)
        3
        >>> whole_number(1)(0.5)
        Traceback (most recent call last):
        ValueError: a whole number from 1 up is expected
    """
    return value_reader(Annotated[Whole, within(low, high)])


class _ParametersEntry(Entry):
    parameters: dict[Name, Any]


def requested_parameters(known: Mapping[str, Parameter], request: RunRequest) -> dict[str, Any]:
    """The values of a scenario whose mission configuration is a file of parameters, such as experiments are.

    The file ``request.mission_config`` has the form ``parameters: {name: value}``; ``request.parameters`` and, if
    there is a parameter ``time_limit``, ``request.time_limit`` count before it.

    Args:
        known: the scenario's parameters by name.
        request: of the run.

    Returns:
        values by name, only of the parameters that are given.

    Raises:
        InputError: if the file cannot be read, there is no such parameter, or a value does not fit.
    """
    values = {} if request.mission_config is None else _from_file(known, request.mission_config)
    values |= read_parameters(known, request.parameters)
    if request.time_limit is not None:
        values["time_limit"] = request.time_limit
    return values


def _from_file(known: Mapping[str, Parameter], path: str | PathLike[str]) -> dict[str, Any]:
    form = f"it looks like 'parameters: {{{next(iter(known), 'name')}: ...}}'"
    file = read_yaml_file(path, _ParametersEntry, "a file of parameters", form)
    return read_parameters(known, file.content.parameters, lambda name: file.location("parameters", name))
