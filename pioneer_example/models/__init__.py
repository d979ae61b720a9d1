"""The knowledge model."""

from __future__ import annotations

from pathlib import Path

MODELS = (Path(__file__).with_name("pioneer.yaml"),)
"""Its file."""
SONAR_RING, LIDAR, DRIVE = "sonar_ring", "lidar", "drive"
"""Its components."""
