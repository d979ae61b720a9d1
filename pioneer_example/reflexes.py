"""The reflexes of the Pioneer: those of the file, and one whose command is a function of what the sensors say."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from rosa_reflexes import Command, GateConfig, Readings, Reflex, read_reflexes

_FILE = Path(__file__).with_name("reflexes.yaml")
_TURN = 0.2
"""Speed of the wheels while the robot turns on the spot, m/s."""


def turn_away(readings: Readings) -> Command:
    """Turn on the spot: on in the direction in which it turns already, otherwise to the freer side."""
    rate = readings["yaw.rate"]
    left = rate > 0.0 if abs(rate) > 0.3 else readings["range.left"] >= readings["range.right"]
    return {"left": -_TURN, "right": _TURN} if left else {"left": _TURN, "right": -_TURN}


KEEP_CLEAR = Reflex(
    "keep clear",
    ("range.front", "stop_distance"),
    lambda readings: readings["range.front"] < readings["stop_distance"],
    turn_away,
    lambda readings: readings["range.front"] > readings["stop_distance"] + 0.25,
    release_after=0.1,
    priority=10.0,
    describe="range.front < stop_distance",
)


@lru_cache(maxsize=1)
def pioneer_reflexes() -> GateConfig:
    """All of them."""
    config = read_reflexes(_FILE)
    return replace(config, reflexes=(*config.reflexes, KEEP_CLEAR))
