"""Videos of runs: frames with captions into an mp4 or webp file. Needs the extra ``video``."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import sys
import tempfile
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.paths import is_directory

Frame = NDArray[np.uint8]
"""An image: height x width x (red, green, blue), 0 to 255."""

_BLOCK = 16
"""Codecs want widths and heights that are multiples of this, pixels."""
_PACKAGES = ("imageio_ffmpeg", "PIL")
_ENCODERS: dict[str, dict[str, Any]] = {
    ".mp4": {"output_params": ["-f", "mp4"]},
    ".webp": {
        "codec": "libwebp_anim",
        "quality": None,
        "output_params": ["-f", "webp", "-loop", "0", "-quality", "75"],
    },
}
_BACKENDS = (("egl", ("libEGL.so.1",)), ("osmesa", ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")))
_FONT_SIZE = 15
_MARGIN = 8


def check_video(path: Path) -> None:
    """Make sure, before anything is run, that a video can be written there.

    Raises:
        InputError: if the file's name does not say a known format, its directory cannot be written, or the extra
            ``video`` is not installed.
    """
    where = Location(str(path))
    if path.suffix.lower() not in _ENCODERS:
        raise InputError(Problem("not a video format that can be written", where, "name it something.mp4 or .webp"))
    if is_directory(path) or not os.access(path.parent, os.W_OK):
        raise InputError(Problem("cannot write it", where, "name a file in a directory that is there"))
    missing = [package for package in _PACKAGES if importlib.util.find_spec(package) is None]
    if missing:
        hint = "install the extra: pip install 'rosa-coadaptation[video]'"
        raise InputError(Problem(f"videos need {' and '.join(missing)}", where, hint))


def choose_renderer() -> None:
    """On Linux, set ``MUJOCO_GL`` to the first of EGL and OSMesa that is installed, unless it is set already.

    Call this before MuJoCo is imported.

    Raises:
        InputError: if neither is.
    """
    if sys.platform != "linux" or os.environ.get("MUJOCO_GL"):
        return
    backend = next((name for name, libraries in _BACKENDS if any(map(_is_installed, libraries))), None)
    if backend is None:
        hint = "install one of them, on Debian: apt-get install libegl1 libegl-mesa0, or libosmesa6"
        raise InputError(Problem("rendering without a screen needs the library EGL or OSMesa", hint=hint))
    os.environ["MUJOCO_GL"] = backend


def _is_installed(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def write_video(path: Path, frames: Iterable[Frame], fps: int) -> None:
    """Encode frames, all of the size of the first; the file appears once it is complete.

    Args:
        path: a file that :func:`check_video` has passed.
        frames: at least one; width and height must be divisible by 16.
        fps: frames shown in a second.

    Raises:
        ValueError: if there are no frames, or their size is not divisible by 16.
        InputError: if the file cannot be written.
    """
    frames = iter(frames)
    try:
        first = next(frames)
    except StopIteration:
        raise ValueError("a video needs at least one frame") from None
    height, width = first.shape[:2]
    if height % _BLOCK or width % _BLOCK:
        raise ValueError(f"width and height of a frame must be divisible by {_BLOCK}, not {width} x {height}")
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".video-") as directory:
            unfinished = Path(directory) / f"video{path.suffix.lower()}"
            _encode(unfinished, first, frames, fps)
            unfinished.replace(path)
    except OSError as error:
        reason = error.strerror or str(error).partition("\n")[0]
        raise InputError(Problem(f"cannot write it: {reason}", Location(str(path)))) from None


def _encode(path: Path, first: Frame, others: Iterable[Frame], fps: int) -> None:
    import imageio_ffmpeg

    height, width = first.shape[:2]
    settings = _ENCODERS[path.suffix]
    writer = imageio_ffmpeg.write_frames(path, (width, height), fps=fps, ffmpeg_log_level="error", **settings)
    try:
        writer.send(None)
        writer.send(np.ascontiguousarray(first))
        for frame in others:
            writer.send(np.ascontiguousarray(frame))
    finally:
        writer.close()


class Captioner:
    """Writes lines of text over frames, on a dark ground on which they can be read.

    Args:
        width: of the frames, pixels; longer lines are wrapped.
    """

    def __init__(self, width: int) -> None:
        from PIL import ImageFont

        self._width = width
        self._font = ImageFont.load_default(_FONT_SIZE)
        self._wrapped = lru_cache(maxsize=100)(self._wrap)

    def __call__(self, frame: Frame, top: Sequence[str], bottom: Sequence[str]) -> Frame:
        """The frame with some lines at its top and some at its bottom."""
        from PIL import Image, ImageDraw

        image = Image.fromarray(frame)
        draw = ImageDraw.Draw(image, "RGBA")
        for lines, at_top in ((top, True), (bottom, False)):
            text = "\n".join(part for line in lines for part in self._wrapped(line))
            if text:
                _, _, _, height = draw.multiline_textbbox((0, 0), text, font=self._font)
                y = 0 if at_top else frame.shape[0] - int(height) - 2 * _MARGIN
                draw.rectangle((0, y, self._width, y + height + 2 * _MARGIN), fill=(0, 0, 0, 140))
                draw.multiline_text((_MARGIN, y + _MARGIN), text, font=self._font, fill=(255, 255, 255, 255))
        return np.asarray(image)

    def _wrap(self, line: str) -> list[str]:
        lines, room = [""], self._width - 2 * _MARGIN
        for word in line.split():
            longer = f"{lines[-1]} {word}".lstrip()
            if lines[-1] and self._font.getlength(longer) > room:
                lines.append(f"  {word}")
            else:
                lines[-1] = longer
        return lines
