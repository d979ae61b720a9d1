"""Run-time knowledge: facts, statuses that follow from them, events, explanations."""

from rosa_core.kb.events import (
    ActionUpdate,
    ComponentActivity,
    ConfigurationSelected,
    Event,
    Measurement,
    MonitoringData,
    ReconfigurationPlan,
    ReconfigurationPlanCreated,
    ReconfigurationPlanEnded,
    RequiredAction,
    StatusChange,
    StatusesChanged,
)
from rosa_core.kb.explanation import Explanation
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.kb.situation import Situation, stated_situation
from rosa_core.kb.status import Result, Status

__all__ = [
    "ActionUpdate",
    "ComponentActivity",
    "ConfigurationSelected",
    "Event",
    "Explanation",
    "KnowledgeBase",
    "Measurement",
    "MonitoringData",
    "ReconfigurationPlan",
    "ReconfigurationPlanCreated",
    "ReconfigurationPlanEnded",
    "RequiredAction",
    "Result",
    "Situation",
    "Status",
    "StatusChange",
    "StatusesChanged",
    "stated_situation",
]
