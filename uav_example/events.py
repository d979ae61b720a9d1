"""What happens to the UAV in its world."""

from __future__ import annotations

from enum import Enum


class UavEvent(Enum):
    """Kinds of event; the subject of a sample's is its number."""

    SAMPLE_FOUND = "sample found"
    SAMPLE_ANALYSED = "sample analysed"
    AREA_SEARCHED = "area searched"
    GRIPPER_FAILED = "gripper failed"
    GRIPPER_FOLDED = "gripper folded"
    CHARGED = "charged"
    BATTERY_EMPTY = "battery empty"
    TIME_LIMIT = "time limit"
