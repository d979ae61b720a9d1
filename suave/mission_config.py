"""Mission configurations: the exemplar's own ROS-style YAML files, read unchanged."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from os import PathLike
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import YamlSource


@dataclass(frozen=True, slots=True)
class ThrusterEvent:
    """Thruster ``number`` (1 to 6) fails or recovers ``delay`` seconds after the event before it."""

    number: int
    fails: bool
    delay: float


@dataclass(frozen=True, slots=True)
class MissionConfig:
    """What is uncertain in a mission, and how long it lasts. Times in s, lengths in m; defaults as in the exemplar.

    ``water_visibility_threshold`` and ``expected_altitude`` belong together: the altitude that a manager is expected
    to choose is the first whose threshold the visibility reaches, otherwise the last.
    """

    time_limit: float = 300.0
    qa_publishing_period: float = 1.0
    water_visibility_period: float = 80.0
    water_visibility_min: float = 1.25
    water_visibility_max: float = 3.75
    water_visibility_sec_shift: float = 0.0
    thruster_events: tuple[ThrusterEvent, ...] = (ThrusterEvent(1, True, 35.0),)
    discharge_time: float = 200.0
    f_generate_search_path_mode: str = "fd_spiral_low"
    adaptation_period: float = 30.0
    water_visibility_threshold: tuple[float, ...] = (3.25, 2.25, 1.25)
    expected_altitude: tuple[float, ...] = (3.0, 2.0, 1.0)
    battery_limit: float = 0.25


def load_mission_config(path: str | PathLike[str]) -> tuple[MissionConfig, list[str]]:
    """Read a file of the form ``/node: {ros__parameters: {key: value}}``.

    Returns:
        the configuration, and the keys that mean nothing here (``file:line: what``), which are left out.

    Raises:
        InputError: if the file is not of that form or a value does not fit; file, line and hint.
    """
    source = YamlSource(path)
    if not isinstance(source.data, dict) or not source.data:
        hint = "it looks like '/mission_node: {ros__parameters: {time_limit: 300}}'"
        raise InputError(Problem("not a mission configuration", Location(source.file, 1), hint))
    values: dict[str, Any] = {}
    ignored: list[str] = []
    problems: list[Problem] = []
    for node, content in source.data.items():
        parameters = content.get("ros__parameters") if isinstance(content, dict) else None
        if not isinstance(parameters, dict):
            what = f"'{node}' has no 'ros__parameters' mapping"
            problems.append(Problem(what, source.location((node,)), "parameters stand under 'ros__parameters:'"))
            continue
        for key, raw in parameters.items():
            at = source.location((node, "ros__parameters", key))
            field = _SPELLINGS.get(str(key), str(key))
            if field not in READERS:
                near = nearest(str(key), READERS)
                ignored.append(f"{at}: '{key}' of {node} is not simulated" + (f"; {near}" if near else ""))
                continue
            try:
                values[field] = READERS[field](raw)
            except ValueError as error:
                problems.append(Problem(f"{key} is {raw!r}", at, str(error)))
    if problems:
        raise InputError(problems)
    config = replace(MissionConfig(), **values)
    check_together(config, Location(source.file))
    return config, ignored


def check_together(config: MissionConfig, where: Location | None = None) -> None:
    """That values which belong together fit one another.

    Raises:
        InputError: if they do not.
    """
    if config.water_visibility_min > config.water_visibility_max:
        raise InputError(Problem("water_visibility_min is above water_visibility_max", where, "swap them"))
    if len(config.water_visibility_threshold) != len(config.expected_altitude):
        what = "water_visibility_threshold and expected_altitude have different lengths"
        raise InputError(Problem(what, where, "give one altitude for each threshold"))


def _number(raw: object) -> float:
    if isinstance(raw, bool) or not isinstance(raw, int | float) or not abs(raw) < 1e9:
        raise ValueError("a number is expected")
    return float(raw)


def _positive(raw: object) -> float:
    number = _number(raw)
    if number <= 0:
        raise ValueError("a number above 0 is expected")
    return number


def _text(raw: object) -> str:
    if not isinstance(raw, str):
        raise ValueError("text is expected")
    return raw


def _mode(raw: object) -> str:
    if raw not in SPIRAL_ALTITUDES:
        raise ValueError(f"one of {', '.join(SPIRAL_ALTITUDES)} is expected")
    return _text(raw)


def _numbers(raw: object) -> tuple[float, ...]:
    if not isinstance(raw, list) or not raw:
        raise ValueError("a list of numbers is expected")
    return tuple(_number(item) for item in raw)


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


SPIRAL_ALTITUDES = {"fd_spiral_low": 1.0, "fd_spiral_medium": 2.0, "fd_spiral_high": 3.0}
"""The modes of the search path node and the altitudes (m above the sea bed) that they mean."""

READERS: dict[str, Callable[[object], Any]] = {
    "time_limit": _positive,
    "qa_publishing_period": _positive,
    "water_visibility_period": _positive,
    "water_visibility_min": _number,
    "water_visibility_max": _number,
    "water_visibility_sec_shift": _number,
    "thruster_events": _events,
    "discharge_time": _positive,
    "f_generate_search_path_mode": _mode,
    "adaptation_period": _positive,
    "water_visibility_threshold": _numbers,
    "expected_altitude": _numbers,
    "battery_limit": _number,
}
"""How the value of each field is read from YAML; they raise ValueError that says what is expected."""
_SPELLINGS = {"water_visibiity_threshold": "water_visibility_threshold", "adapt_period": "adaptation_period"}
