"""The scenario ``uav``."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from rosa_evaluation.plans import check_planning, plan_made, why_given_up
from rosa_evaluation.run_record import MissionEvent, PlanMade, RunRecord, raised_event
from rosa_evaluation.scenario import Observer, Parameter, RunRequest, choose
from uav_example.parameters import PARAMETERS, world_parameters
from uav_example.world.parameters import WorldParameters

if TYPE_CHECKING:
    from task_layer.bt import TreeRunner
    from task_layer.pddl import PlanExecutor, PlanRecord
    from uav_example.managers.manager import ManagedMission, Manager
    from uav_example.robot import UavRobot

_SAMPLE_PERIOD = 1.0
_COLUMNS = ("time_s", "x_m", "y_m", "z_m", "battery_level")
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

        from rosa_core.clock import SimulationClock, Stopwatch
        from rosa_evaluation.narrator import Narrator
        from uav_example.managers.manager import ManagedMission
        from uav_example.metrics import MissionMetrics
        from uav_example.robot import UavRobot
        from uav_example.skills import make_skills
        from uav_example.story import UavStory
        from uav_example.world.world import World

        began = time.perf_counter()
        clock, stopwatch = SimulationClock(), Stopwatch()
        world = World(clock, parameters, np.random.default_rng(request.seed))
        robot = UavRobot(world)
        events: list[MissionEvent] = []
        trajectory: list[tuple[float, ...]] = []

        def tell(event: MissionEvent) -> None:
            events.append(event)
            observer.event(event)

        def sample() -> None:
            trajectory.append((clock.now(), *world.aircraft.position, world.battery.level))
            observer.progress(clock.now())

        narrator = Narrator(clock, tell, lasting=2.0 * parameters.service_time)
        UavStory(robot, narrator)
        metrics = MissionMetrics(robot, stopwatch)
        mission = ManagedMission(
            robot=robot,
            skills=make_skills(robot),
            stopwatch=stopwatch,
            on_kb_event=narrator.on_kb_event,
            on_raise=lambda behaviour, error: tell(raised_event(clock.now(), behaviour.name, error)),
        )
        plans: list[PlanMade] = []

        def on_plan(record: PlanRecord) -> None:
            narrator.on_plan(record)
            plans.append(plan_made(record, clock.now()))

        observer.started(parameters.time_limit)
        with _runner(request, mission, on_plan) as runner:
            robot.on_event.append(lambda event: runner.wake() if event.what in _WAKING else None)
            clock.call_every(_SAMPLE_PERIOD, sample, start=0.0)
            ended = runner.run(until=lambda: robot.over)
        duration = clock.now()
        clock.advance_to(duration + 0.1)
        narrator.close()
        gave_up = why_given_up(runner, ended)
        return RunRecord(
            scenario=self.name,
            manager=request.manager,
            task_layer=request.task_layer,
            seed=request.seed,
            completed=not gave_up,
            ended_by=gave_up or _ended_by(robot, ended),
            duration_s=round(duration, 6),
            inputs={
                "world": dataclasses.asdict(parameters),
                "samples": [dataclasses.asdict(sample) for sample in world.samples],
            },
            metrics=metrics.summary(),
            reactions={name: tuple(reactions) for name, reactions in metrics.times.reactions.items()},
            events=tuple(events),
            trajectory_columns=_COLUMNS,
            trajectory=tuple(trajectory),
            wall_clock_s=time.perf_counter() - began,
            managing_s=stopwatch.elapsed(),
            plans=tuple(plans),
        )


def _ended_by(robot: UavRobot, ended: object) -> str:
    from py_trees.common import Status

    if robot.world.battery.level <= 0.0:
        return "battery empty"
    if robot.over:
        return "time limit"
    return "mission failed" if ended is Status.FAILURE else "mission done"


def _runner(
    request: RunRequest, mission: ManagedMission, on_plan: Callable[[PlanRecord], None]
) -> TreeRunner | PlanExecutor:
    if request.task_layer == "bt":
        return _manager(request.manager)(mission)
    from uav_example.managers.rosa_pddl import MissionFiles, rosa_plan

    return rosa_plan(mission, MissionFiles(request.domain, request.problem), on_plan)


def _manager(name: str) -> Manager:
    from uav_example.managers.none import no_manager
    from uav_example.managers.rosa import rosa_tree

    managers: Mapping[str, Manager] = {"rosa": rosa_tree, "none": no_manager}
    return managers[name]


UAV = UavScenario()
