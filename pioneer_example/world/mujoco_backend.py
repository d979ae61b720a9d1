"""The arena in MuJoCo: two robots with mass, driven wheels and casters, and sonars as rangefinder sensors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import mujoco

from pioneer_example.world.arena import AXLE, PIONEER, RADIUS, WHEEL, Arena
from pioneer_example.world.backend import Wheels, ramped
from pioneer_example.world.geometry import Pose, Rectangle
from pioneer_example.world.sonar_ring import MOUNT, RAYS, REACH, heard

_STEP = 0.005
_HEIGHT = 0.25


class MujocoBackend:
    """Robots that have mass and can slip.

    Args:
        arena: what there is.
    """

    def __init__(self, arena: Arena) -> None:
        self._model = mujoco.MjModel.from_xml_string(arena_xml(arena))
        self._data = mujoco.MjData(self._model)
        self._wheels: dict[str, Wheels] = dict.fromkeys(arena.starts, (0.0, 0.0))
        self._bodies = {robot: self._data.body(robot) for robot in arena.starts}
        self._first = {robot: number * len(RAYS) for number, robot in enumerate(arena.starts)}
        hulls = {robot: self._model.geom(f"{robot} hull").id for robot in arena.starts}
        self._hulls = hulls
        mujoco.mj_forward(self._model, self._data)
        self._touched: frozenset[int] = frozenset()

    def step(self, seconds: float, commands: Mapping[str, Wheels]) -> None:
        """Let time pass, in steps of 5 ms."""
        touched: set[int] = set()
        for _ in range(round(seconds / _STEP)):
            control = []
            for robot in self._bodies:
                self._wheels[robot] = ramped(self._wheels[robot], commands.get(robot, (0.0, 0.0)), _STEP)
                control += [speed / WHEEL for speed in self._wheels[robot]]
            self._data.ctrl[:] = control
            mujoco.mj_step(self._model, self._data)
            # Only hulls touch anything but the floor: wheels and casters are under them.
            for pair in self._data.contact.geom.tolist():
                touched.update(pair)
        self._touched = frozenset(touched)

    def pose(self, robot: str) -> Pose:
        """Where a robot is."""
        body = self._bodies[robot]
        x, y, _ = body.xpos.tolist()
        qw, qx, qy, qz = body.xquat.tolist()
        return x, y, math.atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))

    def ranges(self, robot: str) -> list[float]:
        """What the rangefinders say."""
        first = self._first[robot]
        rays = self._data.sensordata[first : first + len(RAYS)].tolist()
        return heard([REACH if ray < 0.0 else ray for ray in rays])

    def touches(self, robot: str) -> bool:
        """Whether its hull had a contact since the step before."""
        return self._hulls[robot] in self._touched

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model, for films."""
        return self._model

    @property
    def data(self) -> mujoco.MjData:
        """Its state."""
        return self._data


def arena_xml(arena: Arena) -> str:
    """The arena as MJCF."""
    parts = [
        '<mujoco model="pioneer">',
        f'<option timestep="{_STEP}" integrator="implicitfast"/>',
        '<visual><global offwidth="1280" offheight="720"/></visual>',
        "<worldbody>",
        '<light pos="0.8 0.9 5" dir="0 0 -1" diffuse="0.35 0.35 0.35" specular="0 0 0"/>',
        '<geom name="floor" type="plane" size="6 6 0.1" rgba="0.9 0.9 0.88 1" friction="1 0.005 0.0001"/>',
        *(_block(f"wall {number}", wall, "0.45 0.45 0.5 1") for number, wall in enumerate(arena.walls)),
        _block("box", arena.box, "0.65 0.42 0.2 1"),
        *(_body(robot, pose) for robot, pose in arena.starts.items()),
        "</worldbody><actuator>",
    ]
    for robot in arena.starts:
        parts += [
            f'<velocity name="{robot} {side}" joint="{robot} {side}" kv="4" forcerange="-8 8"/>'
            for side in ("left", "right")
        ]
    parts.append("</actuator><sensor>")
    for robot in arena.starts:
        parts += [f'<rangefinder site="{robot} ray {n}" cutoff="{REACH}"/>' for n in range(len(RAYS))]
    return "".join([*parts, "</sensor></mujoco>"])


def _block(name: str, one: Rectangle, colour: str) -> str:
    half = _HEIGHT
    place = f'pos="{one.x!r} {one.y!r} {half}" size="{one.half_x!r} {one.half_y!r} {half}"'
    return f'<geom name="{name}" type="box" {place} rgba="{colour}" friction="0.3"/>'


def _body(robot: str, pose: Pose) -> str:
    x, y, heading = pose
    colour = "0.75 0.15 0.1 1" if robot == PIONEER else "0.2 0.35 0.65 1"
    quat = f"{math.cos(heading / 2.0)!r} 0 0 {math.sin(heading / 2.0)!r}"
    return "".join(
        [
            f'<body name="{robot}" pos="{x!r} {y!r} {WHEEL}" quat="{quat}"><freejoint/>',
            f'<geom name="{robot} hull" type="cylinder" size="{RADIUS} 0.08" pos="0 0 0.09" mass="6" rgba="{colour}"',
            ' friction="0.3"/>',
            *_casters(robot),
            *_wheels(robot),
            *_sites(robot),
            "</body>",
        ]
    )


def _casters(robot: str) -> Iterator[str]:
    """Balls that slide: the robot rests on them and its wheels."""
    size = 0.04
    for name, x in (("front", 0.15), ("rear", -0.15)):
        at = f'pos="{x} 0 {size - WHEEL}"'
        yield f'<geom name="{robot} {name}" type="sphere" size="{size}" {at} mass="1.5" friction="0.001" condim="1"'
        yield ' priority="1"/>'


def _wheels(robot: str) -> Iterator[str]:
    for side, y in (("left", AXLE / 2.0), ("right", -AXLE / 2.0)):
        yield f'<body name="{robot} {side} wheel" pos="0 {y} 0">'
        yield f'<joint name="{robot} {side}" axis="0 1 0" damping="0.05"/>'
        yield f'<geom type="cylinder" size="{WHEEL} 0.02" euler="90 0 0" mass="1" friction="1.2"/></body>'


def _sites(robot: str) -> Iterator[str]:
    for number, angle in enumerate(RAYS):
        cos, sin = math.cos(angle), math.sin(angle)
        place = f'pos="{MOUNT * cos!r} {MOUNT * sin!r} 0.13" zaxis="{cos!r} {sin!r} 0"'
        yield f'<site name="{robot} ray {number}" {place} size="0.005"/>'
