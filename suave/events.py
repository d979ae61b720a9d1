"""What happens to the AUV in its world."""

from __future__ import annotations

from enum import Enum


class SuaveEvent(Enum):
    """Kinds of event; the subject of a thruster's is its number."""

    GUIDED = "guided"
    THRUSTER_FAILED = "thruster failed"
    THRUSTER_RECOVERED = "thruster recovered"
    PIPELINE_FOUND = "pipeline found"
    PIPELINE_INSPECTED = "pipeline inspected"
    RECHARGED = "recharged"
    BATTERY_EMPTY = "battery empty"
    TIME_LIMIT = "time limit"
