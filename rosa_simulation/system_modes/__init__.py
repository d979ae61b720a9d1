"""ROS 2 system modes: which parts a robot has, which modes they can be in, and who puts them there."""

from rosa_simulation.system_modes.mode_control import FunctionDesign, ModeControl
from rosa_simulation.system_modes.mode_manager import ModeManager
from rosa_simulation.system_modes.model import DEFAULT_MODE, NodePart, PartState, SystemModes, SystemPart
from rosa_simulation.system_modes.reader import load_system_modes
from rosa_simulation.system_modes.situation import Situation

__all__ = [
    "DEFAULT_MODE",
    "FunctionDesign",
    "ModeControl",
    "ModeManager",
    "NodePart",
    "PartState",
    "Situation",
    "SystemModes",
    "SystemPart",
    "load_system_modes",
]
