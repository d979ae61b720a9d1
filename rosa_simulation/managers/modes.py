"""What managing systems over system modes begin with."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_simulation.mission import Mission
from rosa_simulation.system_modes import ModeControl, ModeManager, Situation, SystemModes, load_system_modes


def mode_control(mission: Mission) -> ModeControl:
    """What there is to know of the mission's robot for a managing system over system modes.

    Raises:
        ValueError: if the robot has no system modes; a scenario then offers no such managing system.
    """
    if mission.modes is None:
        raise ValueError("this robot has no system modes")
    return mission.modes


def mode_manager(mission: Mission) -> ModeManager:
    """A mode manager for the mission's robot."""
    return ModeManager(_load(mode_control(mission).modes_file), mission.robot)


@lru_cache(maxsize=8)
def _load(path: Path) -> SystemModes:
    return load_system_modes(path)


def observed(mission: Mission) -> Situation:
    """The mission's situation, from now on; what it takes to observe it counts as managing."""
    situation = Situation()

    def monitor(diagnostics: DiagnosticArray) -> None:
        with mission.stopwatch.running():
            situation.update(diagnostics)

    mission.robot.on_diagnostics.append(monitor)
    return situation
