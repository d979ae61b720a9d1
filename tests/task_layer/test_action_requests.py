"""What the knowledge base sees of requests, and when what was requested starts."""

from __future__ import annotations

import py_trees
import pytest
from py_trees.common import Status

from rosa_core import KnowledgeBase, Result, SimulationClock, UnknownElementError
from rosa_core.kb import ActionUpdate
from task_layer.action_requests import ActionRequests
from task_layer.bt import (
    Condition,
    Fallback,
    InstantAction,
    ParallelAll,
    ReactiveFallback,
    ReactiveSequence,
    RetryUntilSuccessful,
    RosaAction,
    Sequence,
    SequenceWithMemory,
    TreeRunner,
)
from task_layer.bt.testing import ScriptedSkill, expect_trace
from task_layer.skill import Skill, SkillStatus


def required(kb: KnowledgeBase) -> list[str]:
    return [action.action for action in kb.required_actions()]


def results(kb: KnowledgeBase) -> list[tuple[str, Result]]:
    return [(ended.action, ended.result) for ended in kb.history("required_actions")]  # type: ignore[union-attr,misc]


class Witness(Skill):
    """Writes down which actions are required when it starts and when it is updated."""

    def __init__(self, kb: KnowledgeBase) -> None:
        self.kb = kb
        self.seen: list[tuple[str, list[str]]] = []

    def start(self) -> None:
        self.seen.append(("start", required(self.kb)))

    def update(self) -> SkillStatus:
        self.seen.append(("update", required(self.kb)))
        return SkillStatus.RUNNING


def parallel(*children: py_trees.behaviour.Behaviour) -> py_trees.composites.Parallel:
    """All children are ticked; it fails as soon as one has failed, and halts the others."""
    return py_trees.composites.Parallel(
        "all", policy=py_trees.common.ParallelPolicy.SuccessOnAll(synchronise=False), children=list(children)
    )


def fail(reason: str) -> None:
    raise AssertionError(reason)


def test_with_a_runner_a_skill_starts_and_goes_on_in_the_tick_that_requests_its_action(kb: KnowledgeBase) -> None:
    skill = Witness(kb)
    with TreeRunner(RosaAction("recharge", skill), kb) as runner:
        assert runner.tick() is Status.RUNNING
        assert skill.seen == [("start", ["recharge"]), ("update", ["recharge"])]
        runner.tick()
    assert [what for what, _ in skill.seen] == ["start", "update", "update"]


def test_without_a_runner_a_skill_starts_at_once(kb: KnowledgeBase) -> None:
    skill = Witness(kb)
    tree = py_trees.trees.BehaviourTree(RosaAction("recharge", skill))
    tree.setup(kb=kb)
    tree.tick()
    assert skill.seen == [("start", ["recharge"]), ("update", ["recharge"])]


def test_the_robot_is_configured_when_a_skill_starts(kb: KnowledgeBase) -> None:
    """Whoever hears of the request has heard of it by then."""
    heard: list[str] = []
    kb.subscribe(lambda event: heard.extend(a.action for a in event.requested), (ActionUpdate,))  # type: ignore[attr-defined]

    class Start(Skill):
        def start(self) -> None:
            heard.append("start")

        def update(self) -> SkillStatus:
            return SkillStatus.RUNNING

    with TreeRunner(RosaAction("recharge", Start()), kb) as runner:
        runner.tick()
    assert heard == ["recharge", "start"]


def test_actions_that_are_done_at_once_are_done_in_one_tick(kb: KnowledgeBase) -> None:
    actions = ["search_pipeline", "inspect_pipeline", "recharge"]
    with TreeRunner(Sequence("all", [RosaAction(name, ScriptedSkill("S")) for name in actions]), kb) as runner:
        assert runner.tick() is Status.SUCCESS
    assert results(kb) == [(name, Result.COMPLETED) for name in actions]


def test_a_sequence_with_memory_yields_after_an_action_that_is_done_at_once(kb: KnowledgeBase) -> None:
    tree = SequenceWithMemory(
        "all", [RosaAction("search_pipeline", ScriptedSkill("S")), RosaAction("recharge", ScriptedSkill("RS"))]
    )
    expect_trace(tree, "search_pipeline S -> R", "recharge R -> R", "recharge S -> S", kb=kb)


def test_an_action_that_fails_at_once_again_and_again_lets_time_pass(kb: KnowledgeBase, clock: SimulationClock) -> None:
    tree = RetryUntilSuccessful("for ever", RosaAction("recharge", ScriptedSkill("F")), -1)
    with TreeRunner(tree, kb, period=1.0) as runner:
        assert runner.run(timeout=3.0) is Status.RUNNING
    assert clock.now() == 3.0


class Restless(py_trees.decorators.Decorator):
    """Starts its child again in the tick in which that has ended, without asking for another tick."""

    def update(self) -> Status:
        if self.decorated.status is not Status.RUNNING:
            self.decorated.tick_once()
        return Status.RUNNING


def test_even_a_tree_that_requests_without_end_in_one_tick_lets_time_pass(
    kb: KnowledgeBase, clock: SimulationClock
) -> None:
    tree = Restless("restless", RosaAction("recharge", ScriptedSkill("F")))
    with TreeRunner(tree, kb, period=1.0) as runner:
        assert runner.run(timeout=2.0) is Status.RUNNING
    assert clock.now() == 2.0


def test_a_request_that_is_refused_when_it_is_written_is_a_failure_in_the_same_tick(kb: KnowledgeBase) -> None:
    skill = ScriptedSkill("R")
    action = RosaAction("search_pipeline", skill)
    drained = InstantAction("drain", lambda: kb.add_measurement("battery_level", 0.1))
    with TreeRunner(parallel(action, drained), kb) as runner:
        assert runner.tick() is Status.FAILURE
    assert "the request is refused" in action.feedback_message
    assert "battery_level 0.1" in action.feedback_message
    assert skill.calls == []
    assert results(kb) == []


def test_what_is_interrupted_before_its_request_is_written_never_starts_and_leaves_no_trace(kb: KnowledgeBase) -> None:
    skill = ScriptedSkill("R")
    action = RosaAction("recharge", skill)
    revision = kb.revision
    with TreeRunner(parallel(action, Condition("no", lambda: False)), kb) as runner:
        assert runner.tick() is Status.FAILURE
    assert skill.calls == []
    assert kb.revision == revision
    assert action.feedback_message == "recharge was interrupted"


def test_a_skill_that_cannot_start_has_failed_and_that_is_heard_even_if_its_guard_halts_it(kb: KnowledgeBase) -> None:
    class Drains(Skill):
        def start(self) -> None:
            kb.add_measurement("battery_level", 0.1)
            raise OSError("no sonar")

        def update(self) -> SkillStatus:
            raise AssertionError

    heard: list[str] = []
    action = RosaAction("search_pipeline", Drains())
    guard = Condition("feasible", lambda: kb.is_action_feasible("search_pipeline"))
    root = Fallback("search or wait", [ReactiveSequence("guarded", [guard, action])])
    with TreeRunner(root, kb, on_raise=lambda who, error: heard.append(f"{who.name}: {error}")) as runner:
        assert runner.tick() is Status.FAILURE
    assert heard == ["search_pipeline: no sonar"]
    assert required(kb) == []


def test_a_switch_to_another_way_of_performing_the_same_action_keeps_it_required(kb: KnowledgeBase) -> None:
    wind = {"strong": False}
    careful, quick = ScriptedSkill("R"), ScriptedSkill("R")
    root = ReactiveFallback(
        "inspect",
        [
            ReactiveSequence(
                "carefully",
                [Condition("wind", lambda: wind["strong"]), RosaAction("inspect_pipeline", careful, name="carefully")],
            ),
            RosaAction("inspect_pipeline", quick, name="quickly"),
        ],
    )
    seen: list[list[str]] = []
    with TreeRunner(root, kb) as runner:
        runner.tick()
        kb.subscribe(lambda _: seen.append(required(kb)))
        wind["strong"] = True
        runner.tick()
        assert quick.calls == ["start", "update", "stop"]
        assert careful.calls == ["start", "update"]
        assert seen
        assert all(actions == ["inspect_pipeline"] for actions in seen)
        runner.halt()
    assert required(kb) == []


def test_an_action_that_two_perform_is_required_until_the_last_of_them_ends(kb: KnowledgeBase) -> None:
    first, second = RosaAction("recharge", ScriptedSkill("RS")), RosaAction("recharge", ScriptedSkill("RRS"))
    with TreeRunner(ParallelAll("both", [first, second]), kb) as runner:
        runner.tick()
        assert runner.tick() is Status.RUNNING
        assert first.status is Status.SUCCESS
        assert required(kb) == ["recharge"]
        assert runner.tick() is Status.SUCCESS
    assert results(kb) == [("recharge", Result.COMPLETED)]


def test_nothing_starts_if_the_block_raises_but_what_was_asked_for_is_written(kb: KnowledgeBase) -> None:
    requests = ActionRequests(kb)
    started: list[str] = []

    def start() -> bool:
        started.append("recharge")
        return False

    def ask_and_raise() -> None:
        with requests.together():
            requests.request("recharge", accepted=start, refused=fail)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ask_and_raise()
    assert started == []
    assert required(kb) == ["recharge"]


def test_what_ends_while_others_start_does_not_start(kb: KnowledgeBase) -> None:
    requests = ActionRequests(kb)

    def replace() -> bool:
        requests.cancel(second)
        return False

    def start() -> bool:
        raise AssertionError("it was cancelled before its turn came")

    with requests.together():
        first = requests.request("recharge", accepted=replace, refused=fail)
        second = requests.request("search_pipeline", accepted=start, refused=fail)
    assert required(kb) == ["recharge"]
    requests.finish(first, Result.COMPLETED)
    requests.finish(first, Result.FAILED)  # it is over: nothing happens any more
    assert results(kb) == [("search_pipeline", Result.ABANDONED), ("recharge", Result.COMPLETED)]


def test_an_action_that_there_is_not_is_found_when_it_is_requested(kb: KnowledgeBase) -> None:
    requests = ActionRequests(kb)
    with requests.together(), pytest.raises(UnknownElementError):
        requests.request("serch", refused=print)
