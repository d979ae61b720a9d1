"""A mission that cannot go on does not spin, and says what it was waiting for."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import KnowledgeBase, SimulationClock
from task_layer.bt import (
    AsyncFallback,
    AsyncSequence,
    Condition,
    Delay,
    Fallback,
    ForceFailure,
    ForceSuccess,
    Inverter,
    IsActionFeasible,
    KeepRunningUntilFailure,
    Parallel,
    ReactiveFallback,
    ReactiveSequence,
    Repeat,
    RetryUntilSuccessful,
    RosaAction,
    RunOnce,
    Sequence,
    SequenceWithMemory,
    Timeout,
    TreeRunner,
    if_feasible,
)
from task_layer.bt.testing import FakeKnowledgeBase, ScriptedLeaf, ScriptedSkill

PERIODS = 60


def ticks_of(root: Behaviour, kb: KnowledgeBase | None = None, clock: SimulationClock | None = None) -> int:
    with TreeRunner(root, kb, clock=clock or (SimulationClock() if kb is None else kb.clock), period=0.5) as runner:
        runner.run(timeout=PERIODS * 0.5)
        return runner.tree.count


class _Always(Behaviour):
    """A leaf that comes to the same at every tick."""

    def __init__(self, status: Status):
        super().__init__(status.name)
        self._comes_to = status

    def update(self) -> Status:
        return self._comes_to


_DECORATORS = {
    "Retry": lambda child: RetryUntilSuccessful("retry", child, -1),
    "Retry 3": lambda child: RetryUntilSuccessful("retry", child, 3),
    "Repeat": lambda child: Repeat("repeat", child, -1),
    "Repeat 2": lambda child: Repeat("repeat", child, 2),
    "KeepRunning": lambda child: KeepRunningUntilFailure("keep", child),
    "Inverter": lambda child: Inverter("not", child),
    "ForceSuccess": lambda child: ForceSuccess("ok", child),
    "ForceFailure": lambda child: ForceFailure("fail", child),
    "RunOnce": lambda child: RunOnce("once", child, False),
    "Delay": lambda child: Delay("delay", child, 700),
    "Timeout": lambda child: Timeout("timeout", child, 700),
}
_SEVERAL = (
    Sequence,
    AsyncSequence,
    SequenceWithMemory,
    ReactiveSequence,
    Fallback,
    AsyncFallback,
    ReactiveFallback,
    Parallel,
)
_leaves = st.sampled_from((Status.SUCCESS, Status.FAILURE, Status.RUNNING))
_trees = st.recursive(
    _leaves,
    lambda below: (
        st.tuples(st.sampled_from(sorted(_DECORATORS)), below)
        | st.tuples(st.sampled_from(_SEVERAL), st.lists(below, min_size=1, max_size=3))
    ),
    max_leaves=6,
)


def _made(described: object) -> Behaviour:
    if isinstance(described, Status):
        return _Always(described)
    kind, below = described
    if isinstance(kind, str):
        return _DECORATORS[kind](_made(below))
    return kind(kind.__name__, [_made(each) for each in below])


@settings(max_examples=200)
@given(_trees, st.sampled_from((None, "Retry", "Repeat", "KeepRunning")))
def test_ticks_are_bounded_by_the_period_whatever_the_decorators(described: object, above: str | None) -> None:
    root = _made(described if above is None else (above, described))
    nodes = sum(1 for _ in root.iterate())
    # At first it may find out that it has tried everything; a Delay or Timeout has a tick of its own at its end.
    timers = 1 + sum(isinstance(node, Delay | Timeout) for node in root.iterate())
    assert ticks_of(root) <= timers * (PERIODS + 1) + 12 * nodes


def test_a_retry_in_vain_is_one_tick_a_period() -> None:
    assert ticks_of(RetryUntilSuccessful("retry", _Always(Status.FAILURE), -1)) == PERIODS + 1 + 2


def test_a_limited_number_of_attempts_is_made_at_once() -> None:
    clock = SimulationClock()
    leaf = ScriptedLeaf("leaf", "F")
    assert ticks_of(RetryUntilSuccessful("retry", leaf, 3), clock=clock) == 3
    assert clock.now() == 0.0


def test_a_sequence_that_yields_goes_on_at_once() -> None:
    clock = SimulationClock()
    root = SequenceWithMemory("mission", [ScriptedLeaf(name) for name in "abcdef"])
    assert ticks_of(root, clock=clock) == 6
    assert clock.now() == 0.0


def test_what_follows_the_end_of_an_action_comes_at_once_every_time() -> None:
    clock = SimulationClock()
    ends: list[float] = []

    class Slow(Behaviour):
        def initialise(self) -> None:
            self.ticks = 0

        def update(self) -> Status:
            self.ticks += 1
            return Status.RUNNING if self.ticks < 3 else Status.SUCCESS

    def note() -> bool:
        ends.append(clock.now())
        return False

    root = RetryUntilSuccessful("again", AsyncSequence("all", [Slow("slow"), Condition("note", note)]), -1)
    ticks_of(root, clock=clock)
    assert ends[:4] == [1.0, 2.0, 3.0, 4.0]


def patrol(kb: FakeKnowledgeBase, done: list[float]) -> Behaviour:
    """A mission that tries for ever to go, and then to look."""

    def note() -> bool:
        done.append(kb.clock.now())
        return True

    steps = [if_feasible(RosaAction(name, ScriptedSkill("S"))) for name in ("go", "look")]
    return RetryUntilSuccessful("until done", Sequence("patrol", [*steps, Condition("note", note)]), -1)


def test_a_change_of_the_knowledge_base_is_met_at_once() -> None:
    kb, done = FakeKnowledgeBase("go", "look"), []
    kb.make_unfeasible("look")
    kb.clock.call_at(3.2, lambda: kb.make_feasible("look"))
    with TreeRunner(patrol(kb, done), kb, period=0.5) as runner:
        assert runner.run(timeout=10.0) is Status.SUCCESS
        assert runner.tree.count < 25
        assert runner.waiting_for == ()
    assert done == [3.2]


def test_it_says_what_it_was_waiting_for() -> None:
    kb = FakeKnowledgeBase("go", "look", "other")
    kb.make_unfeasible("look", "other")
    with TreeRunner(patrol(kb, []), kb, period=0.5) as runner:
        assert runner.waiting_for == ()
        assert runner.run(timeout=10.0) is Status.RUNNING
        (awaited,) = runner.waiting_for
    assert awaited.action == "look"
    assert awaited.reason.startswith("look is unfeasible: look part: a failure was reported")
    assert awaited.remedies == ("component look part must recover",)


def test_while_an_action_is_performed_it_waits_for_nothing() -> None:
    kb = FakeKnowledgeBase("go", "rest")
    kb.make_unfeasible("go")
    rest = if_feasible(RosaAction("rest", ScriptedSkill("R")))
    root = Fallback("go or rest", [if_feasible(RosaAction("go", ScriptedSkill("S"))), rest])
    with TreeRunner(root, kb, period=0.5) as runner:
        runner.run(timeout=10.0)
        assert runner.waiting_for == ()


def test_what_was_asked_for_long_ago_does_not_count() -> None:
    kb = FakeKnowledgeBase("go", "look")
    kb.make_unfeasible("go")
    once = ForceSuccess("never mind", RosaAction("go", ScriptedSkill("S")))
    root = Sequence("all", [once, RetryUntilSuccessful("wait", IsActionFeasible("look"), -1)])
    kb.clock.call_at(0.1, lambda: kb.make_unfeasible("look"))
    kb.make_unfeasible("look")
    with TreeRunner(root, kb, period=0.5) as runner:
        runner.run(timeout=10.0)
        assert [awaited.action for awaited in runner.waiting_for] == ["look"]


def test_why_is_asked_once_as_long_as_nothing_changes() -> None:
    kb = FakeKnowledgeBase("go")
    kb.make_unfeasible("go")
    asked: list[str] = []
    why = kb.why
    kb.why = lambda kind, name: asked.append(name) or why(kind, name)
    with TreeRunner(RetryUntilSuccessful("wait", IsActionFeasible("go"), -1), kb, period=0.5) as runner:
        runner.run(timeout=10.0)
    assert asked == ["go", "go"]  # the second time for the runner's own report
