"""Puts a SUAVE mission together: the robot in its world, what the task layer performs, and what is recorded."""

from __future__ import annotations

import dataclasses

from rosa_simulation.mission import Mission, TaskParts, with_nodes
from rosa_simulation.preemptions import narrate_gate
from rosa_simulation.simulation import Simulation
from suave.managers.modes import mode_control
from suave.metrics import MissionMetrics
from suave.mission_config import SPIRAL_ALTITUDES
from suave.missions.leaves import mission_leaves
from suave.models import model_files
from suave.narration import narrate_mission
from suave.parameters import Settings
from suave.robot import SuaveRobot
from suave.skills import StartRobot, make_skills
from task_layer.skill import Skill, WithHooks

_NODES = {
    "search_pipeline": "f_generate_search_path_node",
    "inspect_pipeline": "f_follow_pipeline_node",
    "recharge": "generate_recharge_path_node",
}
_START_LIMIT = 60.0
"""How long a mission may take until it sets the mode GUIDED, s."""


def assemble(settings: Settings, simulation: Simulation) -> Mission:
    """A mission from GUIDED to its time limit, or until the pipeline is inspected.

    Args:
        settings: the mission, the world, and whether there is a battery.
        simulation: the run to put it together for.
    """
    config, world, clock = settings.config, settings.world, simulation.clock
    robot = SuaveRobot(clock, config, simulation.rng, with_battery=settings.extended, parameters=world)
    recorder = simulation.recorder(
        effect_time=2.0 * world.service_time,
        start_time=lambda: clock.now() if robot.guided_at is None else robot.guided_at,
    )
    narrate_mission(robot, recorder.narrator)
    metrics = MissionMetrics(robot, recorder.stopwatch)
    if settings.reflexes:
        from suave.sea_bed_reflex import SeaBedReflex

        SeaBedReflex(robot.vehicle, clock, lambda event: narrate_gate(recorder.narrator, event))

    def sample() -> tuple[float, ...]:
        level = 1.0 if robot.battery is None else robot.battery.level(clock.now())
        return (*robot.vehicle.position, robot.vehicle.yaw, robot.visibility(), level)

    return Mission(
        simulation=simulation,
        recorder=recorder,
        robot=robot,
        models=model_files(extended=settings.extended),
        task_parts=lambda _: _task_parts(robot),
        unmanaged=lambda action, skill: _unmanaged(robot, action, skill),
        modes=mode_control(config, extended=settings.extended),
        sample=sample,
        summary=lambda _: metrics.summary(),
        duration=lambda _: metrics.duration,
        reaction_times=metrics.times,
        ended_by=lambda failed: _ended_by(robot, failed),
        time_limit=config.time_limit,
        timeout=config.time_limit + _START_LIMIT,
        inputs={
            "mission": dataclasses.asdict(config),
            "world": dataclasses.asdict(world),
            **({"reflexes": True} if settings.reflexes else {}),
        },
    )


def _task_parts(robot: SuaveRobot) -> TaskParts:
    return TaskParts(
        skills=make_skills(robot),
        own_skills={"start_robot": StartRobot(robot)},
        leaves=lambda: mission_leaves(robot),
        # There is one robot and one pipeline, whatever they are called.
        sensors={
            "robot_started": lambda *_: robot.guided_at is not None,
            "pipeline_found": lambda *_: robot.pipeline_found,
            "pipeline_inspected": lambda *_: robot.pipeline_inspected,
        },
    )


def _unmanaged(robot: SuaveRobot, action: str, skill: Skill) -> Skill:
    """A skill that itself starts and stops its node, which searches at the altitude of the mission configuration."""
    if action != "search_pipeline":
        return with_nodes(skill, robot, _NODES[action])

    def begin() -> None:
        altitude = SPIRAL_ALTITUDES[robot.config.f_generate_search_path_mode]
        robot.activate(_NODES[action])
        robot.set_parameters(_NODES[action], {"spiral_altitude": altitude})

    return WithHooks(skill, begin, lambda: robot.deactivate(_NODES[action]))


def _ended_by(robot: SuaveRobot, failed: bool) -> str:
    if robot.pipeline_inspected:
        return "pipeline inspected"
    if robot.over:
        return "time limit"
    if robot.guided_at is None:
        return "never in mode GUIDED"
    return "mission failed" if failed else "mission done"
