"""The mission: as a behaviour tree that Groot2 opens, and in PDDL."""

from __future__ import annotations

from pathlib import Path

from rosa_simulation.scenario import MissionFiles

_FOLDER = Path(__file__).parent
MISSION = MissionFiles(_FOLDER / "uav.xml", _FOLDER / "uav_domain.pddl", _FOLDER / "uav_problem.pddl")
"""What is done next."""
