"""The mission: as a behaviour tree that Groot2 opens, and in PDDL."""

from __future__ import annotations

from pathlib import Path

from rosa_simulation.scenario import MissionFiles

_FOLDER = Path(__file__).parent
MISSION = MissionFiles(_FOLDER / "pioneer.xml", _FOLDER / "pioneer_domain.pddl", _FOLDER / "pioneer_problem.pddl")
"""Go to the origin; when something stands in the way, take a detour."""
