"""The scenarios ``suave`` and ``suave-extended``."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.plans import check_planning, why_given_up
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import Observer, Parameter, RunRequest, SilentObserver, choose
from suave.managers.registry import EXTENDED, PLAIN, load_manager, manager_names
from suave.mission_config import MissionConfig, load_mission_config
from suave.parameters import PARAMETERS, with_parameters
from suave.world.parameters import WorldParameters

if TYPE_CHECKING:
    from rosa_evaluation.report import ReportSpec
    from rosa_simulation.metric import Metric
    from suave.managers.manager import ManagedMission
    from suave.robot import SuaveRobot
    from task_layer.bt import Registry, TreeRunner
    from task_layer.pddl import PlanExecutor, PlanRecord

_COLUMNS = ("x_m", "y_m", "z_m", "yaw_rad", "visibility_m", "battery_level")


@dataclass(frozen=True, slots=True)
class SuaveScenario:
    """One of the two SUAVE missions, as the command line runs it."""

    name: str
    description: str
    extended: bool
    task_layers: tuple[str, ...] = ("bt", "pddl")
    films: bool = True

    @property
    def managers(self) -> tuple[str, ...]:
        """The managing systems that are there for this mission."""
        return manager_names(self._manager_group)

    @property
    def _manager_group(self) -> str:
        return EXTENDED if self.extended else PLAIN

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """The fields of a mission configuration, and where the vehicle starts."""
        return PARAMETERS

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What a run measures."""
        from suave.metrics import METRICS

        return METRICS

    def mission_leaves(self) -> Registry:
        """The leaves that a mission file may name."""
        import numpy as np

        from rosa_core.clock import SimulationClock
        from suave.missions.leaves import mission_leaves
        from suave.robot import SuaveRobot
        from suave.skills import make_skills

        robot = SuaveRobot(SimulationClock(), MissionConfig(), np.random.default_rng(0), with_battery=self.extended)
        leaves = mission_leaves(robot)
        for action, skill in make_skills(robot).items():
            leaves.add(action, skill)
        return leaves

    def report_spec(self) -> ReportSpec:
        """How runs are shown in a report."""
        from suave.report_spec import report_spec

        return report_spec(extended=self.extended)

    def check(self, request: RunRequest) -> None:
        """That there are such a manager, task layer and parameters, and that these go together."""
        self._prepare(request, SilentObserver())

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Fly the mission from GUIDED to its time limit, or until the pipeline is inspected."""
        config, world = self._prepare(request, observer)
        if request.video is None:
            return self._fly(request, config, world, observer)
        from suave.film import film, prepare_film

        prepare_film(request.video)
        record = self._fly(request, config, world, observer)
        film(record, request.video)
        return record

    def _prepare(self, request: RunRequest, observer: Observer) -> tuple[MissionConfig, WorldParameters]:
        choose("manager", request.manager, self.managers)
        choose("task layer", request.task_layer, self.task_layers)
        check_planning(request)
        if request.mission is not None and request.manager == "bt":
            what = "the manager 'bt' has a tree of its own, in which mission and adaptation are one"
            raise InputError(Problem(what, hint="leave --mission out, or fly it with another manager"))
        config = MissionConfig()
        if request.mission_config is not None:
            config, ignored = load_mission_config(request.mission_config)
            for text in ignored:
                observer.warning(text)
        if request.time_limit is not None:
            config = dataclasses.replace(config, time_limit=request.time_limit)
        return with_parameters(config, request.parameters)

    def _fly(self, request: RunRequest, config: MissionConfig, world: WorldParameters, observer: Observer) -> RunRecord:
        # Physics is imported here, so that listing the scenarios does not load it.
        import numpy as np

        from rosa_core.clock import SimulationClock
        from rosa_simulation.run_recorder import RunRecorder
        from suave.managers.manager import ManagedMission
        from suave.metrics import MissionMetrics
        from suave.missions import tree_file
        from suave.narrator import SuaveStory
        from suave.robot import SuaveRobot
        from suave.skills import StartRobot, make_skills
        from task_layer.bt import TreeRunner

        clock = SimulationClock()
        rng = np.random.default_rng(request.seed)
        robot = SuaveRobot(clock, config, rng, with_battery=self.extended, parameters=world)
        lasting = 2.0 * world.service_time

        def began() -> float:
            return clock.now() if robot.guided_at is None else robot.guided_at

        recorder = RunRecorder(observer, clock, lasting=lasting, began=began)
        SuaveStory(robot, recorder.narrator)
        metrics = MissionMetrics(robot, recorder.stopwatch)

        def seen() -> tuple[float, ...]:
            level = 1.0 if robot.battery is None else robot.battery.level(clock.now())
            return (*robot.vehicle.position, robot.vehicle.yaw, robot.visibility(), level)

        mission = ManagedMission(
            robot=robot,
            extended=self.extended,
            tree_file=request.mission or tree_file(extended=self.extended),
            skills={**make_skills(robot), "start_robot": StartRobot(robot)},
            stopwatch=recorder.stopwatch,
            on_kb_event=recorder.narrator.on_kb_event,
            on_raise=recorder.on_raise,
            # The world's draws stay the same whoever manages the robot.
            rng=np.random.default_rng((request.seed, 1)),
        )
        observer.started(config.time_limit)
        with self._runner(request, mission, recorder.on_plan) as runner:
            if isinstance(runner, TreeRunner):
                observer.tree(runner)
            robot.on_event.append(lambda event: runner.wake() if event.what in _WAKING else None)
            recorder.sample(_COLUMNS, seen)
            ended = runner.run(until=lambda: robot.over, timeout=config.time_limit + _START_LIMIT)
        recorder.close()
        gave_up = why_given_up(runner, ended)
        return recorder.record(
            self.name,
            request,
            duration=metrics.duration,
            completed=not gave_up,
            ended_by=gave_up or _ended_by(robot, ended),
            inputs={"mission": dataclasses.asdict(config), "world": dataclasses.asdict(world)},
            metrics=metrics.summary(),
            reactions=metrics.times.reactions,
        )

    def _runner(
        self, request: RunRequest, mission: ManagedMission, on_plan: Callable[[PlanRecord], None]
    ) -> TreeRunner | PlanExecutor:
        if request.task_layer == "bt":
            return load_manager(self._manager_group, request.manager)(mission)
        from suave.managers.rosa_pddl import MissionFiles, rosa_pddl_manager

        return rosa_pddl_manager(mission, MissionFiles(request.domain, request.problem), on_plan)


_WAKING = ("pipeline found", "pipeline inspected", "recharged", "time limit")
_START_LIMIT = 60.0
"""How long a mission may take until it sets the mode GUIDED, in s."""


def _ended_by(robot: SuaveRobot, ended: object) -> str:
    from py_trees.common import Status

    if robot.pipeline_inspected:
        return "pipeline inspected"
    if robot.over:
        return "time limit"
    if robot.guided_at is None:
        return "never in mode GUIDED"
    return "mission failed" if ended is Status.FAILURE else "mission done"


SUAVE = SuaveScenario("suave", "search for a pipeline and inspect it, with failing thrusters and murky water", False)
SUAVE_EXTENDED = SuaveScenario("suave-extended", "the same with a battery that runs low and must be recharged", True)
