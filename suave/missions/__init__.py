"""The missions: as behaviour trees that Groot2 opens (14 and 22 nodes), and in PDDL."""

from __future__ import annotations

from pathlib import Path

from rosa_simulation.scenario import MissionFiles

_FOLDER = Path(__file__).parent
PLAIN_MISSION = MissionFiles(_FOLDER / "suave.xml", _FOLDER / "suave_domain.pddl", _FOLDER / "suave_problem.pddl")
EXTENDED_MISSION = MissionFiles(
    _FOLDER / "suave_extended.xml", _FOLDER / "suave_domain.pddl", _FOLDER / "suave_extended_problem.pddl"
)
"""The plain and the extended mission; the trees are those of the ROSA paper's figure 7."""
