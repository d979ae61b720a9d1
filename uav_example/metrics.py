"""What a mission achieved, and how fast its managing system reacted."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosa_core.clock import Stopwatch
from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.metric import MEAN_REACTION_TIME, Better, Metric, MetricKind
from rosa_simulation.reaction_times import ReactionTimes
from rosa_simulation.robot_event import NodeChange, RobotEvent
from uav_example import monitors, nodes
from uav_example.events import UavEvent
from uav_example.world.area import Analysis

if TYPE_CHECKING:
    from uav_example.robot import UavRobot

U1, U2, U3 = "U1", "U2", "U3"
METRICS = (
    Metric("samples", "", "samples in the area", MetricKind.COUNT, Better.NEITHER),
    Metric("samples_found", "", "samples that were found", MetricKind.COUNT, Better.MORE),
    Metric("samples_picked_up", "", "samples that were picked up to be analysed", MetricKind.COUNT, Better.MORE),
    Metric("samples_in_situ", "", "samples that were analysed where they lay", MetricKind.COUNT, Better.MORE),
    Metric("area_searched", "", "share of the area that was searched", MetricKind.SHARE, Better.MORE),
    Metric("energy_used", "", "energy in charges of a full battery", MetricKind.NUMBER, Better.LESS),
    Metric("recharges", "", "how often the battery was charged", MetricKind.COUNT, Better.NEITHER),
    Metric("gripper_failed", "", "whether the gripper failed", MetricKind.TRUTH, Better.NEITHER),
    Metric("adaptations", "", "reactions to an uncertainty", MetricKind.COUNT, Better.NEITHER),
    MEAN_REACTION_TIME,
)
SEARCH_LIMIT = 0.25
ANALYZE_LIMIT = 0.5
_REPLACING_ANALYZE = (nodes.LAND_PATH, nodes.ANALYZE_PATH)


class MissionMetrics:
    """Observes the robot.

    Reaction times, one for each adaptation scenario of the ROSA paper (section 7.4.2): U1 from the first battery level
    too low to search, while searching, to the home path node active; U2 from a battery level too low to analyse, with
    a gripper that works, to the node active that begins what is done instead (landing, if the analysis was
    interrupted, or analysing on site); U3 from the gripper's failure to the same. The delay is simulated time, the
    compute part the wall-clock time that the manager spent on it until it made the call.

    Args:
        robot: must not have a managing system yet, as reactions are timed from its own diagnostics.
        stopwatch: the wall-clock time that managing systems have taken.
    """

    def __init__(self, robot: UavRobot, stopwatch: Stopwatch) -> None:
        self._robot = robot
        self._level = robot.world.battery.level
        self._recharges = 0
        self.times = ReactionTimes((U1, U2, U3), stopwatch)
        robot.on_event.append(self._on_event)
        robot.on_call.append(self._on_call)
        # Before any managing system subscribes: its reaction is timed from here.
        robot.on_diagnostics.append(self._on_diagnostics)

    def summary(self) -> dict[str, Any]:
        """What was achieved; energy in charges of a full battery."""
        world, analyses = self._robot.world, list(self._robot.world.analyses.values())
        return {
            "samples": len(world.samples),
            "samples_found": len(world.found),
            "samples_picked_up": analyses.count(Analysis.PICKED_UP),
            "samples_in_situ": analyses.count(Analysis.IN_SITU),
            "area_searched": round(self._robot.search.share, 6),
            "energy_used": round(world.battery.used, 6),
            "recharges": self._recharges,
            "gripper_failed": not world.gripper.works,
            "adaptations": sum(map(len, self.times.reactions.values())),
            MEAN_REACTION_TIME.name: self.times.means(),
        }

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        stamp, active = array["header"]["stamp"], self._robot.nodes
        for key, value, _ in values_of(array):
            if key == monitors.GRIPPER and active[nodes.PICK_PATH].active:
                self.times.begin(U3, stamp)
            elif key == monitors.BATTERY_LEVEL:
                self._level = float(value)
                if self._level < SEARCH_LIMIT and active[nodes.SEARCH_PATH].active:
                    self.times.begin(U1, stamp)
                if active[nodes.PICK_PATH].active:
                    self._battery_may_be_low(stamp)

    def _battery_may_be_low(self, stamp: float) -> None:
        world = self._robot.world
        if self._level < ANALYZE_LIMIT and world.waiting is not None and world.gripper.works:
            self.times.begin(U2, stamp)

    def _on_call(self, component: str) -> None:
        """The managing system calls a component: its deciding is over, what follows is delay."""
        if component == nodes.HOME_PATH:
            self.times.decide(U1)
        elif component in _REPLACING_ANALYZE:
            self.times.decide(U2)
            self.times.decide(U3)

    def _on_event(self, event: RobotEvent) -> None:
        activated = event.subject if event.kind is NodeChange.ACTIVATED else ""
        if event.kind is UavEvent.SAMPLE_FOUND:
            self._battery_may_be_low(event.time)
        elif event.kind is UavEvent.CHARGED:
            self._recharges += 1
        elif activated == nodes.HOME_PATH:
            self.times.end(U1, event.time)
        elif activated in _REPLACING_ANALYZE:
            self.times.end(U2, event.time)
            self.times.end(U3, event.time)
        elif event.kind is UavEvent.SAMPLE_ANALYSED:
            self.times.drop(U2)
            self.times.drop(U3)
