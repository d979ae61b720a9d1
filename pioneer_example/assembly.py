"""Puts the Pioneer's mission together: the robot in its arena, what the task layer performs, and what is recorded."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

from pioneer_example import monitors
from pioneer_example.metrics import MissionMetrics
from pioneer_example.models import MODELS
from pioneer_example.narration import narrate_mission
from pioneer_example.ranging import SERVICE_TIME
from pioneer_example.robot import MONITORING_PERIOD, REACHED, PioneerRobot
from pioneer_example.skills import GO_TO_ORIGIN, TAKE_DETOUR, DriveTo, TakeDetour
from pioneer_example.way import Way
from pioneer_example.world.arena import EXPLORER, Arena, draw_arena
from pioneer_example.world.backend import Backend
from rosa_reflexes import GateEvent, HandedBack, Preempted
from rosa_simulation.mission import Mission, TaskParts
from rosa_simulation.preemptions import Preemptions
from rosa_simulation.simulation import Simulation
from task_layer.bt import NodeKind, Registry
from task_layer.pddl import ExecutionLimits
from task_layer.skill import Skill, WithHooks


def assemble(settings: Mapping[str, Any], simulation: Simulation) -> Mission:
    """A mission until the origin is reached, or to its time limit."""
    recorder, clock = simulation.recorder(effect_time=2.0 * SERVICE_TIME), simulation.clock
    arena = draw_arena(simulation.rng)
    robot = PioneerRobot(clock, arena, _backend(settings["backend"], arena), settings, simulation.rng)
    preemptions, way = Preemptions(clock, simulation.wake), Way(robot)

    def on_gate_event(event: GateEvent) -> None:
        if isinstance(event, Preempted):
            way.preempted(event)
            robot.is_reactive = True
            robot.actions += 1
        elif isinstance(event, HandedBack):
            way.handed_back(event)
            robot.is_reactive = False
        preemptions.on_gate_event(event)

    narrate_mission(robot, recorder.narrator)
    robot.on_gate_event.append(on_gate_event)
    metrics = MissionMetrics(robot, preemptions, recorder.stopwatch)
    time_limit = float(settings["time_limit"])

    def begin() -> None:
        robot.begin(time_limit, settings["sonar_fault"], settings["sonar_fault_at"])
        clock.call_every(
            MONITORING_PERIOD, lambda: robot.publish(monitors.preemptions(clock.now(), preemptions.per_minute()))
        )

    return Mission(
        simulation=simulation,
        recorder=recorder,
        robot=robot,
        models=MODELS,
        task_parts=lambda _: _task_parts(robot, preemptions, way, settings["deliberation_time"]),
        unmanaged=lambda _, skill: WithHooks(skill, robot.set_up, lambda: None),
        # Whatever stands in the way is reason for a new plan.
        limits=ExecutionLimits(attempts=10_000, replans=10_000),
        begin=begin,
        sample=lambda: (
            *robot.pose,
            float(robot.is_reactive),
            robot.clearance,
            float(robot.actions),
            *robot.backend.pose(EXPLORER),
        ),
        sample_period=0.2,
        summary=metrics.summary,
        reaction_times=metrics.times,
        on_kb_event=metrics.on_kb_event,
        ended_by=lambda failed: _ended_by(robot, failed),
        time_limit=time_limit,
        inputs={"settings": dict(settings), "arena": dataclasses.asdict(arena)},
    )


def _backend(name: str, arena: Arena) -> Backend:
    if name == "kinematic":
        from pioneer_example.world.kinematic_backend import KinematicBackend

        return KinematicBackend(arena)
    from pioneer_example.world.mujoco_backend import MujocoBackend

    return MujocoBackend(arena)


def _task_parts(robot: PioneerRobot, preemptions: Preemptions, way: Way, deliberation_time: float) -> TaskParts:
    go = DriveTo(robot, preemptions, lambda: (0.0, 0.0), tolerance=REACHED, deliberation_time=deliberation_time)
    detour = TakeDetour(robot, preemptions, way, deliberation_time=deliberation_time)
    skills: dict[str, Skill] = {GO_TO_ORIGIN: go, TAKE_DETOUR: detour}

    def leaves() -> Registry:
        registry = Registry()
        registry.add("is_way_blocked", lambda: way.is_blocked, kind=NodeKind.CONDITION)
        return registry.add("is_origin_reached", lambda: robot.reached, kind=NodeKind.CONDITION)

    # There is one robot, whatever it is called.
    sensors = {"at_origin": lambda *_: robot.reached, "way_clear": lambda *_: not way.is_blocked}
    return TaskParts(skills=skills, leaves=leaves, sensors=sensors)


def _ended_by(robot: PioneerRobot, failed: bool) -> str:
    if robot.reached:
        return "origin reached"
    if robot.over:
        return "time limit"
    return "mission failed" if failed else "mission done"
