"""The knowledge models."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

_FOLDER = Path(__file__).parent


def model_files(more: Iterable[Path] = ()) -> tuple[Path, ...]:
    """The counted model of the paper, what missions need besides, and what one mission adds."""
    return (_FOLDER / "agv.yaml", _FOLDER / "agv_move.yaml", _FOLDER / "agv_mission.yaml", *more)
