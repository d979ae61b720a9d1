"""Random: changes the modes of the functions in use now and then, whatever the situation."""

from __future__ import annotations

from functools import partial

from suave.managers.manager import ManagedMission
from suave.managers.modes import UNGROUND, mode_manager
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, WithHooks

_FUNCTIONS = {"search_pipeline": "f_generate_search_path", "inspect_pipeline": "f_follow_pipeline"}
"""The function whose mode is changed while an action is performed; thrusters are left to themselves."""


def random_manager(mission: ManagedMission) -> TreeRunner:
    """The exemplar's random manager.

    A function gets a random one of its modes (which may be that it does not run) when the action that needs it begins,
    and again every ``adaptation_period`` seconds of the mission configuration; none when the action is over.
    """
    robot, rng, modes = mission.robot, mission.rng, mode_manager(mission)
    in_use: list[str] = []

    def adapt(function: str) -> None:
        several = modes.modes.modes(function)
        modes.change_mode(function, several[int(rng.integers(len(several)))])

    def begin(function: str) -> None:
        in_use.append(function)
        adapt(function)

    def end(function: str) -> None:
        in_use.remove(function)
        modes.change_mode(function, UNGROUND)

    def skill_of(action: str) -> Skill:
        function = _FUNCTIONS[action]
        return WithHooks(mission.skills[action], partial(begin, function), partial(end, function))

    def adapt_all() -> None:
        for function in in_use:
            adapt(function)

    mission.call_every(robot.config.adaptation_period, adapt_all)
    return mission.runner(mission.unguarded_tree(skill_of))
