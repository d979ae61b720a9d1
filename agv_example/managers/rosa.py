"""ROSA: the knowledge base says what is feasible, path and configuration are planned together, the loop configures."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from agv_example.drive_configurations import ACTION
from agv_example.managers.manager import ManagedMission
from agv_example.missions.trees import delivery
from agv_example.monitors import DiagnosticArray
from agv_example.navigator import Navigate, Navigator
from rosa_core import KnowledgeBase
from rosa_core.kb import Event
from rosa_core.mape import AdaptationLoop
from task_layer.bt import Condition, IsActionFeasible, ReactiveSequence, RosaAction, TreeRunner


def rosa_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree with the pattern of figure 5 of the paper before every drive, and a way there."""
    robot, stopwatch = mission.robot, mission.stopwatch
    kb = KnowledgeBase(mission.model, clock=robot.clock, on_subscriber_error=_raise)
    loop = AdaptationLoop(kb, robot)
    navigator = Navigator(kb, robot, mission.config.objective, mission.on_route)

    def wake() -> None:
        runner.wake()

    def monitor(diagnostics: DiagnosticArray) -> None:
        with stopwatch.running():
            loop.monitor.update(diagnostics)

    def perform(goal: str) -> Behaviour:
        skill = Navigate(navigator, kb, robot, goal, wake)
        guards = [
            IsActionFeasible(ACTION),
            Condition(f"is there a way to {goal}", lambda: navigator.has_way(goal)),
        ]
        return ReactiveSequence(f"{goal} if feasible", [*guards, RosaAction(ACTION, skill, name=f"navigate to {goal}")])

    kb.subscribe(mission.on_kb_event)
    robot.on_diagnostics.append(monitor)
    runner = mission.runner(delivery(mission.config.goals, perform), kb)
    return runner


def _raise(error: BaseException, _subscriber: object, _event: Event) -> None:
    """In an experiment an error must not be passed over."""
    raise error
