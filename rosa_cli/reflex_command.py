"""``rosa check --reflexes``: whether a file of reflexes holds together."""

from __future__ import annotations

from pathlib import Path


def check_reflexes(file: Path) -> None:
    """Read the file, and list its reflexes, the one that commands first at the top."""
    from rosa_reflexes import read_reflexes

    config = read_reflexes(file)
    print(f"ok: {len(config.reflexes)} reflexes on {len(config.sensors)} sensors, {len(config.commands)} commands")
    for reflex in sorted(config.reflexes, key=lambda one: -one.priority):
        print(f"  {reflex.name}: {reflex.describe}")
