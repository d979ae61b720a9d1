"""What a mission achieved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from pioneer_example.events import PioneerEvent
from pioneer_example.models import DRIVE
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event, ReconfigurationPlanEnded, Result
from rosa_reflexes import Answer
from rosa_simulation.metric import MEAN_REACTION_TIME, Better, Metric, MetricKind
from rosa_simulation.preemptions import OSCILLATION, Preemptions
from rosa_simulation.reaction_times import ReactionTimes
from rosa_simulation.robot_event import NodeChange, RobotEvent

if TYPE_CHECKING:
    from pioneer_example.robot import PioneerRobot

SONAR = "sonar"
METRICS = (
    Metric("reached_goal", "", "whether the origin was reached", MetricKind.TRUTH, Better.MORE),
    Metric("time_s", "s", "how long the mission took", MetricKind.DURATION, Better.LESS),
    Metric("path_length_m", "m", "distance driven", MetricKind.DISTANCE, Better.LESS),
    Metric("path_ratio", "", "distance driven over the straight line to the origin", MetricKind.NUMBER, Better.LESS),
    Metric("collisions", "", "how often the robot began to touch something", MetricKind.COUNT, Better.LESS),
    Metric(
        "least_clearance_m", "m", "least distance from the robot's edge to anything", MetricKind.DISTANCE, Better.MORE
    ),
    Metric("distance_left_m", "m", "distance to the origin in the end", MetricKind.DISTANCE, Better.LESS),
    Metric("route_switches", "", "changes between the two routes", MetricKind.COUNT, Better.NEITHER),
    Metric("oscillations", "", "changes within a second of the one before", MetricKind.COUNT, Better.LESS),
    Metric("preemptions", "", "how often a reflex took the command", MetricKind.COUNT, Better.NEITHER),
    Metric("refused_commands", "", "commands of deliberation that the gate refused", MetricKind.COUNT, Better.NEITHER),
    Metric("actions", "", "actions and commands that were begun", MetricKind.COUNT, Better.NEITHER),
    Metric("adaptations", "", "reconfigurations that were completed", MetricKind.COUNT, Better.NEITHER),
    MEAN_REACTION_TIME,
)


class MissionMetrics:
    """Observes the robot. Reaction time: from the failure of the sonar ring to the drive's next parameters.

    Args:
        robot: what is observed.
        preemptions: of its gate.
        stopwatch: runs while the managing system does.
    """

    def __init__(self, robot: PioneerRobot, preemptions: Preemptions, stopwatch: Stopwatch) -> None:
        self._robot, self._preemptions = robot, preemptions
        self._straight = math.hypot(*robot.pose[:2])
        self._adaptations = self._switches = self._oscillations = 0
        self._switched_at = -math.inf
        self.times = ReactionTimes((SONAR,), stopwatch)
        robot.on_event.append(self._on_event)

    def on_kb_event(self, event: Event) -> None:
        """Count the reconfigurations."""
        self._adaptations += isinstance(event, ReconfigurationPlanEnded) and event.result is Result.COMPLETED

    def summary(self, duration: float) -> Mapping[str, Any]:
        """The metrics by name, from the mission's duration in s."""
        robot, preemptions = self._robot, self._preemptions
        refused = robot.gate.refusals
        return {
            "reached_goal": robot.reached,
            "time_s": round(duration, 6),
            "path_length_m": round(robot.path_length, 6),
            "path_ratio": round(robot.path_length / self._straight, 6) if robot.reached else None,
            "collisions": robot.collisions,
            "least_clearance_m": round(max(robot.least_clearance, 0.0), 6) if duration > 0.0 else None,
            "distance_left_m": round(robot.distance_to_origin, 6),
            "route_switches": preemptions.switches + self._switches,
            "oscillations": preemptions.oscillations + self._oscillations,
            "preemptions": preemptions.number,
            "refused_commands": refused[Answer.STALE] + refused[Answer.PREEMPTED],
            "actions": robot.actions,
            "adaptations": self._adaptations,
            MEAN_REACTION_TIME.name: self.times.means(),
        }

    def _on_event(self, event: RobotEvent) -> None:
        if event.kind is PioneerEvent.SONAR_FAILED:
            self.times.begin(SONAR, event.time)
        elif event.kind is NodeChange.PARAMETERS and event.subject == DRIVE:
            self.times.end(SONAR, event.time)
        elif event.kind is PioneerEvent.ROUTE:
            self._switches += 1
            self._oscillations += event.time - self._switched_at < OSCILLATION
            self._switched_at = event.time
