"""Puts the UAV's mission together: the robot in its world, what the task layer performs, and what is recorded."""

from __future__ import annotations

import dataclasses

from rosa_simulation.mission import Mission, TaskParts, with_nodes
from rosa_simulation.simulation import Simulation
from task_layer.pddl import ExecutionLimits
from uav_example import nodes, skills
from uav_example.metrics import MissionMetrics
from uav_example.missions.leaves import conditions
from uav_example.models import model_files
from uav_example.narration import narrate_mission
from uav_example.robot import UavRobot
from uav_example.skills import make_skills
from uav_example.world.parameters import WorldParameters
from uav_example.world.world import World

_NODES = {
    skills.SEARCH: (nodes.SEARCH_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE: (nodes.PICK_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE_IN_SITU: (nodes.ANALYZE_PATH, nodes.CONTROL_MOTION),
    skills.RETURN_BASE: (nodes.HOME_PATH, nodes.CONTROL_MOTION),
    skills.LAND_FOLD: (nodes.LAND_PATH, nodes.FOLD_GRIPPER, nodes.CONTROL_MOTION),
}
"""What each action needs, for flights without a managing system."""


def assemble(parameters: WorldParameters, simulation: Simulation) -> Mission:
    """A mission until the aircraft is back home and has landed, or to its time limit.

    Args:
        parameters: of the world; the samples are scattered with the simulation's random numbers.
        simulation: the run to put it together for.
    """
    recorder = simulation.recorder(effect_time=2.0 * parameters.service_time)
    world = World(simulation.clock, parameters, simulation.rng)
    robot = UavRobot(world)
    narrate_mission(robot, recorder.narrator)
    metrics = MissionMetrics(robot, recorder.stopwatch)
    samples = [dataclasses.asdict(sample) for sample in world.samples]
    return Mission(
        simulation=simulation,
        recorder=recorder,
        robot=robot,
        models=model_files(spring=parameters.spring),
        task_parts=lambda _: _task_parts(robot),
        unmanaged=lambda action, skill: with_nodes(skill, robot, *_NODES[action]),
        # Every sample that is found is reason for a new plan.
        limits=ExecutionLimits(replans=10_000),
        sample=lambda: (*world.aircraft.position, world.battery.level),
        summary=lambda _: metrics.summary(),
        reaction_times=metrics.times,
        ended_by=lambda failed: _ended_by(robot, failed),
        time_limit=parameters.time_limit,
        inputs={"world": dataclasses.asdict(parameters), "samples": samples},
    )


def _task_parts(robot: UavRobot) -> TaskParts:
    world = robot.world
    return TaskParts(
        skills=make_skills(robot),
        leaves=lambda: conditions(robot),
        # There is one aircraft, whatever it is called.
        sensors={
            "area_searched": lambda *_: robot.search.done,
            "sample_waiting": lambda *_: world.waiting is not None,
            "gripper_folded": lambda *_: world.gripper.folded,
            "at_base": lambda *_: world.aircraft.position[:2] == (0.0, 0.0),
            "landed": lambda *_: world.aircraft.landed,
        },
    )


def _ended_by(robot: UavRobot, failed: bool) -> str:
    if robot.world.battery.level <= 0.0:
        return "battery empty"
    if robot.over:
        return "time limit"
    return "mission failed" if failed else "mission done"
