"""Options of the form ``--set NAME=VALUE``, which set a scenario's parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.yaml_source import YamlSource

_HINT = "write it as NAME=VALUE, such as --set time_limit=250; 'rosa scenarios NAME' lists the parameters"


def read_settings(given: Sequence[str]) -> dict[str, Any]:
    """The values by name, as YAML has them.

    Args:
        given: what stood after each ``--set``.

    Raises:
        InputError: if one is not of that form, is no YAML, or sets what another one has set.

    >>> read_settings(["time_limit=250", "goals=[B, C]", "minimise=energy"])
    {'time_limit': 250, 'goals': ['B', 'C'], 'minimise': 'energy'}
    """
    values: dict[str, Any] = {}
    for text in given:
        name, equals, value = text.partition("=")
        if not equals or not name.strip():
            raise InputError(Problem(f"--set {text}: not a name and a value", hint=_HINT))
        if name.strip() in values:
            raise InputError(Problem(f"--set {text}: '{name.strip()}' is set twice", hint="leave one of them out"))
        values[name.strip()] = YamlSource.of_text(value, f"--set {text}").data
    return values


def place_of(given: Sequence[str]) -> Callable[[str], Location | None]:
    """Says of a parameter in which option it was set."""
    places: Mapping[str, Location] = {text.partition("=")[0].strip(): Location(f"--set {text}") for text in given}
    return places.get
