"""The knowledge models."""

from __future__ import annotations

from pathlib import Path

_FOLDER = Path(__file__).parent


def model_files(*, extended: bool) -> tuple[Path, ...]:
    """The files of the plain or the extended mission's knowledge model."""
    plain = _FOLDER / "suave.yaml"
    return (plain, _FOLDER / "suave_extended.yaml") if extended else (plain,)
