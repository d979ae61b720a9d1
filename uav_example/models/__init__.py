"""The knowledge models."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).parent


def model_files(*, spring: bool) -> tuple[Path, ...]:
    """The model's files: as the paper counts it, or with the spring that folds a gripper which has failed."""
    base = _FOLDER / "uav.yaml"
    return (base, _FOLDER / "uav_spring.yaml") if spring else (base,)
