"""The blocks of the RoCS paper, for those who structure a robot that way, and what runs programs made of them."""

from rosa_reflexes.rocs.actions import Action, ActionStatus, Activity, MacroAction, decomposition
from rosa_reflexes.rocs.blocks import Analyze, Execute, Monitor, Plan, TopologyError
from rosa_reflexes.rocs.event_runner import EventRunner
from rosa_reflexes.rocs.joining import ActionStatuses, GateActuator, KnowledgeBaseAnalyze, MissionPlan
from rosa_reflexes.rocs.knowledge import Fact, Knowledge, ReactiveModel, RobotModel, StrategyModel, WorldModel
from rosa_reflexes.rocs.pipeline import Pipeline, Queued
from rosa_reflexes.rocs.published_loop import PublishedLoop, PublishedPipeline
from rosa_reflexes.rocs.robot import Robot, build_robot
from rosa_reflexes.rocs.thread_runner import ThreadRunner
from rosa_reflexes.rocs.touchpoints import Actuator, Sensor

__all__ = [
    "Action",
    "ActionStatus",
    "ActionStatuses",
    "Activity",
    "Actuator",
    "Analyze",
    "EventRunner",
    "Execute",
    "Fact",
    "GateActuator",
    "Knowledge",
    "KnowledgeBaseAnalyze",
    "MacroAction",
    "MissionPlan",
    "Monitor",
    "Pipeline",
    "Plan",
    "PublishedLoop",
    "PublishedPipeline",
    "Queued",
    "ReactiveModel",
    "Robot",
    "RobotModel",
    "Sensor",
    "StrategyModel",
    "ThreadRunner",
    "TopologyError",
    "WorldModel",
    "build_robot",
    "decomposition",
]
