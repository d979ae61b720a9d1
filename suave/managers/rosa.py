"""ROSA: the knowledge base decides what is feasible, the adaptation loop configures, the tree chooses the action."""

from __future__ import annotations

from functools import cache
from importlib.resources import as_file, files

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_simulation.managed_robot import knowledge_base_for
from suave.managers.manager import ManagedMission
from task_layer.bt import TreeRunner


@cache
def load_suave_model(*, extended: bool) -> KnowledgeModel:
    """The knowledge model of the plain or the extended mission."""
    models = files("suave.models")
    with as_file(models.joinpath("suave.yaml")) as base, as_file(models.joinpath("suave_extended.yaml")) as more:
        return KnowledgeModel.load(base, more) if extended else KnowledgeModel.load(base)


def knowledge_base_of(mission: ManagedMission) -> KnowledgeBase:
    """The knowledge base of a mission, which configures the robot."""
    model = load_suave_model(extended=mission.extended)
    return knowledge_base_for(mission.robot, model, stopwatch=mission.stopwatch, on_event=mission.on_kb_event)


def rosa_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree on a knowledge base."""
    return mission.runner(mission.managed_tree(), knowledge_base_of(mission))
