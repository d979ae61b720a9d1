"""Robots whose components are programs and services of this computer."""

from rosa_processes.declarations import BrokerEntry, MqttEntry, ProcessEntry, UnitEntry
from rosa_processes.process_system import ProcessSystem
from rosa_processes.real_robot import Outcome, RealRobot
from rosa_processes.robot_file import RobotDescription, read_robot
from rosa_processes.unit_system import BlockingUnits

__all__ = [
    "BlockingUnits",
    "BrokerEntry",
    "MqttEntry",
    "Outcome",
    "ProcessEntry",
    "ProcessSystem",
    "RealRobot",
    "RobotDescription",
    "UnitEntry",
    "read_robot",
]
