"""Run-time knowledge: facts, statuses that follow from them, events, explanations."""

from rosa_core.kb.configurations import CompleteConfiguration
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
from rosa_core.kb.utility import Limit, Utility

__all__ = [
    "ActionUpdate",
    "CompleteConfiguration",
    "ComponentActivity",
    "ConfigurationSelected",
    "Event",
    "Explanation",
    "KnowledgeBase",
    "Limit",
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
    "Utility",
    "stated_situation",
]
