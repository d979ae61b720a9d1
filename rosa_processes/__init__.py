"""Robots whose components are programs and services of this computer."""

from rosa_processes.declarations import ProcessEntry, UnitEntry
from rosa_processes.process_system import ProcessSystem

__all__ = ["ProcessEntry", "ProcessSystem", "UnitEntry"]
