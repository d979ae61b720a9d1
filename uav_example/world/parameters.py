"""The numbers of the world."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class WorldParameters:
    """The area, the aircraft, and what can go wrong. Lengths in m, times in s, charge as a share of a full battery.

    None of them is published; they are chosen so that a mission takes a few minutes and meets all three uncertainties
    of the ROSA paper's section 7.4.2.
    """

    time_limit: float = 900.0
    """When the mission is broken off."""
    width: float = 160.0
    """Of the area, along x; the base is at its corner (0, 0)."""
    depth: float = 100.0
    """Of the area, along y."""
    samples: int = 6
    """How many samples lie in the area; where, is drawn from the seed."""
    lane_spacing: float = 20.0
    """Between two lanes of the search."""
    sight: float = 12.0
    """How far from the point below it the aircraft sees a sample while searching."""
    search_height: float = 20.0
    pick_height: float = 0.5
    scan_height: float = 4.0
    home_height: float = 2.0
    """Of the charging mast at the base."""
    speed: float = 8.0
    """Horizontally, m/s."""
    climb_speed: float = 3.0
    """Vertically, m/s."""
    pick_time: float = 20.0
    """To pick a sample up and analyse it."""
    scan_time: float = 12.0
    """To analyse it on site."""
    fold_time: float = 4.0
    """For the gripper to fold."""
    spring_time: float = 8.0
    """For the spring to fold it."""
    gripper_life: float = 25.0
    """Mean time of use after which the gripper fails (exponential, drawn from the seed)."""
    gripper_fails_after: float | None = None
    """The time of use after which it fails, instead of a draw."""
    spring: bool = True
    """Whether there is a spring that folds a gripper which has failed."""
    initial_charge: float = 1.0
    drain_hover: float = 0.001
    """Charge per second in the air while nothing is done; the others by action."""
    drain_search: float = 0.005
    drain_analyze: float = 0.006
    drain_analyze_in_situ: float = 0.004
    drain_return_base: float = 0.003
    drain_land_fold: float = 0.002
    charge_rate: float = 0.03
    """Per second at the base."""
    control_period: float = 0.1
    """Between two steps of the aircraft."""
    publishing_period: float = 1.0
    """Between two measurements of the battery."""
    service_time: float = 0.003
    """From a call to a component until it takes effect: what a lifecycle service takes in ROS 2."""
