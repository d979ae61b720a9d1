"""Mission configurations: the exemplar's own ROS-style YAML files, read unchanged."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from os import PathLike
from typing import Annotated, Any, get_type_hints

from pydantic import AfterValidator, BaseModel, BeforeValidator, Field

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.checked_file import Name, Number, Text, read_yaml_file, value_reader

SPIRAL_ALTITUDES = {"fd_spiral_low": 1.0, "fd_spiral_medium": 2.0, "fd_spiral_high": 3.0}
"""The modes of the search path node and the altitudes (m above the sea bed) that they mean."""


@dataclass(frozen=True, slots=True)
class ThrusterEvent:
    """Thruster ``number`` (1 to 6) fails or recovers ``delay`` seconds after the event before it."""

    number: int
    fails: bool
    delay: float


_EVENT = re.compile(r"\(\s*([1-6])\s*,\s*(failure|recovery)\s*,\s*(\d+(?:\.\d+)?)\s*\)")


def _event(raw: object) -> ThrusterEvent:
    """An event as the exemplar writes it, ``(1,failure,35)``, or as a list of the three."""
    text = f"({','.join(map(str, raw))})" if isinstance(raw, list) else raw
    match = _EVENT.fullmatch(text.strip()) if isinstance(text, str) else None
    if match is None:
        raise ValueError("events look like (1,failure,35): thruster 1 to 6, failure or recovery, seconds")
    return ThrusterEvent(int(match[1]), match[2] == "failure", float(match[3]))


def _events(raw: object) -> tuple[ThrusterEvent, ...]:
    items = raw if isinstance(raw, list) else [raw]
    return tuple(_event(item) for item in items if item not in ("", None))


def _mode(name: str) -> str:
    if name not in SPIRAL_ALTITUDES:
        raise ValueError(f"one of {', '.join(SPIRAL_ALTITUDES)} is expected")
    return name


_Number = Annotated[Number, Field(ge=-1e9, le=1e9)]
_AboveZero = Annotated[_Number, Field(gt=0)]
_Numbers = Annotated[tuple[_Number, ...], Field(min_length=1)]
_Events = Annotated[tuple[ThrusterEvent, ...], BeforeValidator(_events)]
_Mode = Annotated[Text, AfterValidator(_mode)]


@dataclass(frozen=True, slots=True)
class MissionConfig:
    """What is uncertain in a mission, and how long it lasts. Times in s, lengths in m; defaults as in the exemplar.

    ``water_visibility_threshold`` and ``expected_altitude`` belong together: the altitude that a manager is expected
    to choose is the first whose threshold the visibility reaches, otherwise the last.
    """

    time_limit: _AboveZero = 300.0
    qa_publishing_period: _AboveZero = 1.0
    water_visibility_period: _AboveZero = 80.0
    water_visibility_min: _Number = 1.25
    water_visibility_max: _Number = 3.75
    water_visibility_sec_shift: _Number = 0.0
    thruster_events: _Events = (ThrusterEvent(1, True, 35.0),)
    discharge_time: _AboveZero = 200.0
    f_generate_search_path_mode: _Mode = "fd_spiral_low"
    adaptation_period: _AboveZero = 30.0
    water_visibility_threshold: _Numbers = (3.25, 2.25, 1.25)
    expected_altitude: _Numbers = (3.0, 2.0, 1.0)
    battery_limit: _Number = 0.25


READERS: dict[str, Callable[[object], Any]] = {
    name: value_reader(kind) for name, kind in get_type_hints(MissionConfig, include_extras=True).items()
}
"""How the value of each field is read from YAML; they raise ValueError that says what is expected."""
_SPELLINGS = {"water_visibiity_threshold": "water_visibility_threshold", "adapt_period": "adaptation_period"}


class _Node(BaseModel):
    parameters: dict[Name, Any] = Field(alias="ros__parameters")


def load_mission_config(path: str | PathLike[str]) -> tuple[MissionConfig, list[str]]:
    """Read a file of the form ``/node: {ros__parameters: {key: value}}``.

    Returns:
        the configuration, and the keys that mean nothing here (``file:line: what``), which are left out.

    Raises:
        InputError: if the file is not of that form or a value does not fit; file, line and hint.
    """
    form = "it looks like '/mission_node: {ros__parameters: {time_limit: 300}}'"
    file = read_yaml_file(path, dict[Name, _Node], "a mission configuration", form)
    values: dict[str, Any] = {}
    ignored: list[str] = []
    for node, content in file.content.items():
        for key, raw in content.parameters.items():
            at = (node, "ros__parameters", key)
            field = _SPELLINGS.get(key, key)
            if field not in READERS:
                near = nearest(key, READERS)
                ignored.append(
                    f"{file.location(*at)}: '{key}' of {node} is not simulated" + (f"; {near}" if near else "")
                )
                continue
            try:
                values[field] = READERS[field](raw)
            except ValueError as error:
                file.refuse(f"{key} is {raw!r}", str(error), *at)
    file.raise_problems()
    config = replace(MissionConfig(), **values)
    check_together(config, Location(str(path)))
    return config, ignored


def check_together(config: MissionConfig, where: Location | None = None) -> None:
    """Make sure that values which belong together fit one another.

    Args:
        config: each value fits by itself.
        where: the file, for the error.

    Raises:
        InputError: if they do not.
    """
    if config.water_visibility_min > config.water_visibility_max:
        raise InputError(Problem("water_visibility_min is above water_visibility_max", where, "swap them"))
    if len(config.water_visibility_threshold) != len(config.expected_altitude):
        what = "water_visibility_threshold and expected_altitude have different lengths"
        raise InputError(Problem(what, where, "give one altitude for each threshold"))
