"""What an experiment may set in the AGV's mission, whatever its file says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_core.formats.checked_file import Name, Names, value_reader
from rosa_simulation.parameters import number, truth
from rosa_simulation.scenario import Parameter, RunRequest, no_warnings, read_parameters

if TYPE_CHECKING:
    from agv_example.missions.mission_config import Disturbance, MissionConfig


_name = value_reader(Name)
_names = value_reader(Annotated[Names, Field(min_length=1)])


def _events(raw: object) -> tuple[Disturbance, ...]:
    from agv_example.missions.mission_config import KINDS, Disturbance

    def read(entry: object) -> Disturbance:
        match entry:
            case [int() | float() as at, str() as kind, subject] if kind in KINDS and kind != "dims":
                light = 1.0
            case [int() | float() as at, "dims" as kind, subject, int() | float() as light] if 0.0 <= light <= 1.0:
                pass
            case _:
                raise ValueError(f"[time, {' | '.join(KINDS)}, what] is expected, after what 'dims' the light, 0 to 1")
        if not 0.0 <= at <= 1e6:
            raise ValueError("the time is a number of seconds from 0 up")
        return Disturbance(float(at), float(at), kind, (_name(subject),), float(light))

    if not isinstance(raw, list):
        raise ValueError("a list is expected, such as [[12, fails, kinect]]")
    return tuple(map(read, raw))


def _grid(raw: object) -> tuple[int, int, int]:
    match raw:
        case [int() as columns, int() as rows, int() as seed] if 1 <= columns <= 100 and 2 <= rows <= 100 and seed >= 0:
            return columns, rows, seed
    raise ValueError("[columns, rows, seed] is expected, at most 100 columns and rows")


PARAMETERS: Mapping[str, Parameter] = {
    "time_limit": Parameter("when the mission is broken off, s", number(1.0, 1e6)),
    "battery": Parameter("energy that the robot sets out with, units of draw times second", number(1e-3, 1e9)),
    "start_up_time": Parameter("to start a component, s", number(0.0, 1e4)),
    "start_up_energy": Parameter("to start a component, units of draw times second", number(0.0, 1e6)),
    "minimise": Parameter("energy, time or risk, or several in the order of their importance", _names),
    "start": Parameter("the place where the robot is at first", _name),
    "goals": Parameter("the places to drive to in turn", _names),
    "events": Parameter("what goes wrong: [[12, fails, kinect], [20, dims, C3, 0.1], ...]", _events),
    "grid": Parameter("[columns, rows, seed] of a made-up map, which is crossed from corner to corner", _grid),
    "reflexes": Parameter("whether the robot stands still for a while after a collision, by a reflex", truth),
}


def requested_mission(request: RunRequest, _warn: Callable[[str], None] = no_warnings) -> MissionConfig:
    """The mission of the request's file, or the default one, with what the request's parameters set.

    Args:
        request: of the run.

    Raises:
        InputError: for whatever is wrong with either.
    """
    from agv_example.missions.mission_config import default_mission, load_mission

    values = read_parameters(PARAMETERS, request.parameters)
    if request.time_limit is not None:
        values["time_limit"] = request.time_limit
    return _with(load_mission(request.mission_config or default_mission()), values)


def _with(config: MissionConfig, values: dict[str, Any]) -> MissionConfig:
    if "grid" in values:
        config = _on_grid(config, *values["grid"])
    start_up = replace(
        config.start_up,
        time=values.get("start_up_time", config.start_up.time),
        energy=values.get("start_up_energy", config.start_up.energy),
    )
    changed: dict[str, Any] = {
        name: values[name] for name in ("time_limit", "battery", "start", "goals", "reflexes") if name in values
    }
    if "minimise" in values:
        changed["objective"] = _objective(values["minimise"])
    if "events" in values:
        changed["disturbances"] = values["events"]
    config = replace(config, start_up=start_up, **changed)
    for place in (config.start, *config.goals):
        config.corridors.place(place)
    for disturbance in config.disturbances:
        problem = disturbance.problem_on(config.corridors)
        if problem is not None:
            raise InputError(problem)
    return config


def _on_grid(config: MissionConfig, columns: int, rows: int, seed: int) -> MissionConfig:
    from agv_example.grids import grid_map

    corridors = grid_map(columns, rows, seed)
    ends = corridors.places[0].name, corridors.places[-1].name
    return replace(config, corridors=corridors, start=ends[0], goals=(ends[1],))


def _objective(names: tuple[str, ...]) -> Any:
    from agv_example.planning import Objective
    from rosa_core import InvalidValueError

    try:
        return Objective.first(names[0]) if len(names) == 1 else Objective.in_order(names)
    except InvalidValueError as error:
        raise InputError(Problem(f"minimise: {error}")) from None
