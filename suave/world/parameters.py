"""Numbers of the world that are not in a mission configuration."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WorldParameters:
    """How the vehicle starts, moves and knows where it is. Lengths in m, times in s.

    The fields marked *fitted* were chosen so that search times and distances resemble those published for SUAVE
    (ROSA paper, table 6); the others are the exemplar's own or the vehicle's.
    """

    start: tuple[float, float, float] = (-17.0, 1.95, -18.5)
    """Where the vehicle starts; y is *fitted*."""
    start_spread: float = 0.15
    """Standard deviation of the start in x and y; *fitted*."""
    settling_time: float = 18.0
    """From GUIDED until the vehicle follows setpoints; *fitted* (the exemplar's search begins that late)."""
    noise_horizontal: float = 0.2
    """Standard deviation of the error of the estimated position in x and y; *fitted*."""
    noise_vertical: float = 0.1
    """The same in z; *fitted*."""
    noise_correlation_time: float = 20.0
    """How slowly that error wanders (Ornstein-Uhlenbeck); *fitted*."""
    control_period: float = 0.1
    """Between two commands to the thrusters."""
    position_gain: float = 0.42
    """Desired velocity per position error, 1/s; *fitted*."""
    speed_horizontal: float = 1.0
    """At most, m/s."""
    speed_vertical: float = 0.75
    """At most, m/s."""
    service_time: float = 0.003
    """From a call to a component until it takes effect: what a lifecycle or parameter service takes in ROS 2."""
    recovery_time: float = 10.0
    """From the activation of the thruster recovery to the first recovered thruster."""
    recovery_interval: float = 0.25
    """From one recovered thruster to the next."""
