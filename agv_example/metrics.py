"""What a mission achieved, and how fast its managing system reacted."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any

from agv_example.events import AgvEvent
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event, ReconfigurationPlanEnded, Result
from rosa_simulation.metric import MEAN_REACTION_TIME, Better, Metric, MetricKind
from rosa_simulation.reaction_times import ReactionTimes
from rosa_simulation.robot_event import RobotEvent

if TYPE_CHECKING:
    from agv_example.navigator import RouteDecision
    from agv_example.world import AgvRobot

COMPONENT, CORRIDOR = "component", "corridor"
_CAUSES: Mapping[Enum, str] = {
    AgvEvent.COMPONENT_FAILED: COMPONENT,
    AgvEvent.CORRIDOR_CLOSED: CORRIDOR,
    AgvEvent.LIGHT_CHANGED: CORRIDOR,
}
METRICS = (
    Metric("goals_reached", "", "goals that were reached", MetricKind.COUNT, Better.MORE),
    Metric("goals", "", "goals that there were", MetricKind.COUNT, Better.NEITHER),
    Metric("time_s", "s", "how long the mission took", MetricKind.DURATION, Better.LESS),
    Metric("distance_m", "m", "distance driven", MetricKind.DISTANCE, Better.LESS),
    Metric("energy", "", "energy in units of draw times second", MetricKind.NUMBER, Better.LESS),
    Metric("battery_level", "", "charge that was left in the end", MetricKind.SHARE, Better.MORE),
    Metric("risk", "", "expected number of collisions", MetricKind.NUMBER, Better.LESS),
    Metric("collisions", "", "collisions that there were", MetricKind.COUNT, Better.LESS),
    Metric("routes", "", "routes that were decided on", MetricKind.COUNT, Better.NEITHER),
    Metric("adaptations", "", "reconfigurations that were completed", MetricKind.COUNT, Better.NEITHER),
    MEAN_REACTION_TIME,
)


class MissionMetrics:
    """Observes the robot.

    Reaction times: from the failure of a component, or from the change of a corridor, to the time at which the
    robot is configured for, and sets out on, another route than before. Where the route stays as it was there is
    nothing to react to. The delay is simulated time, the compute part the wall-clock time that the managing system
    took until it had decided.

    Args:
        robot: must not have a managing system yet, as reactions are timed from its own events.
        stopwatch: the wall-clock time that managing systems have taken.
    """

    def __init__(self, robot: AgvRobot, stopwatch: Stopwatch) -> None:
        self._robot = robot
        self._adaptations = 0
        self._routes = 0
        self.times = ReactionTimes((COMPONENT, CORRIDOR), stopwatch)
        # Before any managing system subscribes: its reaction is timed from here.
        robot.on_event.append(self._on_event)

    def on_kb_event(self, event: Event) -> None:
        """Count the reconfigurations."""
        self._adaptations += isinstance(event, ReconfigurationPlanEnded) and event.result is Result.COMPLETED

    def on_route(self, decision: RouteDecision) -> None:
        """A route was decided on."""
        self._routes += decision.route is not None

    def summary(self, *, goals: int, duration: float) -> dict[str, Any]:
        """The metrics by name; energy in units of draw times second, risk in expected collisions.

        Args:
            goals: how many there were to reach.
            duration: the time that the mission took, s.
        """
        robot = self._robot
        return {
            "goals_reached": len(robot.reached),
            "goals": goals,
            "time_s": round(duration, 6),
            "distance_m": round(robot.distance, 6),
            "energy": round(robot.energy, 6),
            "battery_level": round(robot.battery_level, 6),
            "risk": round(robot.collisions.risk, 6),
            "collisions": robot.collisions.number,
            "routes": self._routes,
            "adaptations": self._adaptations,
            MEAN_REACTION_TIME.name: self.times.means(),
        }

    def _on_event(self, event: RobotEvent) -> None:
        kind = _CAUSES.get(event.kind)
        if kind is not None:
            self.times.begin(kind, event.time)
        elif event.kind is AgvEvent.DRIVING:
            for name in (COMPONENT, CORRIDOR):
                self.times.end(name, max(event.time, self._robot.ready_at))
        elif event.kind is AgvEvent.ARRIVED:
            # The next corridor was to be driven anyway.
            for name in (COMPONENT, CORRIDOR):
                self.times.drop(name)
