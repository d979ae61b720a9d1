"""What happens to the Pioneer in its arena."""

from __future__ import annotations

from enum import Enum


class PioneerEvent(Enum):
    """Kinds of event; the subject is what the words are completed with."""

    DEPARTED = "departed"
    PREEMPTED = "preempted"
    HANDED_BACK = "handed back"
    ROUTE = "route"
    SENSOR_FAULT = "sensor fault"
    SENSOR_WORKS = "sensor works"
    SONAR_FAILED = "sonar ring failed"
    COLLISION = "collision"
    WAY_BLOCKED = "way blocked"
    ORIGIN_REACHED = "origin reached"
    TIME_LIMIT = "time limit"
