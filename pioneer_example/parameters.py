"""What an experiment may set of a run."""

from __future__ import annotations

from collections.abc import Mapping

from rosa_simulation.parameters import number
from rosa_simulation.scenario import Parameter

FAULTS = ("none", "silent", "stuck", "nan")
BACKENDS = ("mujoco", "kinematic")


def _one_of(names: tuple[str, ...]) -> Parameter:
    def read(raw: object) -> str:
        if raw not in names:
            raise ValueError(f"one of {', '.join(names)} is expected")
        return str(raw)

    return Parameter("", read, names[0])


PARAMETERS: Mapping[str, Parameter] = {
    "time_limit": Parameter("how long the mission may take, s", number(1.0, 3600.0), 120.0),
    "speed": Parameter("the speed that every manager drives with at first, m/s", number(0.05, 0.7), 0.4),
    "noise": Parameter("standard deviation of the sonars' ranges, m", number(0.0, 0.2), 0.01),
    "dropouts": Parameter("share of the sonars' samples that do not come", number(0.0, 0.9), 0.02),
    "deliberation_time": Parameter("from the pose that is looked at to the command, s", number(0.0, 2.0), 0.1),
    "explorer_speed": Parameter("of the second robot, m/s; 0: it stands still", number(0.0, 0.5), 0.2),
    "sonar_fault": Parameter("what becomes of the sonar ring: none, silent, stuck, nan", _one_of(FAULTS).read, "none"),
    "sonar_fault_at": Parameter("when, s", number(0.0, 3600.0), 4.0),
    "backend": Parameter("what simulates: mujoco, kinematic", _one_of(BACKENDS).read, "mujoco"),
}
