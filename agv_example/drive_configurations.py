"""In what ways the robot can drive now: the feasible configurations of an action, as the knowledge base knows them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from rosa_core import KnowledgeBase, Situation
from rosa_core.kb import CompleteConfiguration
from rosa_core.model.elements import Constraint, ConstraintOperator

ACTION = "navigate"
LIGHT = "light"
SPEED = "move_speed"


@dataclass(frozen=True, slots=True)
class DriveConfiguration:
    """One complete configuration of ``navigate``.

    Args:
        name: what distinguishes it from the others.
        designs, settings: what to select in the knowledge base: function designs, component configurations.
        components: what runs then.
        speed: m/s.
        energy: the estimated draw, in units per second.
        accuracy, safety: as estimated.
    """

    name: str
    designs: tuple[str, ...]
    settings: tuple[str, ...]
    components: frozenset[str]
    speed: float
    energy: float
    accuracy: float
    safety: float


@dataclass(frozen=True)
class DriveOptions:
    """All that can be driven with in some light, and which of it in which.

    ``lit`` gives for each answer of the constraints on light the numbers of those configurations that are feasible.
    """

    configurations: tuple[DriveConfiguration, ...]
    limits: tuple[Constraint, ...]
    lit: Mapping[tuple[bool, ...], frozenset[int]]

    def in_light(self, light: float) -> frozenset[int]:
        """The numbers of the configurations that are feasible in this light.

        Raises:
            KeyError: if that was not asked of the knowledge base.
        """
        return self.lit[answers(self.limits, light)]


def answers(limits: Iterable[Constraint], light: float) -> tuple[bool, ...]:
    """Which of the constraints hold in this light; the same answers, the same feasible configurations.

    Args:
        limits: constraints on the light.
        light: from 0, dark, to 1.

    Returns:
        one truth value for each constraint.
    """
    return tuple(_COMPARISONS[limit.operator](light, limit.value or 0.0) for limit in limits)


def drive_options(kb: KnowledgeBase, lights: Iterable[float], action: str = ACTION) -> DriveOptions:
    """Ask the knowledge base what would be feasible in each of these lights, all else being as it is.

    Args:
        kb: the knowledge base; nothing in it changes.
        lights: from 0, dark, to 1.
        action: the action that is to be configured; its parameter ``move_speed`` (m/s) says how fast it drives.
    """
    knows_light = any(measure.name == LIGHT for measure in kb.model.measures)
    limits = tuple(
        constraint for constraint, _ in kb.constraints() if constraint.measure == LIGHT and constraint.value is not None
    )
    cases = {answers(limits, light): light for light in lights}
    reader = _Reader(kb)
    found: dict[DriveConfiguration, int] = {}
    lit: dict[tuple[bool, ...], frozenset[int]] = {}
    for case, light in sorted(cases.items()):
        with kb.supposing(Situation(measurements={LIGHT: light} if knows_light else {})):
            feasible = [reader.read(complete) for complete in kb.configurations(action)]
        lit[case] = frozenset(found.setdefault(one, len(found)) for one in feasible if one.speed > 0.0)
    return DriveOptions(tuple(found), limits, lit)


class _Reader:
    """Makes drive configurations of the complete ones."""

    def __init__(self, kb: KnowledgeBase) -> None:
        self._kb = kb
        self._parts = {design.name: design.components for design in kb.model.function_designs}
        designs = Counter(design.function for design in kb.model.function_designs)
        self._several = frozenset(function for function, number in designs.items() if number > 1)

    def read(self, complete: CompleteConfiguration) -> DriveConfiguration:
        """The configuration, named by what can be otherwise."""
        designs, settings = complete.function_designs, tuple(complete.component_configurations.values())
        distinguishing = [design for function, design in designs.items() if function in self._several]
        estimates = complete.estimates
        return DriveConfiguration(
            name=", ".join((*distinguishing, *settings)),
            designs=tuple(designs.values()),
            settings=settings,
            components=frozenset(part for design in designs.values() for part in self._parts[design]),
            speed=self._speed(settings),
            energy=estimates.get("energy", 0.0),
            accuracy=estimates.get("accuracy", 0.0),
            safety=estimates.get("safety", 0.0),
        )

    def _speed(self, settings: Iterable[str]) -> float:
        for setting in settings:
            speed = self._kb.component_parameters(setting).get(SPEED)
            if isinstance(speed, int | float):
                return float(speed)
        return 0.0


_COMPARISONS = {
    ConstraintOperator.LESS: float.__lt__,
    ConstraintOperator.LESS_OR_EQUAL: float.__le__,
    ConstraintOperator.GREATER: float.__gt__,
    ConstraintOperator.GREATER_OR_EQUAL: float.__ge__,
}
