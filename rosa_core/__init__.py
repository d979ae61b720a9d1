"""ROSA: a knowledge base for robots that adapt their task and their architecture together."""

from rosa_core.clock import Clock, SimulationClock, WallClock
from rosa_core.errors import (
    InputError,
    InvalidValueError,
    KnowledgeBaseError,
    KnowledgeModelError,
    QueryError,
    RequestRefusedError,
    RosaError,
    UnknownElementError,
)
from rosa_core.kb import KnowledgeBase, ReconfigurationPlan, Result, Situation, Status
from rosa_core.model import ElementKind, KnowledgeModel

__all__ = [
    "Clock",
    "ElementKind",
    "InputError",
    "InvalidValueError",
    "KnowledgeBase",
    "KnowledgeBaseError",
    "KnowledgeModel",
    "KnowledgeModelError",
    "QueryError",
    "ReconfigurationPlan",
    "RequestRefusedError",
    "Result",
    "RosaError",
    "SimulationClock",
    "Situation",
    "Status",
    "UnknownElementError",
    "WallClock",
]
