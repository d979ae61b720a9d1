"""When the runner ticks, and what the knowledge base sees of a tick."""

from __future__ import annotations

import threading
from typing import Any

import py_trees
import pytest
from py_trees.common import Status

from rosa_core import KnowledgeBase, SimulationClock
from rosa_core.kb import ActionUpdate
from task_layer.action_requests import ActionRequests
from task_layer.bt import (
    Condition,
    Fallback,
    IsActionFeasible,
    ReactiveSequence,
    RetryUntilSuccessful,
    RosaAction,
    SequenceWithMemory,
    TreeRunner,
)
from task_layer.skill import Skill, SkillStatus


class Forever(Skill):
    def update(self) -> SkillStatus:
        return SkillStatus.RUNNING


class TickTimes(py_trees.behaviour.Behaviour):
    """Writes down when it is ticked."""

    def __init__(self, clock: SimulationClock) -> None:
        super().__init__("times")
        self.clock = clock
        self.times: list[float] = []

    def update(self) -> Status:
        self.times.append(round(self.clock.now(), 6))
        return Status.RUNNING


def guarded(action: str) -> py_trees.behaviour.Behaviour:
    return ReactiveSequence(action, [IsActionFeasible(action), RosaAction(action, Forever())])


def test_it_ticks_at_its_period_when_nothing_happens(kb: KnowledgeBase, clock: SimulationClock) -> None:
    leaf = TickTimes(clock)
    with TreeRunner(leaf, kb, period=1.0) as runner:
        assert runner.run(timeout=3.5) == Status.RUNNING
    assert leaf.times == [0.0, 1.0, 2.0, 3.0, 3.5]


def test_it_ticks_at_the_moment_when_a_status_changes(kb: KnowledgeBase, clock: SimulationClock) -> None:
    leaf = TickTimes(clock)
    clock.call_at(0.3, lambda: kb.add_measurement("battery_level", 0.9))
    clock.call_at(0.4, lambda: kb.add_measurement("battery_level", 0.8))  # changes no status
    clock.call_at(0.7, lambda: kb.set_component_failure("c_thruster_1"))
    with TreeRunner(leaf, kb, period=1.0) as runner:
        runner.run(timeout=1.0)
    assert leaf.times == [0.0, 0.3, 0.7, 1.0]


def test_it_ticks_when_it_is_woken(kb: KnowledgeBase, clock: SimulationClock) -> None:
    leaf = TickTimes(clock)
    with TreeRunner(leaf, kb, period=1.0) as runner:
        clock.call_at(0.25, runner.wake)
        runner.run(timeout=0.5)
    assert leaf.times == [0.0, 0.25, 0.5]


def test_a_tree_does_not_chase_its_own_requests(kb: KnowledgeBase, clock: SimulationClock) -> None:
    """Every tick requests and fails an action; without care each would wake the next, and no time would pass."""

    class Fails(Skill):
        def update(self) -> SkillStatus:
            return SkillStatus.FAILURE

    root = py_trees.decorators.FailureIsRunning("again", RosaAction("recharge", Fails()))
    with TreeRunner(root, kb, period=0.5) as runner:
        runner.run(timeout=2.0)
    assert clock.now() == 2.0
    assert len(kb.history("required_actions")) == 5


def test_a_switch_of_branches_is_one_change_of_the_knowledge_base(kb: KnowledgeBase, clock: SimulationClock) -> None:
    """The selector starts the new branch before it stops the old one: the knowledge base never has both, or neither."""
    seen: list[list[str]] = []
    updates: list[ActionUpdate] = []
    kb.subscribe(lambda _event: seen.append([a.action for a in kb.required_actions()]))
    kb.subscribe(updates.append, (ActionUpdate,))
    root = py_trees.composites.Selector(
        "task", memory=False, children=[guarded("search_pipeline"), guarded("recharge")]
    )
    with TreeRunner(root, kb, period=1.0) as runner:
        kb.add_measurement("battery_level", 0.1)
        runner.tick()
        assert seen[-1] == ["recharge"]
        seen.clear()
        kb.add_measurement("battery_level", 1.0)
        runner.tick()
    assert [event.requested[0].action for event in updates] == ["recharge", "search_pipeline"]
    assert updates[1].ended[0].action == "recharge"
    assert all(len(actions) == 1 for actions in seen)


def test_what_runs_when_the_time_is_up_is_interrupted(kb: KnowledgeBase, clock: SimulationClock) -> None:
    with TreeRunner(guarded("recharge"), kb) as runner:
        assert runner.run(timeout=1.0) == Status.RUNNING
        assert kb.required_actions() == []
        assert runner.tree.root.status == Status.INVALID


def test_it_stops_when_the_tree_is_done_or_the_condition_holds(kb: KnowledgeBase, clock: SimulationClock) -> None:
    with TreeRunner(Condition("done", lambda: clock.now() > 0), kb) as runner:
        assert runner.run() == Status.FAILURE
    leaf = TickTimes(clock)
    with TreeRunner(leaf, kb, period=1.0) as runner:
        assert runner.run(until=lambda: clock.now() >= 2.0) == Status.RUNNING
    assert leaf.times == [0.0, 1.0, 2.0]


def test_a_leaf_that_raises_under_a_stock_composite_fails_the_tree_and_leaves_nothing_required(
    kb: KnowledgeBase,
) -> None:
    class Broken(py_trees.behaviour.Behaviour):
        def update(self) -> Status:
            raise RuntimeError("sensor gone")

    root = py_trees.composites.Parallel(
        "both",
        policy=py_trees.common.ParallelPolicy.SuccessOnAll(synchronise=False),
        children=[guarded("recharge"), Broken("broken")],
    )
    with TreeRunner(root, kb) as runner:
        assert runner.run() == Status.FAILURE
    assert "sensor gone" in root.feedback_message
    assert kb.required_actions() == []


def test_a_closed_runner_is_not_woken_any_more(kb: KnowledgeBase, clock: SimulationClock) -> None:
    leaf = TickTimes(clock)
    runner = TreeRunner(leaf, kb, period=1.0)
    runner.close()
    clock.call_at(0.3, lambda: kb.add_measurement("battery_level", 0.1))
    runner.run(timeout=0.5)
    assert leaf.times == [0.0, 0.5]


def test_on_the_wall_clock_a_change_from_another_thread_wakes_it(extended_model) -> None:
    kb = KnowledgeBase(extended_model)
    root = Fallback(
        "until low",
        [ReactiveSequence("search", [IsActionFeasible("search_pipeline"), RosaAction("search_pipeline", Forever())])],
    )
    with TreeRunner(root, kb, period=60.0) as runner:
        timer = threading.Timer(0.05, lambda: kb.add_measurement("battery_level", 0.1))
        timer.start()
        assert runner.run(timeout=30.0) == Status.FAILURE
        timer.join()


def test_another_thread_can_interrupt_it(extended_model) -> None:
    kb = KnowledgeBase(extended_model)
    with TreeRunner(guarded("recharge"), kb, period=60.0) as runner:
        timer = threading.Timer(0.05, runner.interrupt)
        timer.start()
        assert runner.run(timeout=30.0) == Status.RUNNING
        timer.join()


@pytest.mark.parametrize("period", [0.0, -1.0, float("nan")])
def test_a_period_in_which_no_time_passes_is_refused(kb: KnowledgeBase, period: float) -> None:
    with pytest.raises(ValueError, match="period"):
        TreeRunner(guarded("recharge"), kb, period=period)


def test_a_request_refused_when_it_is_committed_is_reported(kb: KnowledgeBase) -> None:
    requests = ActionRequests(kb)
    reasons: list[str] = []
    with requests.together():
        requests.request("search_pipeline", refused=reasons.append)
        kb.add_measurement("battery_level", 0.1)  # between the tick and its commit
        assert reasons == []
    assert "battery_level 0.1" in reasons[0]
    assert kb.required_actions() == []


class Raises(py_trees.behaviour.Behaviour):
    """Raises whenever it is ticked."""

    def update(self) -> Status:
        raise ZeroDivisionError("no luck")


@pytest.mark.parametrize(
    "tree",
    [
        Fallback("ours", [Raises("unlucky")]),
        py_trees.composites.Selector("stock", memory=False, children=[Raises("unlucky")]),
        Raises("unlucky"),
    ],
    ids=["under a node", "under a stock composite", "at the root"],
)
def test_a_behaviour_that_raises_has_failed_and_the_reason_is_reported(tree: py_trees.behaviour.Behaviour) -> None:
    heard: list[tuple[str, Exception]] = []
    with TreeRunner(
        tree, clock=SimulationClock(), on_raise=lambda who, error: heard.append((who.name, error))
    ) as runner:
        assert runner.run() == Status.FAILURE
    assert [type(error) for _, error in heard] == [ZeroDivisionError]


def test_a_behaviour_that_asks_for_it_is_ticked_at_the_time_it_names() -> None:
    clock = SimulationClock()
    ticked: list[float] = []

    class Sleeper(py_trees.behaviour.Behaviour):
        def setup(self, **kwargs: Any) -> None:
            self.wake_at = kwargs["wake_at"]

        def initialise(self) -> None:
            self.wake_at(clock.now() + 0.3)
            self.wake_at(clock.now() + 1.7)

        def update(self) -> Status:
            ticked.append(clock.now())
            return Status.SUCCESS if clock.now() >= 1.7 else Status.RUNNING

    with TreeRunner(Sleeper("sleeper"), clock=clock, period=1.0) as runner:
        assert runner.run() == Status.SUCCESS
    assert ticked == pytest.approx([0.0, 0.3, 1.3, 1.7])


def test_a_tree_that_fails_at_once_again_and_again_lets_time_pass() -> None:
    clock = SimulationClock()
    attempts: list[float] = []

    def fail() -> bool:
        attempts.append(clock.now())
        return False

    tree = RetryUntilSuccessful("for ever", Condition("never", fail), -1)
    with TreeRunner(tree, clock=clock, period=1.0) as runner:
        assert runner.run(timeout=3.5) == Status.RUNNING
    # It sees that the second attempt came to the same as the third, and then only a period brings another.
    assert attempts == [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.5]


def test_a_chain_of_instant_children_is_done_without_time_passing() -> None:
    clock = SimulationClock()
    instants = [Condition(str(number), lambda: True) for number in range(30)]
    with TreeRunner(SequenceWithMemory("chain", instants), clock=clock, period=1.0) as runner:
        assert runner.run() == Status.SUCCESS
    assert clock.now() == 0.0
