"""Puts the AGV's mission together: the robot on its map, what the task layer performs, and what is recorded."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from functools import partial
from typing import Any

from agv_example.corridors import Corridor
from agv_example.drive_configurations import drive_options
from agv_example.metrics import MissionMetrics
from agv_example.missions.mission_config import DrawnDisturbance, MissionConfig
from agv_example.models import model_files
from agv_example.narration import narrate_mission, narrate_route
from agv_example.navigator import RouteDecision
from agv_example.task import AgvTask
from agv_example.world import AgvRobot
from rosa_core import KnowledgeBase
from rosa_simulation.mission import Mission
from rosa_simulation.models import load_models
from rosa_simulation.preemptions import narrate_gate
from rosa_simulation.simulation import Simulation
from task_layer.pddl import ExecutionLimits

_CORRIDOR_FIELDS = tuple(field.name for field in dataclasses.fields(Corridor) if field.name != "measured")
_LIMITS = ExecutionLimits(attempts=10_000, replans=10_000, patience=math.inf)
"""A robot without a way waits for one, as it does with a tree; the mission's time limit ends that."""


def assemble(config: MissionConfig, simulation: Simulation) -> Mission:
    """A mission until all goals are reached, or to its time limit.

    Args:
        config: the mission; its disturbances are drawn with the simulation's random numbers.
        simulation: the run to put it together for.
    """
    clock, recorder = simulation.clock, simulation.recorder()
    disturbances = config.draw(simulation.rng)
    models = model_files(config.models)
    model = load_models(models)
    robot = AgvRobot(
        clock,
        config.corridors,
        config.start,
        battery=config.battery,
        truth=drive_options(KnowledgeBase(model, clock=clock), config.lights),
        start_up=config.start_up,
        rng=simulation.rng,
    )
    metrics = MissionMetrics(robot, recorder.stopwatch)
    if config.reflexes:
        robot.add_bumper(lambda event: narrate_gate(recorder.narrator, event))
    narrate_mission(robot, recorder.narrator)

    def on_route(decision: RouteDecision) -> None:
        metrics.on_route(decision)
        narrate_route(recorder.narrator, decision)

    def begin() -> None:
        robot.depart(config.time_limit)
        _schedule(robot, disturbances)

    task = AgvTask(robot, config, model, on_route)
    return Mission(
        simulation=simulation,
        recorder=recorder,
        robot=robot,
        models=models,
        task_parts=task.parts,
        make_problem=lambda: task.problem().text,
        limits=_LIMITS,
        begin=begin,
        sample=lambda: _sample(robot),
        summary=lambda duration: metrics.summary(goals=len(config.goals), duration=duration),
        reaction_times=metrics.times,
        on_kb_event=metrics.on_kb_event,
        ended_by=lambda failed: _ended_by(robot, config, failed),
        time_limit=config.time_limit,
        inputs={**_inputs(config, disturbances), **({"reflexes": True} if config.reflexes else {})},
    )


def _schedule(robot: AgvRobot, disturbances: Sequence[DrawnDisturbance]) -> None:
    """Let everything go wrong in its time; what does so at 0 is so when the mission begins."""
    for one in disturbances:
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
    return (*robot.coordinates, robot.light, robot.battery_level, collisions.risk, float(collisions.number))


def _ended_by(robot: AgvRobot, config: MissionConfig, failed: bool) -> str:
    if len(robot.reached) == len(config.goals):
        return "all goals reached"
    if robot.over:
        return "time limit"
    return "mission failed" if failed else "mission done"


def _inputs(config: MissionConfig, disturbances: Sequence[DrawnDisturbance]) -> dict[str, Any]:
    """Everything that the run was made of; measured drives only by their number."""
    corridors = config.corridors
    return {
        "map": {
            "name": corridors.name,
            "places": {place.name: [place.x, place.y] for place in corridors.places},
            "corridors": [
                {
                    **{name: getattr(corridor, name) for name in _CORRIDOR_FIELDS},
                    "surveys": {origin: len(measured.drives) for origin, measured in corridor.measured.items()},
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
        "happenings": [dataclasses.asdict(one) for one in disturbances],
    }
