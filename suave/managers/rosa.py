"""ROSA: the knowledge base decides what is feasible, the adaptation loop configures, the tree chooses the action."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.kb import Event
from rosa_core.mape import AdaptationLoop
from suave.managers.manager import ManagedMission
from suave.monitors import DiagnosticArray
from task_layer.bt import TreeRunner, if_feasible


@cache
def load_suave_model(*, extended: bool) -> KnowledgeModel:
    """The knowledge model of the plain or the extended mission."""
    models = files("suave.models")
    with as_file(models.joinpath("suave.yaml")) as base, as_file(models.joinpath("suave_extended.yaml")) as more:
        return KnowledgeModel.load(base, more) if extended else KnowledgeModel.load(base)


def rosa_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree with the pattern of figure 5 before every action."""
    robot, stopwatch = mission.robot, mission.stopwatch
    kb = KnowledgeBase(load_suave_model(extended=mission.extended), clock=robot.clock, on_subscriber_error=_raise)
    loop = AdaptationLoop(kb, robot)

    def monitor(diagnostics: DiagnosticArray) -> None:
        with stopwatch.running():
            loop.monitor.update(diagnostics)

    def perform(action: str) -> Behaviour:
        return if_feasible(action, mission.skills[action])

    kb.subscribe(mission.on_kb_event)
    robot.on_diagnostics.append(monitor)
    return mission.runner(mission.make_tree(robot, perform), kb)


def _raise(error: BaseException, _subscriber: object, _event: Event) -> None:
    """In an experiment an error must not be passed over."""
    raise error
