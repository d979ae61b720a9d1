"""IsActionFeasible and RosaAction in py_trees trees."""

from __future__ import annotations

import py_trees
import pytest
from py_trees.common import Status

from rosa_core import KnowledgeBase, UnknownElementError
from rosa_core.kb import Result
from task_layer.bt import Fallback, IsActionFeasible, ReactiveSequence, RosaAction, Sequence, TreeRunner
from task_layer.skill import Skill, SkillStatus


class Scripted(Skill):
    """Returns the given statuses one after the other, and writes down what is done with it."""

    def __init__(self, *statuses: SkillStatus) -> None:
        self.statuses = list(statuses)
        self.calls: list[str] = []

    def start(self) -> None:
        self.calls.append("start")

    def update(self) -> SkillStatus:
        self.calls.append("update")
        return self.statuses.pop(0) if self.statuses else SkillStatus.RUNNING

    def stop(self) -> None:
        self.calls.append("stop")


def ready(behaviour: py_trees.behaviour.Behaviour, kb: KnowledgeBase) -> py_trees.trees.BehaviourTree:
    tree = py_trees.trees.BehaviourTree(behaviour)
    tree.setup(kb=kb)
    return tree


def required(kb: KnowledgeBase) -> list[str]:
    return [action.action for action in kb.required_actions()]


def test_a_feasible_action_is_a_success_and_an_unfeasible_one_a_failure_that_says_why(kb: KnowledgeBase) -> None:
    condition = IsActionFeasible("search_pipeline")
    tree = ready(condition, kb)
    tree.tick()
    assert condition.status == Status.SUCCESS
    kb.add_measurement("battery_level", 0.24, time=150.0)
    tree.tick()
    assert condition.status == Status.FAILURE
    assert "battery_level 0.24 (measured at 150.0 s) violates >= 0.25" in condition.feedback_message


@pytest.mark.parametrize(
    ("outcome", "status", "result"),
    [
        (SkillStatus.SUCCESS, Status.SUCCESS, Result.COMPLETED),
        (SkillStatus.FAILURE, Status.FAILURE, Result.FAILED),
    ],
)
def test_an_action_is_required_while_it_runs_and_ends_with_its_result(
    kb: KnowledgeBase, outcome: SkillStatus, status: Status, result: Result
) -> None:
    skill = Scripted(SkillStatus.RUNNING, outcome)
    action = RosaAction("search_pipeline", skill)
    tree = ready(action, kb)
    tree.tick()
    assert action.status == Status.RUNNING
    assert required(kb) == ["search_pipeline"]
    tree.tick()
    assert action.status == status
    assert required(kb) == []
    (ended,) = kb.history("required_actions")
    assert ended.result is result
    assert skill.calls == ["start", "update", "update", "stop"]


def test_an_interrupted_action_is_cancelled_and_its_skill_stopped_once(kb: KnowledgeBase) -> None:
    skill = Scripted()
    action = RosaAction("search_pipeline", skill)
    tree = ready(action, kb)
    tree.tick()
    action.stop(Status.INVALID)
    action.stop(Status.INVALID)
    assert required(kb) == []
    assert [ended.result for ended in kb.history("required_actions")] == [Result.ABANDONED]
    assert skill.calls == ["start", "update", "stop"]
    assert action.feedback_message == "search_pipeline was interrupted"


def test_being_invalidated_after_it_completed_changes_nothing(kb: KnowledgeBase) -> None:
    action = RosaAction("search_pipeline", Scripted(SkillStatus.SUCCESS))
    tree = ready(action, kb)
    tree.tick()
    revision = kb.revision
    action.stop(Status.INVALID)
    assert kb.revision == revision
    assert [ended.result for ended in kb.history("required_actions")] == [Result.COMPLETED]


def test_an_unfeasible_action_fails_with_the_reason_and_its_skill_never_starts(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery_level", 0.1)
    skill = Scripted()
    action = RosaAction("inspect_pipeline", skill)
    tree = ready(action, kb)
    tree.tick()
    assert action.status == Status.FAILURE
    assert "battery_level 0.1" in action.feedback_message
    assert skill.calls == []
    assert kb.history("required_actions") == ()


def test_without_a_guard_an_action_that_becomes_unfeasible_goes_on(kb: KnowledgeBase) -> None:
    action = RosaAction("search_pipeline", Scripted())
    tree = ready(action, kb)
    tree.tick()
    kb.add_measurement("battery_level", 0.1)
    tree.tick()
    assert action.status == Status.RUNNING
    assert required(kb) == ["search_pipeline"]


def test_the_guard_stops_the_action_as_soon_as_it_is_unfeasible(kb: KnowledgeBase) -> None:
    skill = Scripted()
    root = ReactiveSequence("guarded", [IsActionFeasible("search_pipeline"), RosaAction("search_pipeline", skill)])
    tree = ready(root, kb)
    tree.tick()
    kb.add_measurement("battery_level", 0.1)
    tree.tick()
    assert root.status == Status.FAILURE
    assert required(kb) == []
    assert skill.calls == ["start", "update", "stop"]


def test_a_subclass_needs_only_the_hooks(kb: KnowledgeBase) -> None:
    calls = []

    class Search(RosaAction):
        def on_start(self) -> None:
            calls.append("on_start")

        def on_running(self) -> Status:
            calls.append("on_running")
            return Status.RUNNING

        def on_halted(self) -> None:
            calls.append("on_halted")

    action = Search("search_pipeline")
    tree = ready(action, kb)
    tree.tick()
    assert required(kb) == ["search_pipeline"]
    action.stop(Status.INVALID)
    assert calls == ["on_start", "on_running", "on_halted"]
    assert required(kb) == []


def test_an_action_with_neither_skill_nor_hook_says_so(kb: KnowledgeBase) -> None:
    tree = ready(RosaAction("search_pipeline"), kb)
    tree.tick()
    assert tree.root.status is Status.FAILURE
    assert "'search_pipeline' has no skill" in tree.root.feedback_message


def test_an_action_that_the_model_does_not_have_is_found_at_setup(kb: KnowledgeBase) -> None:
    with pytest.raises(UnknownElementError, match=r"did you mean 'search_pipeline'\?"):
        ready(IsActionFeasible("search_pipelin"), kb)


def test_setup_without_a_knowledge_base_says_what_is_missing() -> None:
    with pytest.raises(RuntimeError, match=r"tree\.setup\(kb=kb\)"):
        py_trees.trees.BehaviourTree(IsActionFeasible("search_pipeline")).setup()
    leaf = IsActionFeasible("search_pipeline")
    leaf.tick_once()
    assert leaf.status is Status.FAILURE
    assert "ticked before setup" in leaf.feedback_message


def test_visitors_and_displays_of_py_trees_work_on_our_nodes(kb: KnowledgeBase) -> None:
    guarded = [IsActionFeasible("recharge"), RosaAction("recharge", Scripted())]
    tree = ready(ReactiveSequence("guarded", guarded), kb)
    snapshot = py_trees.visitors.SnapshotVisitor()
    tree.add_visitor(snapshot)
    tree.tick()
    assert len(snapshot.visited) == 3
    shown = py_trees.display.unicode_tree(tree.root, show_status=True)
    assert "recharge is feasible" in shown
    assert "performing recharge" in shown
    assert "recharge" in py_trees.display.dot_tree(tree.root).to_string()


class Breaking(RosaAction):
    """Raises in the hook that a test names."""

    def __init__(self, hook: str, skill: Skill | None = None) -> None:
        super().__init__("search_pipeline", skill)
        self._hook = hook

    def _maybe(self, hook: str) -> None:
        if self._hook == hook:
            raise OSError(f"no sonar in {hook}")

    def on_start(self) -> None:
        self._maybe("on_start")

    def on_running(self) -> Status:
        self._maybe("on_running")
        return Status.RUNNING

    def on_halted(self) -> None:
        self._maybe("on_halted")


@pytest.mark.parametrize("hook", ["on_start", "on_running", "on_halted"])
def test_an_action_whose_hook_raises_is_not_required_any_longer(kb: KnowledgeBase, hook: str) -> None:
    raised: list[str] = []
    action = Breaking(hook)
    tree = Fallback("search or wait", [action, py_trees.behaviours.Running("wait")])
    with TreeRunner(tree, kb, on_raise=lambda _, error: raised.append(str(error))) as runner:
        runner.tick()
        runner.halt()
    assert raised == [f"no sonar in {hook}"]
    assert action.feedback_message == f"raised OSError: no sonar in {hook}"
    assert required(kb) == []


def test_a_skill_is_stopped_even_if_the_hook_before_that_raises(kb: KnowledgeBase) -> None:
    skill = Scripted()
    with TreeRunner(Sequence("all", [Breaking("on_halted", skill)]), kb, on_raise=lambda *_: None) as runner:
        runner.tick()
        runner.halt()
    assert skill.calls == ["stop"]


class BadlyStopped(Skill):
    """Succeeds, but cannot clean up."""

    def update(self) -> SkillStatus:
        return SkillStatus.SUCCESS

    def stop(self) -> None:
        raise OSError("stuck")


def test_an_action_that_cannot_be_ended_properly_has_failed(kb: KnowledgeBase) -> None:
    tree = Sequence("all", [RosaAction("search_pipeline", BadlyStopped())])
    with TreeRunner(tree, kb, on_raise=lambda *_: None) as runner:
        assert runner.tick() is Status.FAILURE
    assert required(kb) == []
    (ended,) = kb.history("required_actions")
    assert ended.result is Result.FAILED
