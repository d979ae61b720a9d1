"""The mission: as a behaviour tree that Groot2 opens, and in PDDL, whose problem is made from the map."""

from __future__ import annotations

from pathlib import Path

from rosa_simulation.scenario import MissionFiles

_FOLDER = Path(__file__).parent
MISSION = MissionFiles(_FOLDER / "agv.xml", _FOLDER / "agv_domain.pddl")
"""Where to go next."""
