"""The robot's functions as system modes."""

from __future__ import annotations

from importlib.resources import as_file, files

from rosa_simulation.system_modes import ModeManager, SystemModes, load_system_modes
from suave.managers.manager import ManagedMission

UNGROUND = "fd_unground"
"""The mode of a function that nobody requires."""


def load_suave_modes(*, extended: bool) -> SystemModes:
    """The system modes of the plain or the extended mission."""
    name = "suave_extended_modes.yaml" if extended else "suave_modes.yaml"
    with as_file(files("suave.managers").joinpath(name)) as path:
        return load_system_modes(path)


def mode_manager(mission: ManagedMission) -> ModeManager:
    """A mode manager for the mission's robot."""
    return ModeManager(load_suave_modes(extended=mission.extended), mission.robot)
