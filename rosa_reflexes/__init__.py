"""The reactive route: reflexes that take the command from deliberation in an emergency (RoCS paper, section 4.3)."""

from rosa_reflexes.commands import Bounds, Command
from rosa_reflexes.config import GateConfig, fault_reflex
from rosa_reflexes.events import (
    Answer,
    GateEvent,
    HandedBack,
    Preempted,
    ReflexRaised,
    Refused,
    SensorFaultChanged,
)
from rosa_reflexes.gate import DELIBERATION_SILENT, CommandGate, Watchdog
from rosa_reflexes.reflex import Condition, Reflex
from rosa_reflexes.rules import Rule, RuleError, parse_rule
from rosa_reflexes.sensors import Fault, Readings, SensorLimits
from rosa_reflexes.yaml_format import read_reflexes

__all__ = [
    "DELIBERATION_SILENT",
    "Answer",
    "Bounds",
    "Command",
    "CommandGate",
    "Condition",
    "Fault",
    "GateConfig",
    "GateEvent",
    "HandedBack",
    "Preempted",
    "Readings",
    "Reflex",
    "ReflexRaised",
    "Refused",
    "Rule",
    "RuleError",
    "SensorFaultChanged",
    "SensorLimits",
    "Watchdog",
    "fault_reflex",
    "parse_rule",
    "read_reflexes",
]
