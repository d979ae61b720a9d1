"""Films a mission: its recorded trajectory is replayed in MuJoCo and rendered, without a screen."""

from __future__ import annotations

import math
import os
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import closing
from importlib.resources import files
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.run_record import MissionEvent, RunRecord
from rosa_simulation.video import Captioner, Frame, check_video, choose_renderer, write_video

WIDTH, HEIGHT = 640, 480
FRAMES_PER_SECOND = 15
_MOST_FRAMES = 3000
_SHOWN_FOR = 15.0
"""Seconds of mission time for which an event stays on the screen."""
_EVENTS_SHOWN = 3
_DISTANCE, _ELEVATION, _AZIMUTH = 11.0, -38.0, 115.0
_TRAIL_WIDTH, _TRAIL_COLOUR = 0.05, (0.3, 0.8, 1.0, 0.8)


def prepare_film(path: Path) -> Callable[[RunRecord], None]:
    """Make sure, before the mission, that it can be filmed; call this before MuJoCo is imported.

    On Linux, ``MUJOCO_GL`` is set to the first of EGL and OSMesa that is installed, unless it is set already.

    Args:
        path: where the video is to be written.

    Returns:
        what films a run.

    Raises:
        InputError: if the video cannot be written, or nothing can be rendered.
    """
    check_video(path)
    choose_renderer()
    with closing(_Replay()):
        pass
    return lambda record: film(record, path)


def film(record: RunRecord, path: Path) -> None:
    """Write a video of a run: a frame for each row of its trajectory, with what is going on as captions.

    Args:
        record: with its trajectory; the world is made again from its inputs.
        path: of the video; its ending says the format.

    Raises:
        InputError: if the file cannot be written or nothing can be rendered.
    """
    with closing(_Replay()) as replay:
        write_video(path, _frames(record, replay), FRAMES_PER_SECOND)


def _frames(record: RunRecord, replay: _Replay) -> Iterator[Frame]:
    caption, captions = Captioner(WIDTH), Captions(record)
    stride = math.ceil(len(record.trajectory) / _MOST_FRAMES)
    for row in record.trajectory[::stride]:
        pose = dict(zip(record.trajectory_columns, row, strict=True))
        top, bottom = captions.at(pose)
        yield caption(replay.render(pose), top, bottom)


class Captions:
    """The captions of each frame of a run, in order of time."""

    def __init__(self, record: RunRecord) -> None:
        self._title = f"{record.scenario} · manager {record.manager} · seed {record.seed}"
        self._to_come = deque(record.events)
        self._shown: deque[MissionEvent] = deque(maxlen=_EVENTS_SHOWN)
        self._actions: dict[str, str] = {}
        self._active: set[str] = set()
        self._failed: set[str] = set()

    def at(self, pose: dict[str, float]) -> tuple[list[str], list[str]]:
        """The lines above and below: how things stand, and the latest events."""
        now = pose["time_s"]
        while self._to_come and self._to_come[0].time_s <= now:
            event = self._to_come.popleft()
            self._shown.append(event)
            for fact in event.facts:
                self._take(fact)
        figures = f"{now:.0f} s · visibility {pose['visibility_m']:.1f} m · battery {pose['battery_level']:.2f}"
        if self._failed:
            figures += f" · failed: thruster {', '.join(sorted(self._failed))}"
        actions = " · ".join(f"{name} {status}" for name, status in self._actions.items())
        active = f"active: {', '.join(sorted(self._active)) or 'no node'}"
        events = [f"{event.time_s:.1f} s  {event.text}" for event in self._shown if now - event.time_s <= _SHOWN_FOR]
        return [f"{self._title} · {figures}", *([actions] if actions else []), active], events

    def _take(self, fact: Any) -> None:
        what, subject = fact["fact"], fact.get("subject", "")
        if what == "statuses":
            self._actions |= {name: new for kind, name, _, new in fact["changes"] if kind == "action"}
        elif what == "activated":
            self._active.add(subject)
        elif what == "deactivated":
            self._active.discard(subject)
        elif what == "thruster failed":
            self._failed.add(subject)
        elif what == "thruster recovered":
            self._failed.discard(subject)


class _Replay:
    """Renders the vehicle where it was, from behind and above, with the way it has come; must be closed."""

    def __init__(self) -> None:
        import mujoco

        self._mujoco = mujoco
        spec = mujoco.MjSpec.from_string(files("suave.world").joinpath("auv.xml").read_text("utf-8"))
        spec.visual.global_.offwidth, spec.visual.global_.offheight = WIDTH, HEIGHT
        # Without a graphics card smooth edges, shadows and reflections take most of the time.
        spec.visual.quality.offsamples = 0
        model = spec.compile()
        self._data = mujoco.MjData(model)
        self._camera = mujoco.MjvCamera()
        self._camera.distance, self._camera.elevation, self._camera.azimuth = _DISTANCE, _ELEVATION, _AZIMUTH
        self._trail: list[tuple[float, float, float]] = []
        try:
            self._renderer = mujoco.Renderer(model, HEIGHT, WIDTH, max_geom=_MOST_FRAMES + 100)
        # Which exception it is depends on the backend and on what it lacks.
        except Exception as error:
            backend = os.environ.get("MUJOCO_GL") or "the default"
            hint = "set MUJOCO_GL to egl or osmesa, whichever is installed, before Python starts"
            what = f"nothing can be rendered with {backend}: {error}"
            raise InputError(Problem(what, hint=hint)) from error
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_REFLECTION):
            self._renderer.scene.flags[flag] = False

    def render(self, pose: dict[str, float]) -> Frame:
        """The scene with the vehicle at a pose: x_m, y_m, z_m and yaw_rad."""
        position = (pose["x_m"], pose["y_m"], pose["z_m"])
        half = pose["yaw_rad"] / 2.0
        self._data.qpos[:] = (*position, math.cos(half), 0.0, 0.0, math.sin(half))
        self._mujoco.mj_forward(self._renderer.model, self._data)
        self._camera.lookat[:] = position
        self._renderer.update_scene(self._data, self._camera)
        self._trail.append(position)
        self._draw_trail()
        image: Frame = self._renderer.render()
        return image

    def _draw_trail(self) -> None:
        import numpy as np

        mujoco, scene = self._mujoco, self._renderer.scene
        capsule, colour = mujoco.mjtGeom.mjGEOM_CAPSULE, np.array(_TRAIL_COLOUR, np.float32)
        for here, there in zip(self._trail, self._trail[1:], strict=False):
            geom = scene.geoms[scene.ngeom]
            mujoco.mjv_initGeom(geom, capsule, np.zeros(3), np.zeros(3), np.zeros(9), colour)
            mujoco.mjv_connector(geom, capsule, _TRAIL_WIDTH, np.array(here), np.array(there))
            scene.ngeom += 1

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._renderer.close()
