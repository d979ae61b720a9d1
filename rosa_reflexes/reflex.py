"""A reflex: what it watches, when it takes the command, what it commands, when it hands back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from rosa_reflexes.commands import Command
from rosa_reflexes.sensors import Readings

Condition = Callable[[Readings], bool]
"""Something that is true or false of what the sensors say. It must not change anything."""


@dataclass(frozen=True, slots=True)
class Reflex:
    """Takes the command from deliberation when its trigger holds, and hands it back when it is released.

    Attributes:
        name: what it is called in events and explanations.
        reads: the sensors whose samples it is evaluated on.
        trigger: when it fires.
        command: what it commands; a function of what the sensors say is asked again with every sample while it holds
            the command.
        release: when it is over; None: as soon as the trigger does not hold.
        release_after: for how many seconds ``release`` must have held without a break.
        dwell: for how many seconds it stays at least.
        priority: of several reflexes that have fired, the one with the greatest number commands, then the one that was
            declared first.
        describe: its trigger in words, for explanations.

    Raises:
        ValueError: if it reads nothing, or a time is negative.
    """

    name: str
    reads: tuple[str, ...]
    trigger: Condition
    command: Command | Callable[[Readings], Command]
    release: Condition | None = None
    release_after: float = 0.0
    dwell: float = 0.0
    priority: float = 0.0
    describe: str = ""

    def __post_init__(self) -> None:
        if not self.reads:
            raise ValueError(f"reflex '{self.name}' reads no sensor: it would never be evaluated")
        if not (self.release_after >= 0 and self.dwell >= 0):
            raise ValueError(f"the times of reflex '{self.name}' cannot be negative")

    def commands(self, readings: Readings) -> Command:
        """What it commands now."""
        return self.command if isinstance(self.command, Mapping) else self.command(readings)

    def may_release(self, readings: Readings) -> bool:
        """Whether its release condition holds and its trigger does not."""
        if self.trigger(readings):
            return False
        return self.release is None or self.release(readings)
