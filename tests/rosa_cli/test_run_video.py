"""``rosa run --video``: a mission is filmed, or it is said before it begins why it cannot be."""

from __future__ import annotations

import ctypes
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from rosa_core import InputError
from rosa_simulation.scenario import RunRequest, SilentObserver
from rosa_simulation.video import Captioner, check_video, write_video
from suave.film import Captions
from suave.scenario import SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa


def can_render() -> bool:
    for library in ("libEGL.so.1", "libOSMesa.so.8", "libOSMesa.so.6"):
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        return True
    return False


renders = pytest.mark.skipif(not can_render(), reason="neither EGL nor OSMesa is installed")


@renders
def test_a_mission_is_filmed_a_frame_a_second(tmp_path: Path) -> None:
    file = tmp_path / "mission.webp"
    process = rosa("run", "suave", "--time-limit", "20", "--video", file)
    assert process.returncode == 0, process.stderr
    assert f"video in {file}" in process.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["mission.webp"]
    with Image.open(file) as video:
        assert video.n_frames == 21
        assert video.size == (640, 480)
        frames = []
        for number in (0, 20):
            video.seek(number)
            frames.append(np.asarray(video.convert("RGB"), dtype=float))
    middle = slice(100, 400)
    assert frames[0][middle].std() > 5  # something is to be seen
    assert np.abs(frames[0][middle] - frames[1][middle]).mean() > 1  # and it moves


@renders
@pytest.mark.slow
def test_an_mp4_is_one(tmp_path: Path) -> None:
    file = tmp_path / "mission.mp4"
    assert rosa("run", "suave-extended", "-q", "--time-limit", "5", "--manager", "bt", "--video", file).returncode == 0
    assert file.read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("mission.avi", "name it something.mp4 or .webp"),
        ("mission", "name it something.mp4 or .webp"),
        ("nowhere/mission.mp4", "name a file in a directory that is there"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_the_mission(tmp_path: Path, name: str, words: str) -> None:
    said = refused(rosa("run", "suave", "--video", tmp_path / name, "--out", tmp_path / "record"))
    assert words in said
    assert "GUIDED" not in said
    assert not (tmp_path / "record").exists()


def test_an_opengl_library_that_cannot_be_used_is_an_error_with_a_mend(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    said = refused(rosa("run", "suave", "--video", tmp_path / "mission.mp4"))
    assert "nothing can be rendered with disable" in said
    assert "set MUJOCO_GL to egl or osmesa" in said
    assert "GUIDED" not in said


def test_without_the_extra_it_is_said_how_to_install_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "imageio_ffmpeg" else object())
    with pytest.raises(InputError, match=r"videos need imageio_ffmpeg \(install the extra: pip install .*\[video\]"):
        check_video(tmp_path / "mission.mp4")


def test_a_video_that_breaks_off_leaves_nothing_behind(tmp_path: Path) -> None:
    def frames():  # type: ignore[no-untyped-def]
        yield np.zeros((32, 32, 3), np.uint8)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_video(tmp_path / "mission.mp4", frames(), fps=15)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("size", [(30, 32), (32, 40)])
def test_frames_that_codecs_do_not_take_are_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="divisible by 16"):
        write_video(tmp_path / "mission.mp4", [np.zeros((*size, 3), np.uint8)], fps=15)
    with pytest.raises(ValueError, match="at least one frame"):
        write_video(tmp_path / "mission.mp4", [], fps=15)


def test_captions_darken_and_write_over_the_frame_and_wrap_long_lines() -> None:
    frame = np.full((320, 320, 3), 255, np.uint8)
    caption = Captioner(320)
    shown = caption(frame, ["short"], ["word " * 30])
    assert shown.shape == frame.shape
    rows = shown.min(axis=(1, 2))
    assert rows[5] < 255
    assert rows[100] == 255
    assert rows[-1] < 255
    assert (caption(frame, [], ["word"])[-60:] == 255).all(axis=(1, 2)).sum() > 10  # one line needs less room
    assert (frame == 255).all()


def test_the_captions_say_how_things_stand_and_what_has_just_happened() -> None:
    record = SUAVE_EXTENDED.run(RunRequest(time_limit=160.0), SilentObserver())
    captions = Captions(record)
    shown = {}
    for row in record.trajectory:
        pose = dict(zip(record.trajectory_columns, row, strict=True))
        shown[round(pose["time_s"])] = captions.at(pose)
    top, bottom = shown[37]
    assert (
        top[0] == "suave-extended · manager rosa · seed 0 · 37 s · visibility 1.3 m · battery 0.81 · failed: thruster 1"
    )
    assert "search_pipeline solved" in top[1]
    assert top[2] == "active: f_generate_search_path_node, f_maintain_motion_node"
    assert any(line.startswith("35.0 s  thruster 1 failed") for line in bottom)
    top, bottom = shown[55]
    assert "failed" not in top[0]
    assert "f_maintain_motion_node" not in top[2]
    assert [line[:6] for line in bottom] == ["45.0 s"]
    top, _ = shown[152]
    assert "recharge solved" in top[1]
    assert "search_pipeline unfeasible" in top[1]
