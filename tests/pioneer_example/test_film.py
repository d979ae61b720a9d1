"""The film of a run."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rosa_cli.cli import rosa
from tests.rosa_cli.test_run_video import renders


@renders
@pytest.mark.slow
def test_a_run_is_filmed_a_frame_for_each_sample(tmp_path: Path) -> None:
    import imageio_ffmpeg

    process = rosa("run", "pioneer", "--time-limit", "3", "--video", tmp_path / "film.mp4", "-q")
    assert process.returncode == 0, process.stderr
    frames, _ = imageio_ffmpeg.count_frames_and_secs(str(tmp_path / "film.mp4"))
    assert frames == 16
