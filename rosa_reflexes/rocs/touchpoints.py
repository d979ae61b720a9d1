"""What a robot senses with and acts through (RoCS paper, section 5.1): the classes to swap from simulation to robot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

T_co = TypeVar("T_co", covariant=True)
C_contra = TypeVar("C_contra", contravariant=True)


class Sensor(ABC, Generic[T_co]):
    """A sensor with a kind of value; several monitors may read it.

    Args:
        name: unique in its robot.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    @abstractmethod
    def get_data(self) -> T_co:
        """The present raw value; must return at once."""


class Actuator(ABC, Generic[C_contra]):
    """An actuator with a kind of command. Outgoing communication is one, such as a radio.

    Args:
        name: unique in its robot.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    @abstractmethod
    def actuate(self, command: C_contra) -> None:
        """Carry out a command; must return at once."""
