"""The reflexes of the Pioneer: those of the file, and those whose command is a function of what the sensors say."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from rosa_reflexes import Command, GateConfig, Readings, Reflex, read_reflexes

_FILE = Path(__file__).with_name("reflexes.yaml")
_TURN = 0.2
"""Speed of the wheels while the robot turns on the spot, m/s."""
_PASS, _PASS_TURN, _PASS_GAIN = 0.25, 0.18, 1.0
"""Passing something: speed, m/s; by how much the wheels differ from it at most, m/s; and for each metre too far."""
_FREE = 0.6
"""How far it must be free ahead, m, before the goal is made for again."""


def turn_away(readings: Readings) -> Command:
    """Turn on the spot to the freer side, and then on in that direction."""
    turning = readings["own.turn"]
    left = turning > 0.0 if turning else readings["range.left"] >= readings["range.right"]
    return {"left": -_TURN, "right": _TURN} if left else {"left": _TURN, "right": -_TURN}


def _pass(side: str, sign: float) -> Reflex:
    """Drive on along something that stands between the robot and its goal, until the goal is ahead.

    Args:
        side: on which it stands.
        sign: 1 for the left, on which angles are positive.
    """
    near = f"range.{side}"

    def trigger(readings: Readings) -> bool:
        return readings[near] < readings["pass_distance"] and 0.4 < sign * readings["goal.bearing"] < 2.6

    def follow(readings: Readings) -> Command:
        turn = _PASS_GAIN * (readings[near] - readings["pass_distance"] + 0.1)
        turn = sign * min(max(turn, -_PASS_TURN), _PASS_TURN)
        return {"left": _PASS - turn, "right": _PASS + turn}

    def release(readings: Readings) -> bool:
        angle = sign * readings["goal.bearing"]
        is_ahead = angle < 0.15 and (readings["range.front"] > _FREE or angle < -0.5)
        return is_ahead or angle > 2.8 or readings[near] > readings["pass_distance"] + 0.5

    return Reflex(
        f"pass on the {side}",
        (near, "range.front", "goal.bearing", "pass_distance"),
        trigger,
        follow,
        release,
        priority=5.0,
        describe=f"{near} < pass_distance, and the goal is on that side",
    )


KEEP_CLEAR = Reflex(
    "keep clear",
    ("range.front", "stop_distance"),
    lambda readings: readings["range.front"] < readings["stop_distance"],
    turn_away,
    lambda readings: readings["range.front"] > readings["stop_distance"] + 0.15,
    release_after=0.05,
    priority=10.0,
    describe="range.front < stop_distance",
)
_IN_PYTHON = (KEEP_CLEAR, _pass("left", 1.0), _pass("right", -1.0))


@lru_cache(maxsize=1)
def pioneer_reflexes() -> GateConfig:
    """All of them."""
    config = read_reflexes(_FILE)
    return replace(config, reflexes=(*config.reflexes, *_IN_PYTHON))
