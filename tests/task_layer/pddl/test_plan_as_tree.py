"""A plan that was written as a behaviour tree, and is run as one."""

from __future__ import annotations

from pathlib import Path

from py_trees.common import Status

from rosa_core import KnowledgeBase, SimulationClock
from task_layer.bt import Registry, TreeRunner, load_tree
from task_layer.pddl import FeasibilityBridge, GroundTask, Planner
from task_layer.pddl.planning.export import plan_tree
from tests.task_layer.pddl.kit import Scripted, knowledge, set_feasible

ACTIONS = ("search_pipeline", "inspect_pipeline", "recharge")


def written(task: GroundTask, kb: KnowledgeBase, file: Path) -> Path:
    bridge = FeasibilityBridge(kb, task)
    plan = Planner(task).plan(task.initial | bridge.feasible()).plan
    assert plan is not None
    file.write_text(plan_tree(plan, bridge.actions), encoding="utf-8")
    return file


def loaded(file: Path, kb: KnowledgeBase, skills: dict[str, Scripted]) -> TreeRunner:
    leaves = Registry({name: skills[name] for name in ACTIONS}).add("start_robot", skills["start_robot"], request=False)
    return TreeRunner(load_tree(file, leaves), kb)


def test_it_performs_the_steps_and_requests_their_actions(suave_task: GroundTask, tmp_path: Path) -> None:
    kb = knowledge(ACTIONS, SimulationClock())
    skills = {name: Scripted(3) for name in ("start_robot", *ACTIONS)}
    for name in ("search_pipeline", "inspect_pipeline"):
        set_feasible(kb, name, False)
    skills["recharge"].on_success = lambda: [set_feasible(kb, name, True) for name in ACTIONS[:2]]  # type: ignore[assignment,return-value]
    with loaded(written(suave_task, kb, tmp_path / "plan.xml"), kb, skills) as runner:
        assert runner.run(timeout=60.0) == Status.SUCCESS
    assert all(skill.calls == ["start", "success", "stop"] for skill in skills.values())
    ended = [(entry.action, entry.result.value) for entry in kb.history("required_actions")]  # type: ignore[union-attr]
    assert ended == [("recharge", "completed"), ("search_pipeline", "completed"), ("inspect_pipeline", "completed")]


def test_a_step_whose_action_becomes_unfeasible_is_stopped_by_its_guard(suave_task: GroundTask, tmp_path: Path) -> None:
    clock = SimulationClock()
    kb = knowledge(ACTIONS, clock)
    skills = {name: Scripted(30) for name in ("start_robot", *ACTIONS)}
    with loaded(written(suave_task, kb, tmp_path / "plan.xml"), kb, skills) as runner:
        clock.call_at(4.05, lambda: set_feasible(kb, "search_pipeline", False))
        assert runner.run(timeout=60.0) == Status.FAILURE
    assert clock.now() == 4.05
    assert skills["search_pipeline"].calls == ["start", "stop"]
    assert skills["inspect_pipeline"].calls == []
    assert kb.required_actions() == []
