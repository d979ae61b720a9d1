"""SUAVE's functions as system modes, and what decides about them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rosa_simulation.system_modes import FunctionDesign, ModeControl, Situation
from suave.mission_config import MissionConfig

_FOLDER = Path(__file__).parent
_THRUSTERS = frozenset(f"c_thruster_{number}" for number in range(1, 7))
DESIGNS = (
    FunctionDesign("f_generate_search_path", "fd_spiral_high", 3.0, {"water_visibility": 3.25}),
    FunctionDesign("f_generate_search_path", "fd_spiral_medium", 2.0, {"water_visibility": 2.25}),
    FunctionDesign("f_generate_search_path", "fd_spiral_low", 1.0, {"water_visibility": 1.25}),
    FunctionDesign("f_maintain_motion", "fd_all_thrusters", 2.0, components=_THRUSTERS),
    FunctionDesign("f_maintain_motion", "fd_recover_thrusters", 1.0),
    FunctionDesign("f_follow_pipeline", "fd_follow_pipeline", 1.0),
)
"""The function designs that metacontrol chooses from."""


def mode_control(config: MissionConfig, *, extended: bool) -> ModeControl:
    """The system modes of the plain or the extended mission, and its managing tree (37 or 50 nodes).

    Args:
        config: for the period of adaptation.
        extended: the mission with a battery, whose tree has 50 nodes.
    """
    name = "suave_extended" if extended else "suave"
    return ModeControl(
        modes_file=_FOLDER / f"{name}_modes.yaml",
        unused_mode="fd_unground",
        tree_file=_FOLDER / f"{name}_bt.xml",
        conditions=_conditions,
        functions={
            "search_pipeline": ("f_maintain_motion", "f_generate_search_path"),
            "inspect_pipeline": ("f_maintain_motion", "f_follow_pipeline"),
        },
        designs=DESIGNS,
        # Thrusters are left to themselves.
        varied={"search_pipeline": "f_generate_search_path", "inspect_pipeline": "f_follow_pipeline"},
        adaptation_period=config.adaptation_period,
    )


def _conditions(situation: Situation) -> Mapping[str, Callable[..., Any]]:
    """What the managing trees ask, by the names that the exemplar has for it; parameters are ports."""

    def water_visibility(threshold: float) -> bool:
        return situation.reaches("water_visibility", threshold)

    def battery_level(threshold: float) -> bool:
        return situation.reaches("battery_level", threshold)

    return {
        "water_visibility": water_visibility,
        "battery_level": battery_level,
        "thrusters_ok": lambda: not situation.failed,
    }
