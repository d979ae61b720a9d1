"""What a mission achieved, and how fast its managing system reacted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from agv_example.navigator import RouteDecision
from agv_example.world import AgvRobot, RobotEvent
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event, ReconfigurationPlanEnded, Result
from rosa_evaluation.run_record import Reaction

COMPONENT, CORRIDOR = "component", "corridor"
_CAUSES = {
    "component failed": COMPONENT,
    "corridor closed": CORRIDOR,
    "light changed": CORRIDOR,
}


@dataclass(slots=True)
class _Cause:
    time: float
    elapsed: float


class MissionMetrics:
    """Observes the robot.

    Reaction times: from the failure of a component, or from the change of a corridor, to the moment at which the
    robot is configured for, and sets out on, another route than before. Where the route stays as it was there is
    nothing to react to. The delay is simulated time, the compute part the wall-clock time that the managing system
    took until it had decided.
    """

    def __init__(self, robot: AgvRobot, stopwatch: Stopwatch, goals: int) -> None:
        self._robot = robot
        self._stopwatch = stopwatch
        self._goals = goals
        self._open: dict[str, _Cause] = {}
        self._began = robot.clock.now()
        self._ended: float | None = None
        self._adaptations = 0
        self._routes = 0
        self.reactions: dict[str, list[Reaction]] = {COMPONENT: [], CORRIDOR: []}
        # Before any managing system subscribes: its reaction is timed from here.
        robot.on_event.append(self._on_event)

    def on_kb_event(self, event: Event) -> None:
        """Count the reconfigurations."""
        self._adaptations += isinstance(event, ReconfigurationPlanEnded) and event.result is Result.COMPLETED

    def on_route(self, decision: RouteDecision) -> None:
        """A route was decided on."""
        self._routes += decision.route is not None

    @property
    def duration(self) -> float:
        """Mission time, s."""
        return (self._robot.clock.now() if self._ended is None else self._ended) - self._began

    def summary(self) -> dict[str, Any]:
        """The metrics by name; energy in units of draw times second, risk in expected collisions."""
        robot = self._robot
        return {
            "goals_reached": len(robot.reached),
            "goals": self._goals,
            "time_s": round(self.duration, 6),
            "distance_m": round(robot.distance, 6),
            "energy": round(robot.energy, 6),
            "battery_level": round(robot.battery_level, 6),
            "risk": round(robot.collisions.risk, 6),
            "collisions": robot.collisions.number,
            "routes": self._routes,
            "adaptations": self._adaptations,
            "mean_reaction_time_s": {
                name: sum(r.total_s for r in reactions) / len(reactions) if reactions else None
                for name, reactions in self.reactions.items()
            },
        }

    def _on_event(self, event: RobotEvent) -> None:
        kind = _CAUSES.get(event.what)
        if kind is not None:
            self._open.setdefault(kind, _Cause(event.time, self._stopwatch.elapsed()))
        elif event.what == "driving":
            for name, cause in self._open.items():
                delay = max(event.time, self._robot.ready_at) - cause.time
                self.reactions[name].append(Reaction(cause.time, delay, self._stopwatch.elapsed() - cause.elapsed))
            self._open.clear()
        elif event.what == "arrived":
            # The next corridor was to be driven anyway.
            self._open.clear()
        elif event.what in ("goal reached", "time limit"):
            done = len(self._robot.reached) >= self._goals or event.what == "time limit"
            if done and self._ended is None:
                self._ended = event.time
