"""ROSA: the knowledge base says what is feasible, the adaptation loop configures, the task layer chooses the action."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_simulation.managed_robot import knowledge_base_for
from task_layer.bt import TreeRunner, load_tree
from uav_example.managers.manager import ManagedMission
from uav_example.missions.leaves import conditions


@cache
def load_uav_model(*, spring: bool) -> KnowledgeModel:
    """The knowledge model as the paper counts it, or with the spring that folds a gripper which has failed."""
    models = files("uav_example.models")
    with as_file(models.joinpath("uav.yaml")) as base, as_file(models.joinpath("uav_spring.yaml")) as more:
        return KnowledgeModel.load(base, more) if spring else KnowledgeModel.load(base)


def knowledge_base_of(mission: ManagedMission) -> KnowledgeBase:
    """The knowledge base of a mission, which configures the robot."""
    recorder = mission.recorder
    model = load_uav_model(spring=mission.robot.world.parameters.spring)
    on_event = recorder.narrator.on_kb_event
    return knowledge_base_for(mission.robot, model, stopwatch=recorder.stopwatch, on_event=on_event)


def rosa_tree(mission: ManagedMission) -> TreeRunner:
    """The mission's tree on a knowledge base."""
    kb = knowledge_base_of(mission)
    registry = conditions(mission.robot)
    for action, skill in mission.skills.items():
        registry.add(action, skill)
    return mission.runner(load_tree(mission.tree_file, registry), kb)
