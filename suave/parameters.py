"""What an experiment may set in the SUAVE missions: every field of a mission configuration, and the start."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from rosa_simulation.parameters import truth
from rosa_simulation.scenario import Parameter, RunRequest, read_parameters
from suave.mission_config import READERS, MissionConfig, check_together, load_mission_config
from suave.world.parameters import WorldParameters

_START = "start"
_REFLEXES = "reflexes"
_FURTHEST = 100.0


def _position(raw: object) -> tuple[float, float]:
    if isinstance(raw, list) and len(raw) == 2:
        x, y = (item if isinstance(item, int | float) and not isinstance(item, bool) else None for item in raw)
        if x is not None and y is not None and max(abs(x), abs(y)) <= _FURTHEST:
            return float(x), float(y)
    raise ValueError(f"a list [x, y] in m is expected, at most {_FURTHEST:g} m from the origin")


_DESCRIPTIONS = {
    "time_limit": "end of the mission, s",
    "qa_publishing_period": "between two measurements of visibility and battery, s",
    "water_visibility_period": "of the cosine that the visibility follows, s",
    "water_visibility_min": "worst visibility, m",
    "water_visibility_max": "best visibility, m",
    "water_visibility_sec_shift": "phase shift of the visibility, s",
    "thruster_events": "list of events such as (1,failure,35): thruster, failure or recovery, s after the one before",
    "discharge_time": "in which the battery runs empty, s",
    "f_generate_search_path_mode": "search mode while nothing adapts",
    "adaptation_period": "between two adaptations of a periodic manager, s",
    "water_visibility_threshold": "visibilities from which each of the expected altitudes is right, m",
    "expected_altitude": "search altitudes, m",
    "battery_limit": "level below which the battery is low, 0 to 1",
}


def _default(name: str) -> object:
    """The value in a mission that nothing is said about, as a file would have it."""
    value = getattr(MissionConfig(), name)
    return [str(event) for event in value] if name == "thruster_events" else value


PARAMETERS: Mapping[str, Parameter] = {
    **{name: Parameter(_DESCRIPTIONS[name], read, _default(name)) for name, read in READERS.items()},
    _START: Parameter(
        "where the vehicle starts, [x, y] in m, before the spread of the start", _position, WorldParameters().start[:2]
    ),
    _REFLEXES: Parameter("whether a reflex keeps the vehicle clear of the sea bed", truth, False),
}


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything that a mission is made of: what is uncertain, the world, whether with battery and reflexes."""

    config: MissionConfig
    world: WorldParameters
    extended: bool
    reflexes: bool = False


def plain_settings(request: RunRequest, warn: Callable[[str], None]) -> Settings:
    """The settings of the plain mission.

    Args:
        request: of the run.
        warn: called with a sentence for what is in the file but has no effect here.

    Raises:
        InputError: as :func:`extended_settings`.
    """
    return _settings(request, warn, extended=False)


def extended_settings(request: RunRequest, warn: Callable[[str], None]) -> Settings:
    """The settings of the extended mission: the request's mission configuration, and upon it its parameters.

    Args:
        request: what is to be run.
        warn: is given each thing in the mission configuration that means nothing here.

    Raises:
        InputError: if there is no such parameter, a value does not fit, or values do not go together.
    """
    return _settings(request, warn, extended=True)


def _settings(request: RunRequest, warn: Callable[[str], None], *, extended: bool) -> Settings:
    config = MissionConfig()
    if request.mission_config is not None:
        config, ignored = load_mission_config(request.mission_config)
        for text in ignored:
            warn(text)
    if request.time_limit is not None:
        config = replace(config, time_limit=request.time_limit)
    values, world = read_parameters(PARAMETERS, request.parameters), WorldParameters()
    if _START in values:
        world = replace(world, start=(*values.pop(_START), world.start[2]))
    reflexes = bool(values.pop(_REFLEXES, False))
    config = replace(config, **values)
    check_together(config)
    return Settings(config, world, extended, reflexes)
