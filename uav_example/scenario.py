"""The scenario ``uav``."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING

from rosa_simulation.plans import check_planning, why_given_up
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import Observer, Parameter, RunRequest, choose
from uav_example.parameters import PARAMETERS, world_parameters
from uav_example.world.parameters import WorldParameters

if TYPE_CHECKING:
    from rosa_evaluation.report import ReportSpec
    from rosa_simulation.metric import Metric
    from task_layer.bt import Registry, TreeRunner
    from task_layer.pddl import PlanExecutor
    from uav_example.managers.manager import ManagedMission, Manager
    from uav_example.robot import UavRobot

_COLUMNS = ("x_m", "y_m", "z_m", "battery_level")
_WAKING = (
    "sample found",
    "sample analysed",
    "area searched",
    "gripper folded",
    "charged",
    "battery empty",
    "time limit",
)


@dataclasses.dataclass(frozen=True, slots=True)
class UavScenario:
    """The UAV's mission, as the command line runs it."""

    name: str = "uav"
    description: str = "search an area for samples and analyse them, also when the gripper fails"
    managers: tuple[str, ...] = ("rosa", "none")
    task_layers: tuple[str, ...] = ("bt", "pddl")

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """The numbers of the world."""
        return PARAMETERS

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What a run measures."""
        from uav_example.metrics import METRICS

        return METRICS

    def mission_leaves(self) -> Registry:
        """The leaves that a mission file may name."""
        import numpy as np

        from rosa_core.clock import SimulationClock
        from uav_example.missions.leaves import conditions
        from uav_example.robot import UavRobot
        from uav_example.skills import make_skills
        from uav_example.world.world import World

        robot = UavRobot(World(SimulationClock(), WorldParameters(), np.random.default_rng(0)))
        leaves = conditions(robot)
        for action, skill in make_skills(robot).items():
            leaves.add(action, skill)
        return leaves

    def report_spec(self) -> ReportSpec:
        """How runs are shown in a report."""
        from rosa_evaluation.report import ReportSpec
        from uav_example.drawing import draw_flight

        return ReportSpec(draw=draw_flight)

    def check(self, request: RunRequest) -> None:
        """That there are such a manager, task layer and parameters, and that these go together."""
        self._prepare(request)

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Fly the mission until the aircraft is back home and has landed, or to its time limit."""
        return self._fly(request, self._prepare(request), observer)

    def _prepare(self, request: RunRequest) -> WorldParameters:
        choose("manager", request.manager, self.managers)
        choose("task layer", request.task_layer, self.task_layers)
        check_planning(request)
        return world_parameters(request)

    def _fly(self, request: RunRequest, parameters: WorldParameters, observer: Observer) -> RunRecord:
        # What a flight needs is imported here, so that listing the scenarios does not load it.
        import numpy as np

        from rosa_core.clock import SimulationClock
        from rosa_simulation.run_recorder import RunRecorder
        from task_layer.bt import TreeRunner
        from uav_example.managers.manager import ManagedMission
        from uav_example.metrics import MissionMetrics
        from uav_example.missions import TREE_FILE
        from uav_example.robot import UavRobot
        from uav_example.skills import make_skills
        from uav_example.story import UavStory
        from uav_example.world.world import World

        clock = SimulationClock()
        recorder = RunRecorder(observer, clock, lasting=2.0 * parameters.service_time)
        world = World(clock, parameters, np.random.default_rng(request.seed))
        robot = UavRobot(world)
        UavStory(robot, recorder.narrator)
        metrics = MissionMetrics(robot, recorder.stopwatch)
        observer.started(parameters.time_limit)
        mission = ManagedMission(robot, make_skills(robot), recorder, request.mission or TREE_FILE)
        with _runner(request, mission) as runner:
            robot.on_event.append(lambda event: runner.wake() if event.what in _WAKING else None)
            recorder.sample(_COLUMNS, lambda: (*world.aircraft.position, world.battery.level))
            if isinstance(runner, TreeRunner):
                observer.tree(runner)
            ended = runner.run(until=lambda: robot.over)
        recorder.close()
        gave_up = why_given_up(runner, ended)
        return recorder.record(
            self.name,
            request,
            completed=not gave_up,
            ended_by=gave_up or _ended_by(robot, ended),
            inputs={
                "world": dataclasses.asdict(parameters),
                "samples": [dataclasses.asdict(sample) for sample in world.samples],
            },
            metrics=metrics.summary(),
            reactions=metrics.times.reactions,
        )


def _ended_by(robot: UavRobot, ended: object) -> str:
    from py_trees.common import Status

    if robot.world.battery.level <= 0.0:
        return "battery empty"
    if robot.over:
        return "time limit"
    return "mission failed" if ended is Status.FAILURE else "mission done"


def _runner(request: RunRequest, mission: ManagedMission) -> TreeRunner | PlanExecutor:
    if request.task_layer == "bt":
        return _manager(request.manager)(mission)
    from uav_example.managers.rosa_pddl import MissionFiles, rosa_plan

    return rosa_plan(mission, MissionFiles(request.domain, request.problem))


def _manager(name: str) -> Manager:
    from uav_example.managers.none import no_manager
    from uav_example.managers.rosa import rosa_tree

    managers: Mapping[str, Manager] = {"rosa": rosa_tree, "none": no_manager}
    return managers[name]


UAV = UavScenario()
