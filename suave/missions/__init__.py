"""The missions: as behaviour trees that Groot2 opens (14 and 22 nodes), and in PDDL."""

from __future__ import annotations

from pathlib import Path


def tree_file(*, extended: bool) -> Path:
    """The tree of the plain or the extended mission (ROSA paper, figure 7)."""
    return Path(__file__).parent / ("suave_extended.xml" if extended else "suave.xml")
