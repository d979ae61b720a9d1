"""Films a mission: its recorded trajectory is replayed in MuJoCo and rendered from above, without a screen."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.run_record import RunRecord
from rosa_simulation.video import Captioner, Frame, check_video, choose_renderer, write_video

WIDTH, HEIGHT = 640, 640
FRAMES_PER_SECOND = 15
_MOST_FRAMES = 3000
_EVENTS_SHOWN, _SHOWN_FOR = 3, 6.0
_DISTANCE, _ELEVATION = 6.2, -75.0


def prepare_film(path: Path) -> Callable[[RunRecord], None]:
    """Make sure, before the mission, that it can be filmed; call this before MuJoCo is imported.

    Args:
        path: where the video is to be written.

    Returns:
        what films a run.

    Raises:
        InputError: if the video cannot be written, or nothing can be rendered.
    """
    check_video(path)
    choose_renderer()
    return lambda record: film(record, path)


def film(record: RunRecord, path: Path) -> None:
    """Write a video of a run: a frame for each row of its trajectory, with what is going on as captions.

    Args:
        record: with its trajectory; the arena is made again from its inputs.
        path: of the video; its ending says the format.

    Raises:
        InputError: if the file cannot be written or nothing can be rendered.
    """
    with closing(_Replay(record.inputs["arena"])) as replay:
        write_video(path, _frames(record, replay), FRAMES_PER_SECOND)


def _frames(record: RunRecord, replay: _Replay) -> Iterator[Frame]:
    caption = Captioner(WIDTH)
    title = f"{record.scenario} · manager {record.manager} · seed {record.seed}"
    for row in record.trajectory[:: math.ceil(len(record.trajectory) / _MOST_FRAMES)]:
        pose = dict(zip(record.trajectory_columns, row, strict=True))
        now, route = pose["time_s"], "reactive" if pose["reactive"] else "deliberative"
        recent = [event for event in record.events if now - _SHOWN_FOR <= event.time_s <= now]
        events = [f"{event.time_s:.1f} s  {event.text}" for event in recent[-_EVENTS_SHOWN:]]
        yield caption(replay.render(pose), [f"{title} · {now:.1f} s · {route} route"], events)


class _Replay:
    """Renders both robots where they were; must be closed."""

    def __init__(self, arena: Mapping[str, Any]) -> None:
        import mujoco

        from pioneer_example.world.arena import Arena
        from pioneer_example.world.geometry import Rectangle
        from pioneer_example.world.mujoco_backend import arena_xml

        walls = tuple(Rectangle(**wall) for wall in arena["walls"])
        starts = {name: tuple(pose) for name, pose in arena["starts"].items()}
        self._mujoco = mujoco
        self._model = mujoco.MjModel.from_xml_string(arena_xml(Arena(walls, Rectangle(**arena["box"]), starts)))
        self._data = mujoco.MjData(self._model)
        mujoco.mj_forward(self._model, self._data)
        self._options = mujoco.MjvOption()
        self._options.flags[mujoco.mjtVisFlag.mjVIS_RANGEFINDER] = False
        self._camera = mujoco.MjvCamera()
        self._camera.distance, self._camera.elevation, self._camera.azimuth = _DISTANCE, _ELEVATION, 90.0
        self._camera.lookat[:] = (0.8, 0.8, 0.0)
        try:
            self._renderer = mujoco.Renderer(self._model, HEIGHT, WIDTH)
        # Which exception it is depends on the renderer and on what it lacks.
        except Exception as error:
            hint = "set MUJOCO_GL to egl or osmesa, whichever is installed, before Python starts"
            raise InputError(Problem(f"nothing can be rendered: {error}", hint=hint)) from error

    def render(self, pose: Mapping[str, float]) -> Frame:
        """The arena with the robots at a row of the trajectory."""
        for robot, prefix in (("pioneer", ""), ("explorer", "explorer_")):
            first = int(self._model.body(robot).jntadr[0])
            at = int(self._model.jnt_qposadr[first])
            half = pose[f"{prefix}heading_rad"] / 2.0
            self._data.qpos[at : at + 2] = pose[f"{prefix}x_m"], pose[f"{prefix}y_m"]
            self._data.qpos[at + 3 : at + 7] = math.cos(half), 0.0, 0.0, math.sin(half)
        self._mujoco.mj_forward(self._model, self._data)
        self._renderer.update_scene(self._data, self._camera, self._options)
        image: Frame = self._renderer.render()
        return image

    def close(self) -> None:
        """Give the renderer's memory back."""
        self._renderer.close()
