"""The mission: as a behaviour tree that Groot2 opens, and in PDDL."""

from __future__ import annotations

from pathlib import Path

TREE_FILE = Path(__file__).parent / "uav.xml"
"""What is done next, as a behaviour tree."""
