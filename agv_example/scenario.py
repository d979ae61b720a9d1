"""The scenario ``agv``."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from agv_example.parameters import PARAMETERS, requested_mission
from rosa_simulation.plans import check_planning, why_given_up
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import Observer, Parameter, RunRequest, choose

if TYPE_CHECKING:
    from agv_example.managers.manager import ManagedMission, Manager
    from agv_example.missions.mission_config import Happening, MissionConfig
    from agv_example.navigator import RouteDecision
    from agv_example.world import AgvRobot
    from rosa_core.kb import Event
    from rosa_evaluation.report import ReportSpec
    from rosa_simulation.metric import Metric
    from task_layer.bt import TreeRunner
    from task_layer.pddl import PlanExecutor

_COLUMNS = ("x_m", "y_m", "light", "battery_level", "risk", "collisions")
_WAKING = ("arrived", "corridor closed", "corridor opened", "light changed", "goal reached", "time limit")


@dataclasses.dataclass(frozen=True, slots=True)
class AgvScenario:
    """A mission of the AGV, as the command line runs it."""

    name: str = "agv"
    description: str = "cross a map of corridors; path and architecture are planned together, and again when needed"
    managers: tuple[str, ...] = ("rosa", "none")
    task_layers: tuple[str, ...] = ("bt", "pddl")

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """What may be set in the mission."""
        return PARAMETERS

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What a run measures."""
        from agv_example.metrics import METRICS

        return METRICS

    def check(self, request: RunRequest) -> None:
        """That there are such a manager, task layer, mission and parameters, and that these go together."""
        self._prepare(request)

    def report_spec(self) -> ReportSpec:
        """How runs are shown in a report."""
        from agv_example.report_spec import report_spec

        return report_spec()

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Drive to all goals, or until the time limit."""
        return self._drive(request, self._prepare(request), observer)

    def _prepare(self, request: RunRequest) -> MissionConfig:
        choose("manager", request.manager, self.managers)
        choose("task layer", request.task_layer, self.task_layers)
        check_planning(request)
        return requested_mission(request)

    def _drive(self, request: RunRequest, config: MissionConfig, observer: Observer) -> RunRecord:
        # What a drive needs is imported here, so that listing the scenarios does not load it.
        import numpy as np

        from agv_example.drive_configurations import drive_options
        from agv_example.managers.manager import ManagedMission, load_agv_model
        from agv_example.metrics import MissionMetrics
        from agv_example.story import AgvStory
        from agv_example.world import AgvRobot
        from rosa_core import KnowledgeBase
        from rosa_core.clock import SimulationClock
        from rosa_simulation.run_recorder import RunRecorder
        from task_layer.bt import TreeRunner

        clock = SimulationClock()
        recorder = RunRecorder(observer, clock)
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
        metrics = MissionMetrics(robot, recorder.stopwatch)
        story = AgvStory(robot, recorder.narrator)

        def on_kb_event(event: Event) -> None:
            metrics.on_kb_event(event)
            recorder.narrator.on_kb_event(event)

        def on_route(decision: RouteDecision) -> None:
            metrics.on_route(decision)
            story.on_route(decision)

        observer.started(config.time_limit)
        mission = ManagedMission(robot, config, model, recorder, on_kb_event, on_route)
        with _runner(request, mission) as runner:
            robot.on_event.append(lambda event: runner.wake() if event.what in _WAKING else None)
            recorder.sample(_COLUMNS, partial(_sample, robot))
            robot.depart(config.time_limit)
            _schedule(robot, happenings)
            if isinstance(runner, TreeRunner):
                observer.tree(runner)
            ended = runner.run(until=lambda: robot.over)
        gave_up = why_given_up(runner, ended)
        return recorder.record(
            self.name,
            request,
            completed=not gave_up,
            ended_by=gave_up or _ended_by(robot, config),
            inputs=_inputs(config, happenings),
            metrics=metrics.summary(goals=len(config.goals), duration=recorder.close()),
            reactions=metrics.times.reactions,
        )


def _ended_by(robot: AgvRobot, config: MissionConfig) -> str:
    if len(robot.reached) == len(config.goals):
        return "all goals reached"
    return "time limit" if robot.over else "mission done"


def _runner(request: RunRequest, mission: ManagedMission) -> TreeRunner | PlanExecutor:
    if request.task_layer == "bt":
        return _manager(request.manager)(mission)
    from agv_example.managers.rosa_pddl import MissionFiles, rosa_plan

    return rosa_plan(mission, MissionFiles(request.domain, request.problem))


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
    return (x, y, robot.light, robot.battery_level, collisions.risk, float(collisions.number))


def _manager(name: str) -> Manager:
    from agv_example.managers.none import no_manager
    from agv_example.managers.rosa import rosa_tree

    managers: dict[str, Manager] = {"rosa": rosa_tree, "none": no_manager}
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


AGV = AgvScenario()
