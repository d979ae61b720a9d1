"""The scenario ``agv``."""

from __future__ import annotations

import dataclasses
import time
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from rosa_evaluation.run_record import MissionEvent, RunRecord, raised_event
from rosa_evaluation.scenario import Observer, RunRequest, choose

if TYPE_CHECKING:
    from agv_example.managers.manager import Manager
    from agv_example.missions.mission_config import Happening, MissionConfig
    from agv_example.world import AgvRobot, RobotEvent
    from rosa_evaluation.report import ReportGuide
    from task_layer.bt import TreeRunner

_SAMPLE_PERIOD = 1.0
_COLUMNS = ("time_s", "x_m", "y_m", "light", "battery_level", "risk", "collisions")
_WAKING = ("arrived", "corridor closed", "corridor opened", "light changed", "goal reached", "time limit")


@dataclass(frozen=True, slots=True)
class AgvScenario:
    """A mission of the AGV, as the command line runs it."""

    name: str
    description: str
    managers: tuple[str, ...] = ("rosa", "none")
    task_layers: tuple[str, ...] = ("bt",)

    def report_guide(self) -> ReportGuide:
        """How runs are shown in a report."""
        from agv_example.report_guide import report_guide

        return report_guide()

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Drive to all goals, or until the time limit."""
        choose("manager", request.manager, self.managers)
        choose("task layer", request.task_layer, self.task_layers)
        from agv_example.missions.mission_config import default_mission, load_mission

        config = load_mission(request.mission_config or default_mission())
        if request.time_limit is not None:
            config = dataclasses.replace(config, time_limit=request.time_limit)
        return self._drive(request, config, observer)

    def _drive(self, request: RunRequest, config: MissionConfig, observer: Observer) -> RunRecord:
        import numpy as np

        from agv_example.drive_configurations import drive_options
        from agv_example.managers.manager import ManagedMission, load_agv_model
        from agv_example.metrics import MissionMetrics
        from agv_example.narrator import Narrator
        from agv_example.navigator import RouteDecision
        from agv_example.world import AgvRobot
        from rosa_core import KnowledgeBase
        from rosa_core.clock import SimulationClock, Stopwatch
        from rosa_core.kb import Event

        began = time.perf_counter()
        clock, stopwatch = SimulationClock(), Stopwatch()
        rng = np.random.default_rng(request.seed)
        happenings = config.happenings(rng)
        model = load_agv_model(config)
        robot = AgvRobot(
            clock,
            config.corridors,
            config.start,
            battery=config.battery,
            truth=drive_options(KnowledgeBase(model, clock=clock), config.lights),
            start_up=config.start_up,
            rng=rng,
        )
        events: list[MissionEvent] = []
        trajectory: list[tuple[float, ...]] = []

        def tell(event: MissionEvent) -> None:
            events.append(event)
            observer.event(event)

        def sample() -> None:
            trajectory.append(_sample(robot))
            observer.progress(clock.now())

        metrics = MissionMetrics(robot, stopwatch, len(config.goals))
        narrator = Narrator(robot, tell)

        def on_kb_event(event: Event) -> None:
            metrics.on_kb_event(event)
            narrator.on_kb_event(event)

        def on_route(decision: RouteDecision) -> None:
            metrics.on_route(decision)
            narrator.on_route(decision)

        mission = ManagedMission(
            robot,
            config,
            model,
            stopwatch,
            on_kb_event,
            on_route,
            on_raise=lambda behaviour, error: tell(raised_event(clock.now(), behaviour.name, error)),
        )
        observer.started(config.time_limit)
        with _manager(request.manager)(mission) as runner:
            robot.on_event.append(partial(_wake, runner))
            clock.call_every(_SAMPLE_PERIOD, sample, start=0.0)
            robot.depart(config.time_limit)
            _schedule(robot, happenings)
            observer.tree(runner)
            runner.run(until=lambda: robot.over)
        narrator.close()
        done = len(robot.reached) == len(config.goals)
        return RunRecord(
            scenario=self.name,
            manager=request.manager,
            task_layer=request.task_layer,
            seed=request.seed,
            completed=True,
            ended_by="all goals reached" if done else "time limit",
            duration_s=round(metrics.duration, 6),
            inputs=_inputs(config, happenings),
            metrics=metrics.summary(),
            reactions={name: tuple(reactions) for name, reactions in metrics.reactions.items()},
            events=tuple(events),
            trajectory_columns=_COLUMNS,
            trajectory=tuple(trajectory),
            wall_clock_s=time.perf_counter() - began,
            managing_s=stopwatch.elapsed(),
        )


def _wake(runner: TreeRunner, event: RobotEvent) -> None:
    if event.what in _WAKING:
        runner.wake()


def _schedule(robot: AgvRobot, happenings: tuple[Happening, ...]) -> None:
    """Let everything happen in its time; what happens at 0 is so when the mission begins."""
    for one in happenings:
        calls = {
            "fails": partial(robot.fail, one.subject),
            "works": partial(robot.recover, one.subject),
            "closes": partial(robot.close, one.subject),
            "opens": partial(robot.close, one.subject, False),
            "dims": partial(robot.dim, one.subject, one.light),
        }
        if one.time > 0.0:
            robot.clock.call_at(one.time, calls[one.kind])
        else:
            calls[one.kind]()


def _sample(robot: AgvRobot) -> tuple[float, ...]:
    collisions = robot.collisions
    x, y = robot.coordinates
    return (robot.clock.now(), x, y, robot.light, robot.battery_level, collisions.risk, float(collisions.number))


def _manager(name: str) -> Manager:
    from agv_example.managers.none import no_manager
    from agv_example.managers.rosa import rosa_manager

    managers: dict[str, Manager] = {"rosa": rosa_manager, "none": no_manager}
    return managers[name]


def _inputs(config: MissionConfig, happenings: tuple[Happening, ...]) -> dict[str, Any]:
    """Everything that the run was made of; surveys of corridors only by how many drives they know."""
    corridors = config.corridors
    return {
        "map": {
            "name": corridors.name,
            "places": {place.name: [place.x, place.y] for place in corridors.places},
            "corridors": [
                {
                    **{field.name: getattr(corridor, field.name) for field in dataclasses.fields(corridor)},
                    "surveys": {origin: len(survey.drives) for origin, survey in corridor.surveys.items()},
                }
                for corridor in corridors.corridors
            ],
        },
        "start": config.start,
        "goals": list(config.goals),
        "objective": str(config.objective),
        "battery": config.battery,
        "start_up": dataclasses.asdict(config.start_up),
        "time_limit": config.time_limit,
        "models": [path.name for path in config.models],
        "happenings": [dataclasses.asdict(one) for one in happenings],
    }


AGV = AgvScenario("agv", "cross a map of corridors; path and architecture are planned together, and again when needed")
