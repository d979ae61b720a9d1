"""What the sensors say, and what is wrong with them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum


class Fault(StrEnum):
    """What can be wrong with a sensor."""

    SILENT = "silent"
    STUCK = "stuck"
    NOT_A_NUMBER = "not a number"
    OUT_OF_RANGE = "out of range"


@dataclass(frozen=True, slots=True)
class SensorLimits:
    """A sensor, and from when on it counts as faulty.

    Attributes:
        name: as reflexes name it, such as ``range.front``.
        lowest: the least value that it can measure, in its own unit.
        highest: the greatest.
        silent_after: it is silent if no sample came for so many seconds.
        stuck_after: it is stuck if its samples were exactly the same for so many seconds.

    Raises:
        ValueError: if the range is empty or a time is not positive.
    """

    name: str
    lowest: float = -math.inf
    highest: float = math.inf
    silent_after: float = math.inf
    stuck_after: float = math.inf

    def __post_init__(self) -> None:
        if not self.lowest <= self.highest:
            raise ValueError(f"nothing lies between {self.lowest} and {self.highest}")
        if not (self.silent_after > 0 and self.stuck_after > 0):
            raise ValueError("the times after which a sensor is silent or stuck must be positive")


class _Channel:
    """The latest sample of a sensor."""

    __slots__ = ("changed_at", "fault", "sampled_at", "sensor")

    def __init__(self, sensor: SensorLimits, now: float) -> None:
        self.sensor = sensor
        self.sampled_at = self.changed_at = now
        self.fault: Fault | None = None


class Readings(Mapping[str, float]):
    """The latest value of each sensor and parameter by name, and the faults of the sensors.

    A sensor that has given no sample reads NaN, and so does one whose sample was not a number: no comparison with it
    holds, so that a reflex is not released by it.

    Args:
        sensors: the sensors.
        parameters: named numbers that reflexes use as limits, such as a stopping distance.
        now: the present time, s; silence counts from here.
    """

    __slots__ = ("_channels", "_parameters", "_values")

    def __init__(self, sensors: Iterable[SensorLimits], parameters: Mapping[str, float], now: float) -> None:
        self._channels = {sensor.name: _Channel(sensor, now) for sensor in sensors}
        self._parameters = frozenset(parameters)
        self._values: dict[str, float] = dict.fromkeys(self._channels, math.nan) | dict(parameters)

    def __getitem__(self, name: str) -> float:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def fault(self, name: str) -> Fault | None:
        """What is wrong with a sensor, None if nothing is."""
        return self._channels[name].fault

    def faults(self) -> dict[str, Fault]:
        """What is wrong, by sensor."""
        return {name: channel.fault for name, channel in self._channels.items() if channel.fault is not None}

    @property
    def parameters(self) -> frozenset[str]:
        """The names of the parameters."""
        return self._parameters

    def set_parameter(self, name: str, value: float) -> None:
        """Give a parameter another value.

        Raises:
            LookupError: if there is no such parameter.
            ValueError: if the value is not a finite number.
        """
        if name not in self._parameters:
            raise LookupError(f"there is no parameter '{name}'")
        if not math.isfinite(value):
            raise ValueError(f"the parameter '{name}' cannot be {value}")
        self._values[name] = value

    def sample(self, name: str, value: float, now: float) -> bool:
        """Take a sample.

        Returns:
            whether the sensor's fault changed by it.

        Raises:
            LookupError: if there is no such sensor.
        """
        channel = self._channels[name]
        if value != self._values[name]:
            channel.changed_at = now
        self._values[name] = value
        channel.sampled_at = now
        before, channel.fault = channel.fault, _fault_of_sample(channel, value, now)
        return channel.fault is not before

    def look_for_silence(self, now: float) -> list[str]:
        """The sensors that have become silent."""
        silent = []
        for name, channel in self._channels.items():
            if channel.fault is not Fault.SILENT and now - channel.sampled_at > channel.sensor.silent_after:
                channel.fault = Fault.SILENT
                silent.append(name)
        return silent


def _fault_of_sample(channel: _Channel, value: float, now: float) -> Fault | None:
    sensor = channel.sensor
    if not sensor.lowest <= value <= sensor.highest:
        return Fault.NOT_A_NUMBER if math.isnan(value) else Fault.OUT_OF_RANGE
    return Fault.STUCK if now - channel.changed_at > sensor.stuck_after else None
