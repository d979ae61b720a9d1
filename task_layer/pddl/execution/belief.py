"""What the executor believes to hold: the effects of what it has done, corrected by what is known better."""

from __future__ import annotations

from rosa_core import Clock
from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.sensing import SensedFacts
from task_layer.pddl.grounding.bits import bits
from task_layer.pddl.grounding.ground_task import Effect, GroundTask, Operator, State, apply


class Belief:
    """The state that a plan is carried out in.

    Feasibility is the knowledge base's, sensed facts are the sensors', all other facts are what the effects say. An
    effect on a fact that is known better is *expected* for a while: the plan counts on it, but nothing starts on it.

    Args:
        task: the planning task.
        bridge: where feasibility is known.
        sensed: where sensed facts are known.
        clock: where the time comes from.
        effect_delay: how long an effect may take to be seen, in s.
    """

    def __init__(
        self, task: GroundTask, bridge: FeasibilityBridge, sensed: SensedFacts, clock: Clock, effect_delay: float
    ) -> None:
        self._task = task
        self._bridge = bridge
        self._sensed = sensed
        self._clock = clock
        self._effect_delay = effect_delay
        self._believed = task.initial
        self._expected: dict[int, tuple[bool, float, Operator]] = {}

    def now(self) -> State:
        """What holds, as far as is known."""
        return self._sensed.seen(self._believed & ~self._bridge.mask | self._bridge.feasible())

    def expected(self) -> State:
        """What holds, or is going to be seen to hold."""
        state = self.now()
        for bit, (value, _, _) in self._expected.items():
            state = state | bit if value else state & ~bit
        return state

    def take_effect(self, operator: Operator, effects: tuple[Effect, ...]) -> bool:
        """Effects of an operator have taken place; false if not all of them are to be seen yet."""
        before = self.now()
        after = apply(before, effects)
        changed = before ^ after
        self._believed = self._believed & ~changed | after & changed
        for bit in [bit for bit in self._expected if any(bit & (effect.add | effect.delete) for effect in effects)]:
            # Only the latest effect on a fact is waited for.
            del self._expected[bit]
        return self._expect(operator, after, changed)

    def missed_effects(self) -> list[tuple[Operator, str]]:
        """The operators, each with a fact that should have been seen to change by now; it is waited for no longer."""
        now, state = self._clock.now(), self.now()
        for bit in [bit for bit, (value, _, _) in self._expected.items() if bool(state & bit) is value]:
            del self._expected[bit]
        late = [bit for bit, (_, until, _) in self._expected.items() if until <= now]
        missed = [(self._expected.pop(bit)[2], bit) for bit in late]
        return [(operator, fact) for operator, bit in missed for fact in self._task.facts_in(bit)]

    def _expect(self, operator: Operator, after: State, changed: int) -> bool:
        until = self._clock.now() + self._effect_delay
        unseen = (self.now() ^ after) & changed & (self._bridge.mask | self._sensed.mask)
        for bit in (1 << index for index in bits(unseen)):
            self._expected[bit] = (bool(after & bit), until, operator)
        return not unseen
