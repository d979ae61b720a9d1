"""What an experiment may set in the UAV's mission: the numbers of its world."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.parameters import number, requested_parameters, truth, whole_number
from rosa_simulation.scenario import Parameter, RunRequest, no_warnings
from uav_example.world.parameters import WorldParameters

_DRAIN = number(0.0, 1.0)
_LENGTH = number(1.0, 10_000.0)
_HEIGHT = number(0.1, 500.0)
_SPEED = number(0.1, 100.0)
_DURATION = number(0.1, 3600.0)

PARAMETERS: Mapping[str, Parameter] = {
    "time_limit": Parameter("when the mission is broken off, s", number(1.0, 1e6)),
    "width": Parameter("of the area, along x, m", _LENGTH),
    "depth": Parameter("of the area, along y, m", _LENGTH),
    "samples": Parameter("how many samples lie in the area", whole_number(0, 1000)),
    "lane_spacing": Parameter("between two lanes of the search, m", _LENGTH),
    "sight": Parameter("how far from the point below a sample is seen, m", _LENGTH),
    "search_height": Parameter("height of the search, m", _HEIGHT),
    "speed": Parameter("horizontally, m/s", _SPEED),
    "climb_speed": Parameter("vertically, m/s", _SPEED),
    "pick_time": Parameter("to pick a sample up and analyse it, s", _DURATION),
    "scan_time": Parameter("to analyse it on site, s", _DURATION),
    "fold_time": Parameter("for the gripper to fold, s", _DURATION),
    "spring_time": Parameter("for the spring to fold it, s", _DURATION),
    "gripper_life": Parameter("mean time of use after which the gripper fails, s", number(0.1, 1e9)),
    "gripper_fails_after": Parameter("time of use after which it fails, instead of a draw, s", number(0.1, 1e9)),
    "spring": Parameter("whether a spring folds a gripper that has failed", truth),
    "initial_charge": Parameter("charge of the battery at the start, 0 to 1", number(0.01, 1.0)),
    "drain_hover": Parameter("charge per second while nothing is done in the air", _DRAIN),
    "drain_search": Parameter("charge per second of search", _DRAIN),
    "drain_analyze": Parameter("charge per second of analyze", _DRAIN),
    "drain_analyze_in_situ": Parameter("charge per second of analyze_in_situ", _DRAIN),
    "drain_return_base": Parameter("charge per second of return_base", _DRAIN),
    "drain_land_fold": Parameter("charge per second of land_fold", _DRAIN),
    "charge_rate": Parameter("charge per second at the base", number(1e-6, 1.0)),
}


def world_parameters(request: RunRequest, _warn: Callable[[str], None] = no_warnings) -> WorldParameters:
    """The world that is asked for.

    Args:
        request: of the run.

    Raises:
        InputError: if there is no such parameter, a value does not fit, or values do not go together.
    """
    parameters = WorldParameters(**requested_parameters(PARAMETERS, request))
    if parameters.charge_rate <= parameters.drain_return_base:
        what = "charge_rate is not above drain_return_base: the battery would never be full"
        raise InputError(Problem(what, hint="charge faster"))
    if parameters.lane_spacing > 2.0 * parameters.sight:
        raise InputError(
            Problem("lane_spacing is more than twice the sight: samples would be missed", hint="search in closer lanes")
        )
    return parameters
