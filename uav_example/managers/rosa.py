"""ROSA: the knowledge base says what is feasible, the adaptation loop configures, the task layer chooses the action."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.kb import Event
from rosa_core.mape import AdaptationLoop
from rosa_core.mape.diagnostics import DiagnosticArray
from task_layer.bt import TreeRunner
from uav_example.managers.manager import ManagedMission
from uav_example.missions.tree import conditions, mission_tree


@cache
def load_uav_model(*, spring: bool) -> KnowledgeModel:
    """The knowledge model as the paper counts it, or with the spring that folds a gripper which has failed."""
    models = files("uav_example.models")
    with as_file(models.joinpath("uav.yaml")) as base, as_file(models.joinpath("uav_spring.yaml")) as more:
        return KnowledgeModel.load(base, more) if spring else KnowledgeModel.load(base)


def knowledge_base_of(mission: ManagedMission) -> KnowledgeBase:
    """A knowledge base that hears the robot's diagnostics and, with the adaptation loop, configures it."""
    robot, recorder = mission.robot, mission.recorder
    model = load_uav_model(spring=robot.world.parameters.spring)
    kb = KnowledgeBase(model, clock=robot.clock, on_subscriber_error=_raise)
    loop = AdaptationLoop(kb, robot)

    def monitor(diagnostics: DiagnosticArray) -> None:
        with recorder.stopwatch.running():
            loop.monitor.update(diagnostics)

    kb.subscribe(recorder.narrator.on_kb_event)
    robot.on_diagnostics.append(monitor)
    return kb


def rosa_tree(mission: ManagedMission) -> TreeRunner:
    """The mission's tree on a knowledge base."""
    kb = knowledge_base_of(mission)
    registry = conditions(mission.robot)
    for action, skill in mission.skills.items():
        registry.add(action, skill)
    return mission.runner(mission_tree(registry), kb)


def _raise(error: BaseException, _subscriber: object, _event: Event) -> None:
    """In an experiment an error must not be passed over."""
    raise error
