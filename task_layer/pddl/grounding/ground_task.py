"""Ground facts and operators: a planning task without variables, in the form in which it is cheap to check.

A state is an integer: bit ``i`` is set when fact ``i`` holds. So a condition is tested with two operations however many
facts it names, and a state can be a key.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from task_layer.pddl.grounding.bits import bits

State = int


@dataclass(frozen=True, slots=True)
class Condition:
    """Facts that must hold, and facts that must not, each as a bit mask."""

    positive: int = 0
    negative: int = 0

    def holds(self, state: State) -> bool:
        """Whether it is met in a state.

        Example:
            >>> Condition(positive=0b01, negative=0b10).holds(0b01)
            True
        """
        return state & self.positive == self.positive and not state & self.negative

    def missing(self, state: State) -> Condition:
        """The part that is not met in a state."""
        return Condition(self.positive & ~state, self.negative & state)

    def also(self, other: Condition) -> Condition:
        """Both conditions."""
        return Condition(self.positive | other.positive, self.negative | other.negative)

    @property
    def facts(self) -> int:
        """The facts that it is about."""
        return self.positive | self.negative

    @property
    def impossible(self) -> bool:
        """Whether no state can meet it."""
        return bool(self.positive & self.negative)


NOTHING = Condition()


@dataclass(frozen=True, slots=True)
class Effect:
    """Facts that become true and false where its condition is met; what is both becomes true, as PDDL has it."""

    add: int = 0
    delete: int = 0
    condition: Condition = NOTHING


def apply(state: State, effects: Iterable[Effect]) -> State:
    """The state after effects.

    Args:
        state: the state before.
        effects: their conditions are all tested in that state, before any of them takes place.

    Returns:
        the state after; what is both made true and made false is true, as PDDL has it.

    Example:
        >>> bin(apply(0b01, [Effect(add=0b10, delete=0b01)]))
        '0b10'
    """
    add = delete = 0
    for effect in effects:
        if effect.condition.holds(state):
            add |= effect.add
            delete |= effect.delete
    return state & ~delete | add


@dataclass(frozen=True, slots=True)
class Operator:
    """A ground action: what it requires at its start, throughout and at its end, and what it changes.

    An action of plain PDDL has its precondition at the start and its effects at the end. Of an action with ``or`` in
    its conditions there are several, of the same name.

    Attributes:
        index: its place among the operators of its task.
        action: the action's name as written in the domain.
        arguments: the objects' names as written.
        at_start: what must hold when it starts.
        over_all: what must hold from its start to its end.
        at_end: what must hold when it ends.
        start_effects: what its start changes.
        end_effects: what its end changes.
        duration: what the domain says, in s; 0 for an action of plain PDDL.
        feasibility: the facts ``(action_feasible X)`` among its requirements, as a mask.
        condition: of the action taken as instantaneous: all its requirements less what it makes true itself.
        effects: of the action taken as instantaneous: those of its start and of its end together.
    """

    index: int
    action: str
    arguments: tuple[str, ...]
    at_start: Condition
    over_all: Condition
    at_end: Condition
    start_effects: tuple[Effect, ...]
    end_effects: tuple[Effect, ...]
    duration: float = 0.0
    feasibility: int = 0
    condition: Condition = field(init=False)
    effects: tuple[Effect, ...] = field(init=False)

    def __post_init__(self) -> None:
        made, removed = _unconditional(self.start_effects)
        later = self.over_all.also(self.at_end)
        later = Condition(later.positive & ~made, later.negative & ~removed)
        object.__setattr__(self, "condition", self.at_start.also(later))
        object.__setattr__(self, "effects", _sequential_effects(self.start_effects, self.end_effects))

    @property
    def name(self) -> str:
        """The ground action as a plan has it, such as ``(inspect_pipeline p1 bluerov)``."""
        return ground_name(self.action, self.arguments)

    @property
    def to_start(self) -> Condition:
        """What must hold before it starts: at-start, and over-all less what it makes true at its start itself."""
        made, removed = _unconditional(self.start_effects)
        over_all = Condition(self.over_all.positive & ~made, self.over_all.negative & ~removed)
        return self.at_start.also(over_all)

    @property
    def facts(self) -> int:
        """The facts that its requirements and the conditions of its effects are about, as a mask."""
        mask = self.at_start.facts | self.over_all.facts | self.at_end.facts
        for effect in (*self.start_effects, *self.end_effects):
            mask |= effect.condition.facts
        return mask

    @property
    def changes(self) -> int:
        """The facts that it may change, as a mask."""
        mask = 0
        for effect in (*self.start_effects, *self.end_effects):
            mask |= effect.add | effect.delete
        return mask


def _unconditional(effects: Iterable[Effect]) -> tuple[int, int]:
    """What effects make true and false whatever holds."""
    add = delete = 0
    for effect in effects:
        if effect.condition == NOTHING:
            add |= effect.add
            delete |= effect.delete
    return add, delete & ~add


def _sequential_effects(first: tuple[Effect, ...], then: tuple[Effect, ...]) -> tuple[Effect, ...]:
    """The effects of the start and of the end in one; the conditions of the later are put in terms of before both."""
    if not first:
        return then
    made, removed = _unconditional(first)
    add, delete = _unconditional(then)
    unconditional = Effect(made & ~delete | add, (removed | delete) & ~add)
    conditional = [effect for effect in first if effect.condition != NOTHING]
    for effect in then:
        given = effect.condition
        if given != NOTHING and not given.positive & removed and not given.negative & made:
            rest = Condition(given.positive & ~made, given.negative & ~removed)
            conditional.append(Effect(effect.add, effect.delete, rest))
    return (unconditional, *conditional)


def ground_name(name: str, arguments: Iterable[str]) -> str:
    """An atom as PDDL writes it."""
    return f"({' '.join((name, *arguments))})"


@dataclass(frozen=True, slots=True)
class GroundTask:
    """A planning task without variables.

    Attributes:
        name: the problem's name.
        facts: the facts that can change, as written in PDDL: ``(pipeline_found p1)``; fact ``i`` is bit ``i``.
        operators: every ground action that can have its unchanging conditions met.
        initial: the initial state of the problem file.
        goals: the goal; several if it is a choice, of which one is enough.
        feasibility: for each object that is an argument of the feasibility predicate, its fact's bit.
    """

    name: str
    facts: tuple[str, ...]
    operators: tuple[Operator, ...]
    initial: State
    goals: tuple[Condition, ...]
    feasibility: dict[str, int] = field(default_factory=dict)

    @property
    def predicates(self) -> frozenset[str]:
        """The predicates of the facts, in lower case."""
        return frozenset(fact.strip("()").split()[0].lower() for fact in self.facts)

    def is_goal(self, state: State) -> bool:
        """Whether the goal is reached."""
        return any(goal.holds(state) for goal in self.goals)

    def facts_in(self, mask: int) -> Iterator[str]:
        """The facts of a mask or state, in order."""
        return (self.facts[index] for index in bits(mask))

    def literals_of(self, condition: Condition) -> Iterator[str]:
        """A condition in words of PDDL: facts, and facts in ``(not ...)``."""
        yield from self.facts_in(condition.positive)
        yield from (f"(not {fact})" for fact in self.facts_in(condition.negative))

    def mask(self, facts: Iterable[str]) -> int:
        """The mask of facts as written, without regard to case and space.

        Args:
            facts: facts such as ``(pipeline_found p1)``.

        Returns:
            a mask with the bit of each.

        Raises:
            KeyError: if the task has no such fact, or it can never change.
        """
        known = {fact.lower(): 1 << index for index, fact in enumerate(self.facts)}
        mask = 0
        for fact in facts:
            mask |= known[ground_name("", fact.lower().strip("() ").split()).replace("( ", "(")]
        return mask
