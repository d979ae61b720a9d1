"""ROSA: a knowledge base for robots that adapt their task and their architecture together."""

from rosa_core.clock import Clock, SimulationClock, WallClock
from rosa_core.errors import (
    InputError,
    InvalidValueError,
    JournalError,
    KnowledgeBaseClosedError,
    KnowledgeBaseError,
    KnowledgeChangeRefusedError,
    KnowledgeModelError,
    QueryError,
    RequestRefusedError,
    RosaError,
    UnknownElementError,
)
from rosa_core.kb import JournalOptions, KnowledgeBase, ReconfigurationPlan, Result, Retention, Situation, Status
from rosa_core.model import ElementKind, KnowledgeModel

__all__ = [
    "Clock",
    "ElementKind",
    "InputError",
    "InvalidValueError",
    "JournalError",
    "JournalOptions",
    "KnowledgeBase",
    "KnowledgeBaseClosedError",
    "KnowledgeBaseError",
    "KnowledgeChangeRefusedError",
    "KnowledgeModel",
    "KnowledgeModelError",
    "QueryError",
    "ReconfigurationPlan",
    "RequestRefusedError",
    "Result",
    "Retention",
    "RosaError",
    "SimulationClock",
    "Situation",
    "Status",
    "UnknownElementError",
    "WallClock",
]
