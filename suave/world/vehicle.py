"""The vehicle's body in MuJoCo: six thrusters, drag, and a controller that flies it to a setpoint."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from importlib.resources import files

import mujoco
import numpy as np

from suave.world.parameters import WorldParameters

Vector = tuple[float, float, float]

THRUSTERS = 6
# Linear drag of the vehicle (N per m/s, and N m per rad/s), the published coefficients of the BlueROV2.
DRAG = (33.732, 54.16, 73.225, 3.992, 3.992, 3.992)
_VELOCITY_GAIN = 25.0
_YAW_GAIN, _YAW_DAMPING = 8.0, 6.0
_STRONGEST = 50.0


@cache
def _load_body() -> mujoco.MjModel:
    """The compiled body, which nobody changes: every vehicle in a process shares it."""
    model = mujoco.MjModel.from_xml_string(files("suave.world").joinpath("auv.xml").read_text("utf-8"))
    model.dof_dampingpoly[:, 0] = DRAG
    return model


class Vehicle:
    """A free body with six thrusters, any of which may fail.

    Args:
        parameters: start, speeds and noise.
        rng: where start and noise are drawn from.

    Attributes:
        position: true position, (x, y, z) in m, as of the last step.
        estimate: position as the vehicle believes it, with a slowly wandering error.
        target: the setpoint, or None to hold still where it is.
        powered: without power no thruster works.
        guard: what the setpoint passes through at each step before it is flown to; None: nothing.
    """

    def __init__(self, parameters: WorldParameters, rng: np.random.Generator) -> None:
        self._parameters = parameters
        self._rng = rng
        self._model = _load_body()
        self._data = mujoco.MjData(self._model)
        self._substeps = round(parameters.control_period / self._model.opt.timestep)
        spread = rng.normal(0.0, parameters.start_spread, 2)
        x, y, z = parameters.start
        self._data.qpos[:3] = (x + float(spread[0]), y + float(spread[1]), z)
        mujoco.mj_forward(self._model, self._data)
        self._allocation = self._thrust_allocation()
        self._noise = [0.0, 0.0, 0.0]
        self._draws: list[list[float]] = []
        decay = math.exp(-parameters.control_period / parameters.noise_correlation_time)
        fresh = math.sqrt(1.0 - decay * decay)
        self._decay = decay
        self._fresh = (
            fresh * parameters.noise_horizontal,
            fresh * parameters.noise_horizontal,
            fresh * parameters.noise_vertical,
        )
        self._working = [True] * THRUSTERS
        self.powered = True
        self.target: Vector | None = None
        self.guard: Callable[[Vector], Vector] | None = None
        self.yaw = 0.0
        self.position: Vector = self._true_position()
        self.estimate: Vector = self.position

    def set_thruster(self, number: int, working: bool) -> None:
        """Let a thruster (1 to 6) fail or work again.

        Args:
            number: 1 to 6.
            working: False to let it fail.
        """
        self._working[number - 1] = working

    def failed_thrusters(self) -> list[int]:
        """The numbers of the thrusters that do not work."""
        return [index + 1 for index, working in enumerate(self._working) if not working]

    def step(self) -> None:
        """One control period: command the thrusters, then let the water and the body have their way."""
        target = self.target if self.target is None or self.guard is None else self.guard(self.target)
        wanted = (0.0,) * THRUSTERS if target is None or not self.powered else self._commands(target)
        self._data.ctrl[:] = [c if ok else 0.0 for c, ok in zip(wanted, self._working, strict=True)]
        mujoco.mj_step(self._model, self._data, self._substeps)
        self.position = self._true_position()
        self._wander()
        x, y, z = self.position
        ex, ey, ez = self._noise
        self.estimate = (x + ex, y + ey, z + ez)

    def _true_position(self) -> Vector:
        x, y, z = self._data.qpos[:3].tolist()
        return (x, y, z)

    def _wander(self) -> None:
        if not self._draws:
            self._draws = self._rng.standard_normal((1000, 3)).tolist()
        draw = self._draws.pop()
        self._noise = [
            self._decay * error + scale * step
            for error, scale, step in zip(self._noise, self._fresh, draw, strict=True)
        ]

    def _commands(self, target: Vector) -> list[float]:
        """Thruster forces (N) that fly to the target: velocity control with drag feed-forward, yaw held at 0."""
        p = self._parameters
        qw, qx, qy, qz = self._data.qpos[3:7].tolist()
        vx, vy, vz, roll_rate, _, yaw_rate = self._data.qvel.tolist()
        ex, ey, ez = (t - e for t, e in zip(target, self.estimate, strict=True))
        wx, wy = p.position_gain * ex, p.position_gain * ey
        speed = math.hypot(wx, wy)
        if speed > p.speed_horizontal:
            wx, wy = wx * p.speed_horizontal / speed, wy * p.speed_horizontal / speed
        wz = min(max(p.position_gain * ez, -p.speed_vertical), p.speed_vertical)
        fx = _VELOCITY_GAIN * (wx - vx) + DRAG[0] * wx
        fy = _VELOCITY_GAIN * (wy - vy) + DRAG[1] * wy
        fz = _VELOCITY_GAIN * (wz - vz) + DRAG[2] * wz
        self.yaw = yaw = math.atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz))
        roll = math.atan2(2.0 * (qw * qx + qy * qz), 1.0 - 2.0 * (qx * qx + qy * qy))
        cos, sin = math.cos(yaw), math.sin(yaw)
        bx, by = cos * fx + sin * fy, cos * fy - sin * fx
        bk = -_YAW_GAIN * roll - _YAW_DAMPING * roll_rate
        bn = -_YAW_GAIN * yaw - _YAW_DAMPING * yaw_rate
        forces = [x * bx + y * by + z * fz + k * bk + n * bn for x, y, z, k, n in self._allocation]
        return [min(max(force, -_STRONGEST), _STRONGEST) for force in forces]

    def _thrust_allocation(self) -> list[list[float]]:
        """The pseudo-inverse that turns a wrench (x, y, z, roll, yaw) in the body frame into thruster forces."""
        data = self._data
        origin = data.body("auv").xpos
        effect = np.zeros((5, THRUSTERS))
        for index in range(THRUSTERS):
            site = data.site(f"thruster_{index + 1}")
            force = site.xmat.reshape(3, 3)[:, 0]
            torque = np.cross(site.xpos - origin, force)
            effect[:, index] = (*force, torque[0], torque[2])
        allocation: list[list[float]] = np.linalg.pinv(effect).tolist()
        return allocation
