"""Metacontrol: functions are objectives, and a reasoner keeps each solved by the best of its designs.

After MROS (Bozhinoski et al., 2022) and the TOMASys model (Hernández et al., 2018), as used for SUAVE (Silva et al.,
2023). The reasoning is theirs in kind; the ontology and its reasoner are not reproduced, three pure functions are.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from functools import partial

from rosa_simulation.managers.modes import mode_control, mode_manager, observed
from rosa_simulation.mission import Mission
from rosa_simulation.system_modes import FunctionDesign, ModeControl, ModeManager, Situation
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, WithHooks

REASONING_PERIOD = 1.5
"""Seconds between two cycles of reasoning, as configured for SUAVE."""


class ObjectiveStatus(Enum):
    """What a cycle of reasoning finds an objective to be."""

    UNGROUNDED = "no design solves it yet"
    COMPONENT_ERROR = "a component of its design has failed"
    QUALITY_ERROR = "its design needs more quality than is measured"
    IMPROVABLE = "there is a better design that works now"
    SOLVED = "solved"


def best_design(designs: Iterable[FunctionDesign], situation: Situation) -> FunctionDesign | None:
    """The best of the designs that work in a situation.

    Args:
        designs: all of one function.
        situation: what is measured and has failed.

    Returns:
        the one that performs best, the first of equals; None if none works.
    """
    realisable = [design for design in designs if _error(design, situation) is None]
    return max(realisable, key=lambda design: design.performance, default=None)


def analyse(design: FunctionDesign | None, designs: Iterable[FunctionDesign], situation: Situation) -> ObjectiveStatus:
    """The status of an objective.

    Args:
        design: that is to solve it now, None if none is.
        designs: those that can solve it.
        situation: what is measured and has failed.

    Returns:
        an error before an improvement; ``solved`` if no design that works performs better.
    """
    if design is None:
        return ObjectiveStatus.UNGROUNDED
    error = _error(design, situation)
    if error is not None:
        return error
    best = best_design(designs, situation)
    better = best is not None and best.performance > design.performance
    return ObjectiveStatus.IMPROVABLE if better else ObjectiveStatus.SOLVED


def _error(design: FunctionDesign, situation: Situation) -> ObjectiveStatus | None:
    if design.components & situation.failed:
        return ObjectiveStatus.COMPONENT_ERROR
    if not all(situation.reaches(quality, least) for quality, least in design.requires.items()):
        return ObjectiveStatus.QUALITY_ERROR
    return None


class Metacontroller:
    """Keeps objectives solved: each cycle analyses them, plans designs for those not solved, and changes modes.

    A function that is no objective any more is given up in the next cycle. When no design of an objective works, the
    one it has stays.

    Args:
        control: the designs, and the mode of a function that is no objective.
        situation: what has been observed.
        modes: changes the modes.
    """

    def __init__(self, control: ModeControl, situation: Situation, modes: ModeManager) -> None:
        self._control = control
        self._situation = situation
        self._modes = modes
        self._objectives: list[str] = []
        self._designs: dict[str, FunctionDesign] = {}

    def add_objectives(self, functions: Iterable[str]) -> None:
        """An action needs these functions from now on."""
        self._objectives.extend(functions)

    def remove_objectives(self, functions: Iterable[str]) -> None:
        """The action needs them no longer; another one may."""
        for function in functions:
            self._objectives.remove(function)

    def reason(self) -> None:
        """One cycle."""
        for function in [name for name in self._designs if name not in self._objectives]:
            if self._modes.change_mode(function, self._control.unused_mode):
                del self._designs[function]
        for function in dict.fromkeys(self._objectives):
            self._solve(function, [design for design in self._control.designs if design.function == function])

    def _solve(self, function: str, designs: list[FunctionDesign]) -> None:
        status = analyse(self._designs.get(function), designs, self._situation)
        best = best_design(designs, self._situation)
        if status is not ObjectiveStatus.SOLVED and best is not None and self._modes.change_mode(function, best.mode):
            self._designs[function] = best


def metacontrol_manager(mission: Mission) -> TreeRunner:
    """The mission's tree, every action counting as feasible, over a metacontroller that reasons every 1.5 s."""
    control = mode_control(mission)
    controller = Metacontroller(control, observed(mission), mode_manager(mission))

    def skill_of(action: str) -> Skill:
        begin = partial(controller.add_objectives, control.functions[action])
        end = partial(controller.remove_objectives, control.functions[action])
        return WithHooks(mission.skills[action], begin, end)

    mission.call_every(REASONING_PERIOD, controller.reason)
    return mission.runner(mission.unguarded_tree(skill_of))
