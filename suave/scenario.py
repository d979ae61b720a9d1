"""The scenarios ``suave`` and ``suave-extended``."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosa_evaluation.run_record import MissionEvent, RunRecord, raised_event
from rosa_evaluation.scenario import Observer, Parameter, RunRequest, SilentObserver, choose
from suave.mission_config import MissionConfig, load_mission_config
from suave.parameters import PARAMETERS, with_parameters
from suave.world.parameters import WorldParameters

if TYPE_CHECKING:
    from suave.managers.manager import Manager

_SAMPLE_PERIOD = 1.0
_COLUMNS = ("time_s", "x_m", "y_m", "z_m", "yaw_rad", "visibility_m", "battery_level")


@dataclass(frozen=True, slots=True)
class SuaveScenario:
    """One of the two SUAVE missions, as the command line runs it."""

    name: str
    description: str
    extended: bool
    managers: tuple[str, ...] = ("rosa", "none")
    task_layers: tuple[str, ...] = ("bt",)

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """The fields of a mission configuration, and where the vehicle starts."""
        return PARAMETERS

    def check(self, request: RunRequest) -> None:
        """That there are such a manager, task layer and parameters, and that these go together."""
        self._prepare(request, SilentObserver())

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Fly the mission from GUIDED to its time limit, or until the pipeline is inspected."""
        config, world = self._prepare(request, observer)
        return self._fly(request, config, world, observer)

    def _prepare(self, request: RunRequest, observer: Observer) -> tuple[MissionConfig, WorldParameters]:
        choose("manager", request.manager, self.managers)
        choose("task layer", request.task_layer, self.task_layers)
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

        from rosa_core.clock import SimulationClock, Stopwatch
        from suave.managers.manager import ManagedMission
        from suave.metrics import MissionMetrics
        from suave.missions.trees import extended_mission, plain_mission
        from suave.narrator import Narrator
        from suave.robot import SuaveRobot
        from suave.skills import InspectPipeline, Recharge, SearchPipeline

        began = time.perf_counter()
        clock, stopwatch = SimulationClock(), Stopwatch()
        rng = np.random.default_rng(request.seed)
        robot = SuaveRobot(clock, config, rng, with_battery=self.extended, parameters=world)
        events: list[MissionEvent] = []

        def tell(event: MissionEvent) -> None:
            events.append(event)
            observer.event(event)

        narrator = Narrator(robot, tell)
        metrics = MissionMetrics(robot, stopwatch)
        trajectory: list[tuple[float, ...]] = []

        def sample() -> None:
            level = 1.0 if robot.battery is None else robot.battery.level(clock.now())
            now = robot.mission_time()
            trajectory.append((now, *robot.vehicle.position, robot.vehicle.yaw, robot.visibility(), level))
            observer.progress(now)

        skills = {"search_pipeline": SearchPipeline(robot), "inspect_pipeline": InspectPipeline(robot)}
        mission = ManagedMission(
            robot=robot,
            extended=self.extended,
            make_tree=extended_mission if self.extended else plain_mission,
            skills={**skills, "recharge": Recharge(robot)},
            stopwatch=stopwatch,
            on_kb_event=narrator.on_kb_event,
            on_raise=lambda behaviour, error: tell(raised_event(robot.mission_time(), behaviour.name, error)),
        )
        observer.started(config.time_limit)
        with _manager(request.manager)(mission) as runner:
            observer.tree(runner)
            robot.on_event.append(lambda event: runner.wake() if event.what in _WAKING else None)
            clock.call_every(_SAMPLE_PERIOD, sample, start=0.0)
            runner.run(until=lambda: robot.over)
        clock.advance_to(clock.now() + 0.1)
        narrator.close()
        summary = metrics.summary()
        return RunRecord(
            scenario=self.name,
            manager=request.manager,
            task_layer=request.task_layer,
            seed=request.seed,
            completed=True,
            ended_by="pipeline inspected" if robot.pipeline_inspected else "time limit",
            duration_s=round(metrics.duration, 6),
            inputs={"mission": dataclasses.asdict(config), "world": dataclasses.asdict(world)},
            metrics=summary,
            reactions={name: tuple(reactions) for name, reactions in metrics.reactions.items()},
            events=tuple(events),
            trajectory_columns=_COLUMNS,
            trajectory=tuple(trajectory),
            wall_clock_s=time.perf_counter() - began,
            managing_s=stopwatch.elapsed(),
        )


_WAKING = ("pipeline found", "pipeline inspected", "recharged", "time limit")


def _manager(name: str) -> Manager:
    from suave.managers.none import no_manager
    from suave.managers.rosa import rosa_manager

    managers: Mapping[str, Manager] = {"rosa": rosa_manager, "none": no_manager}
    return managers[name]


SUAVE = SuaveScenario("suave", "search for a pipeline and inspect it, with failing thrusters and murky water", False)
SUAVE_EXTENDED = SuaveScenario("suave-extended", "the same with a battery that runs low and must be recharged", True)
