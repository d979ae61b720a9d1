"""A gate's configuration: sensors, commands, bounds, reflexes and watchdog, from a file or built in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from rosa_core import Clock
from rosa_reflexes.commands import Bounds, Command
from rosa_reflexes.events import GateEvent
from rosa_reflexes.gate import CommandGate, Watchdog
from rosa_reflexes.reflex import Reflex
from rosa_reflexes.sensors import SensorLimits


@dataclass(frozen=True, kw_only=True)
class GateConfig:
    """Everything that a :class:`CommandGate` is made of, but the robot.

    Attributes:
        sensors: what the reflexes read.
        reflexes: in order of declaration; the reflexes for faulty sensors are among them.
        safe_command: what is commanded when a reflex raises.
        commands: the named commands.
        parameters: named numbers that the reflexes use as limits.
        bounds: by channel, what may be commanded.
        watchdog: what happens when deliberation falls silent; None: nothing.
    """

    sensors: tuple[SensorLimits, ...]
    reflexes: tuple[Reflex, ...]
    safe_command: Command
    commands: Mapping[str, Command] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, Bounds] = field(default_factory=dict)
    watchdog: Watchdog | None = None

    def gate(
        self,
        actuate: Callable[[Command], object],
        clock: Clock,
        on_event: Callable[[GateEvent], object] | None = None,
    ) -> CommandGate:
        """A gate to these actuators.

        Args:
            actuate: sends a command to the actuators.
            clock: where the time comes from.
            on_event: hears of every change of hands, refusal and fault.

        Raises:
            ValueError: if two reflexes share a name, or one reads a sensor that there is not.
        """
        return CommandGate(
            actuate,
            clock,
            self.sensors,
            self.reflexes,
            safe_command=self.safe_command,
            parameters=self.parameters,
            bounds=self.bounds,
            watchdog=self.watchdog,
            on_event=on_event,
        )


def fault_reflex(sensor: str, command: Command, *, release_after: float = 0.0, priority: float = 1e9) -> Reflex:
    """A reflex that commands as long as a sensor is faulty: silent, stuck, out of range or not a number.

    Args:
        sensor: its name.
        command: what is commanded then.
        release_after: for how many seconds it must have worked again before the reflex is over.
        priority: of the reflex; by default above those of all rules.
    """
    return Reflex(
        f"{sensor} faulty",
        (sensor,),
        lambda readings: readings.fault(sensor) is not None,
        command,
        release_after=release_after,
        priority=priority,
        describe=f"faulty({sensor})",
    )
