"""Runs a robot in one thread on simulated time: deterministic, and what comes in is passed on in the same call."""

from __future__ import annotations

from functools import partial
from typing import Any

from rosa_core.clock import SimulationClock, Timer
from rosa_reflexes.rocs.blocks import Monitor
from rosa_reflexes.rocs.robot import Robot


class EventRunner:
    """Runs a robot on a simulation clock, from :meth:`start` to :meth:`stop`.

    A value that a monitor publishes reaches reactive models, Analyze, Plan and Execute within the same call.

    Args:
        robot: what is run.
        clock: simulated time.
    """

    def __init__(self, robot: Robot, clock: SimulationClock) -> None:
        self._robot, self._clock = robot, clock
        self._timers: list[Timer] = []

    def start(self) -> None:
        """Run from now on."""
        robot, every, now = self._robot, self._clock.call_every, self._clock.now()
        robot.execute.pipeline.on_change = robot.execute.step
        for analyze in robot.analyzes:
            analyze.inbox.on_delivery = analyze.publish
        self._timers += [every(one.period, partial(robot.react, one), start=now) for one in robot.knowledge.reactive]
        self._timers += [every(one.period, partial(self._monitor, one), start=now) for one in robot.monitors]
        if robot.plan is not None:
            robot.plan.inbox.on_delivery = self._decide
            self._timers.append(every(robot.plan.period, self._decide_if_idle, start=now))
        self._timers.append(every(robot.execute.period, robot.execute.step, start=now))

    def stop(self) -> None:
        """Run no longer; what is being done goes on as it is."""
        for timer in self._timers:
            timer.cancel()
        self._timers.clear()

    def _monitor(self, monitor: Monitor[Any]) -> None:
        for model in self._robot.knowledge.reactive:
            self._robot.react(model)
        monitor.publish()

    def _decide_if_idle(self) -> None:
        if self._robot.execute.idle:
            self._decide()

    def _decide(self) -> None:
        plan, execute = self._robot.plan, self._robot.execute
        if plan is not None and execute.idle:
            plan.decide(execute.pipeline)
