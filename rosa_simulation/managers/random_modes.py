"""Random: changes the modes of the functions in use now and then, whatever the situation."""

from __future__ import annotations

from functools import partial

from rosa_simulation.managers.modes import mode_control, mode_manager
from rosa_simulation.mission import Mission
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, WithHooks


def random_manager(mission: Mission) -> TreeRunner:
    """The random manager of the SUAVE exemplar.

    A function gets a random one of its modes (which may be that it does not run) when the action that needs it begins,
    and again every ``adaptation_period`` seconds; its unused mode when the action is over.
    """
    rng, modes, control = mission.simulation.manager_rng, mode_manager(mission), mode_control(mission)
    in_use: list[str] = []

    def adapt(function: str) -> None:
        several = modes.modes.modes(function)
        modes.change_mode(function, several[int(rng.integers(len(several)))])

    def begin(function: str) -> None:
        in_use.append(function)
        adapt(function)

    def end(function: str) -> None:
        in_use.remove(function)
        modes.change_mode(function, control.unused_mode)

    def skill_of(action: str) -> Skill:
        function = control.varied[action]
        return WithHooks(mission.skills[action], partial(begin, function), partial(end, function))

    def adapt_all() -> None:
        for function in in_use:
            adapt(function)

    mission.call_every(control.adaptation_period, adapt_all)
    return mission.runner(mission.unguarded_tree(skill_of))
