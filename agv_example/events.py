"""What happens to the AGV on its map."""

from __future__ import annotations

from enum import Enum


class AgvEvent(Enum):
    """Kinds of event; the subject is the component, corridor, place or goal."""

    DEPARTED = "departed"
    COMPONENT_FAILED = "component failed"
    COMPONENT_RECOVERED = "component recovered"
    CORRIDOR_CLOSED = "corridor closed"
    CORRIDOR_OPENED = "corridor opened"
    LIGHT_CHANGED = "light changed"
    DRIVING = "driving"
    ARRIVED = "arrived"
    COLLISION = "collision"
    STRANDED = "stranded"
    BATTERY_EMPTY = "battery empty"
    GOAL_REACHED = "goal reached"
    TIME_LIMIT = "time limit"
