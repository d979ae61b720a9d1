"""What a mission achieved, and how fast its managing system reacted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosa_core.clock import Stopwatch
from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.metric import MEAN_REACTION_TIME, Better, Metric, MetricKind
from rosa_simulation.reaction_times import ReactionTimes
from rosa_simulation.robot_event import NodeChange, RobotEvent
from suave.events import SuaveEvent

if TYPE_CHECKING:
    from suave.robot import SuaveRobot

U1, U2, U3 = "U1", "U2", "U3"

METRICS = (
    Metric("pipeline_found", "", "whether the pipeline was found", MetricKind.TRUTH, Better.MORE),
    Metric("pipeline_inspected", "", "whether all of it was inspected", MetricKind.TRUTH, Better.MORE),
    Metric(
        "search_time_s",
        "s",
        "time until the pipeline was found; the mission's duration if it was not",
        MetricKind.DURATION,
        Better.LESS,
    ),
    Metric(
        "distance_inspected_m",
        "m",
        "length of pipeline inspected since following it last began, as the exemplar counts it",
        MetricKind.DISTANCE,
        Better.MORE,
    ),
    Metric(
        "distance_inspected_total_m",
        "m",
        "length of pipeline inspected in the whole mission",
        MetricKind.DISTANCE,
        Better.MORE,
    ),
    Metric("recharges", "", "how often the battery was charged", MetricKind.COUNT, Better.NEITHER),
    MEAN_REACTION_TIME,
)


class MissionMetrics:
    """Observes the robot; definitions as in the SUAVE exemplar and the ROSA paper (section 7.1.2).

    Reaction times: U1 from the diagnostic of a failed thruster to the recovery node active; U2 from the first
    visibility at which the search altitude is wrong, unless the battery is low, to the parameter set to the expected
    altitude; U3 from the first battery level below the limit to the recharge node active. The delay is simulated
    time, the compute part is the wall-clock time that the manager spent on it until it made the call.

    Args:
        robot: must not have a managing system yet, as reactions are timed from its own diagnostics.
        stopwatch: the wall-clock time that managing systems have taken.
    """

    def __init__(self, robot: SuaveRobot, stopwatch: Stopwatch) -> None:
        self._robot = robot
        self._found_at: float | None = None
        self._ended_at: float | None = None
        self._battery_is_low = False
        self.times = ReactionTimes((U1, U2, U3), stopwatch)
        robot.on_event.append(self._on_event)
        robot.on_call.append(self._on_call)
        # Before any managing system subscribes: its reaction is timed from here.
        robot.on_diagnostics.append(self._on_diagnostics)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        stamp = array["header"]["stamp"]
        for key, value, _ in values_of(array):
            self._observe(key, value, stamp)

    def _on_call(self, component: str) -> None:
        """The managing system calls a component: its deciding is over, what follows is delay."""
        for cause, awaited in ((U1, "f_maintain_motion_node"), (U3, "generate_recharge_path_node")):
            if component == awaited:
                self.times.decide(cause)
        if component == "f_generate_search_path_node":
            self.times.decide(U2)

    @property
    def duration(self) -> float:
        """How long the mission lasted, s."""
        return self._robot.mission_time() if self._ended_at is None else self._ended_at

    def summary(self) -> dict[str, Any]:
        """The exemplar's metrics; times in s, distances in m."""
        robot = self._robot
        started = robot.guided_at is not None
        return {
            "pipeline_found": robot.pipeline_found,
            "pipeline_inspected": robot.pipeline_inspected,
            "search_time_s": self.duration if self._found_at is None else self._found_at,
            "distance_inspected_m": robot.follow.distance if started else 0.0,
            "distance_inspected_total_m": robot.follow.total_distance if started else 0.0,
            "recharges": robot.battery.charges if robot.battery is not None else 0,
            MEAN_REACTION_TIME.name: self.times.means(),
        }

    def _observe(self, key: str, value: str, stamp: float) -> None:
        if key.startswith("c_thruster_") and value == "FALSE" and not self._robot.recover.active:
            self.times.begin(U1, stamp)
        elif key == "battery_level":
            low = float(value) < self._robot.config.battery_limit
            if low and not self._battery_is_low:
                self.times.begin(U3, stamp)
            self._battery_is_low = low
            if low:
                self.times.drop(U2)
        elif key == "water_visibility" and self._robot.search.active and not self._battery_is_low:
            if self._robot.search.altitude != self._expected_altitude(float(value)):
                self.times.begin(U2, stamp)
            else:
                self.times.drop(U2)

    def _expected_altitude(self, visibility: float) -> float:
        config = self._robot.config
        pairs = zip(config.water_visibility_threshold, config.expected_altitude, strict=True)
        return next((altitude for limit, altitude in pairs if visibility >= limit), config.expected_altitude[-1])

    def _on_event(self, event: RobotEvent) -> None:
        if event.kind is SuaveEvent.PIPELINE_FOUND:
            self._found_at = self._robot.mission_time()
        elif event.kind in (SuaveEvent.TIME_LIMIT, SuaveEvent.PIPELINE_INSPECTED) and self._ended_at is None:
            self._ended_at = self._robot.mission_time()
        elif event.subject == "f_maintain_motion_node" and event.kind is NodeChange.ACTIVATED:
            self.times.end(U1, event.time)
        elif event.subject == "generate_recharge_path_node" and event.kind is NodeChange.ACTIVATED:
            self.times.end(U3, event.time)
        elif event.subject == "f_generate_search_path_node":
            self._search_changed(event)

    def _search_changed(self, event: RobotEvent) -> None:
        if event.kind is NodeChange.DEACTIVATED:
            self.times.drop(U2)
        elif event.kind is NodeChange.PARAMETERS and self._is_at_expected_altitude():
            self.times.end(U2, event.time)

    def _is_at_expected_altitude(self) -> bool:
        return self._robot.search.altitude == self._expected_altitude(self._robot.visibility())
