"""Run-time knowledge: facts, statuses that follow from them, events, explanations."""

from rosa_core.choice import CompleteConfiguration
from rosa_core.inference.explanation import Explanation
from rosa_core.journal.options import JournalOptions, Retention
from rosa_core.kb.dispatcher import Dispatcher, EventsDroppedError, SynchronousDispatcher, ThreadedDispatcher
from rosa_core.kb.events import (
    ActionUpdate,
    ComponentActivity,
    ConfigurationSelected,
    Event,
    KnowledgeChanged,
    MonitoringData,
    ReconfigurationPlanCreated,
    ReconfigurationPlanEnded,
    StatusesChanged,
)
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.kb.situation import Situation, stated_situation
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction, StatusChange
from rosa_core.model.status import Result, Status
from rosa_core.model.utility import Limit, Utility

__all__ = [
    "ActionUpdate",
    "CompleteConfiguration",
    "ComponentActivity",
    "ConfigurationSelected",
    "Dispatcher",
    "Event",
    "EventsDroppedError",
    "Explanation",
    "JournalOptions",
    "KnowledgeBase",
    "KnowledgeChanged",
    "Limit",
    "Measurement",
    "MonitoringData",
    "ReconfigurationPlan",
    "ReconfigurationPlanCreated",
    "ReconfigurationPlanEnded",
    "RequiredAction",
    "Result",
    "Retention",
    "Situation",
    "Status",
    "StatusChange",
    "StatusesChanged",
    "SynchronousDispatcher",
    "ThreadedDispatcher",
    "Utility",
    "stated_situation",
]
