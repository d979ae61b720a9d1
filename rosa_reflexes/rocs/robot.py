"""The initialisation phase (RoCS paper, section 5.2): complete and well connected blocks become a robot."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from rosa_reflexes.rocs.blocks import Analyze, Execute, Monitor, Plan, TopologyError
from rosa_reflexes.rocs.knowledge import Knowledge, ReactiveModel
from rosa_reflexes.rocs.pipeline import Queued


@dataclass(frozen=True)
class Robot:
    """A robot whose blocks are all there; a runner makes it run."""

    name: str
    knowledge: Knowledge
    monitors: tuple[Monitor[Any], ...]
    analyzes: tuple[Analyze[Any, Any], ...]
    plan: Plan[Any] | None
    execute: Execute

    def react(self, model: ReactiveModel) -> None:
        """Let a reactive model run: what it calls for goes into the pipeline, unless that is being done."""
        if self.execute.is_busy_for(model.name):
            return
        activity = model.run()
        if activity is not None:
            self.execute.pipeline.preempt(Queued(activity, model.priority, model.name))


def build_robot(
    name: str,
    knowledge: Knowledge,
    execute: Execute,
    *,
    monitors: Iterable[Monitor[Any]] = (),
    plan: Plan[Any] | None = None,
) -> Robot:
    """Make a robot of blocks.

    Args:
        name: the robot's.
        knowledge: what the blocks know; with the reactive models.
        execute: carries out actions.
        monitors: with the analyzes that are attached to them.
        plan: what the analyzes are attached to; None: the robot is purely reactive.

    Raises:
        TopologyError: if something is missing or connected to the wrong thing; all of it, each with its block.
    """
    monitors = tuple(monitors)
    analyzes = tuple(dict.fromkeys(analyze for monitor in monitors for analyze in monitor.analyzes))
    robot = Robot(name, knowledge, monitors, analyzes, plan, execute)
    problems = list(_problems(robot))
    if problems:
        raise TopologyError(f"the robot '{name}' is not complete: {'; '.join(problems)}")
    return robot


def _problems(robot: Robot) -> Iterator[str]:
    yield from _problems_of_names(robot)
    if not robot.knowledge.robot.actuators:
        yield "it has no Actuator"
    if robot.plan is None and not robot.knowledge.reactive:
        yield "it has neither a Plan nor a ReactiveModel"
    yield from _problems_of_readers(robot)
    yield from _problems_of_routes(robot)


def _problems_of_names(robot: Robot) -> Iterator[str]:
    names = [*robot.knowledge.robot.names, *([] if robot.plan is None else [robot.plan.name])]
    for several in (robot.monitors, robot.analyzes, robot.knowledge.reactive):
        names += [block.name for block in several]
    for name in sorted({name for name in names if names.count(name) > 1}):
        yield f"the name '{name}' stands twice"


def _problems_of_readers(robot: Robot) -> Iterator[str]:
    readers = [(f"the Monitor '{one.name}'", one.sensors) for one in robot.monitors]
    readers += [(f"the ReactiveModel '{one.name}'", one.sensors) for one in robot.knowledge.reactive]
    for reader, sensors in readers:
        if not sensors:
            yield f"{reader} reads no Sensor"
        for sensor in sensors:
            if robot.knowledge.robot.sensors.get(sensor.name) is not sensor:
                yield f"{reader} reads the Sensor '{sensor.name}', which the RobotModel does not have"


def _problems_of_routes(robot: Robot) -> Iterator[str]:
    plan = robot.plan
    for monitor in robot.monitors:
        if not monitor.analyzes:
            yield f"the Monitor '{monitor.name}' is attached to no Analyze"
    for analyze in robot.analyzes:
        if plan is None or analyze.plans != [plan]:
            yield f"the Analyze '{analyze.name}' is not attached to the robot's Plan, once and to nothing else"
    if plan is None:
        return
    if not robot.analyzes:
        yield f"no Analyze is attached to the Plan '{plan.name}'"
    for model in robot.knowledge.reactive:
        if model.priority <= plan.priority:
            yield f"the ReactiveModel '{model.name}' is not more urgent than the Plan"
