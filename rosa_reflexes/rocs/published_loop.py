"""The published design as it is, for comparison: threads that sleep, and a pipeline that holds one action.

After the paper's source code (github.com/oliveirarleo/RoCS, folder pioneer_astar). Not for use on a robot:

- each block sleeps 50 ms (Execute 25 ms) between two looks, so that it takes up to three sleeps to Execute;
- a reactive action waits until the action that runs is over;
- the pipeline throws away what waits as soon as something at least as urgent is pushed, whoever asked for it: an action
  of the plan can evict a reactive one.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from functools import partial

from rosa_core.clock import SimulationClock
from rosa_reflexes.rocs.actions import is_running
from rosa_reflexes.rocs.knowledge import ReactiveModel
from rosa_reflexes.rocs.pipeline import Queued
from rosa_reflexes.rocs.robot import Robot

SLEEP, EXECUTE_SLEEP = 0.05, 0.025
"""How long the blocks sleep, s."""


class PublishedPipeline:
    """Holds one action; ``push`` replaces it by one that is at least as urgent, and drops one that is less."""

    def __init__(self) -> None:
        self.evicted: list[tuple[Queued, Queued]] = []
        """What was thrown away, and for what."""
        self._waiting: Queued | None = None

    def push(self, queued: Queued) -> None:
        """Add an action, or drop it."""
        waiting = self._waiting
        if waiting is not None:
            if queued.priority < waiting.priority:
                return
            self.evicted.append((waiting, queued))
        self._waiting = queued

    def next(self) -> Queued | None:
        """Take the action that waits."""
        waiting, self._waiting = self._waiting, None
        return waiting

    @property
    def is_empty(self) -> bool:
        """Whether none waits."""
        return self._waiting is None


class PublishedLoop:
    """Runs a robot as the published code does, on simulated time.

    Args:
        robot: what is run; the periods of its blocks do not count.
        clock: simulated time.
        phase: gives the time in s at which the next thread starts, since threads are not in step; by default all at 0.
    """

    def __init__(
        self,
        robot: Robot,
        clock: SimulationClock,
        *,
        phase: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self.pipeline = PublishedPipeline()
        self._robot, self._clock, self._phase = robot, clock, phase
        self._running = False

    def start(self) -> None:
        """Start all threads."""
        self._running = True
        robot = self._robot
        for monitor in robot.monitors:
            self._thread(_cycle(monitor.publish))
        for analyze in robot.analyzes:
            self._thread(_cycle(analyze.publish))
        if robot.plan is not None:
            self._thread(_cycle(self._plan))
        for model in robot.knowledge.reactive:
            self._thread(_cycle(partial(self._react, model)))
        self._thread(self._execute())

    def stop(self) -> None:
        """End all threads."""
        self._running = False

    def _thread(self, sleeps: Generator[float, None, None]) -> None:
        """Carry on with a thread after each of its sleeps."""

        def carry_on() -> None:
            if self._running:
                self._clock.call_later(next(sleeps), carry_on)

        self._clock.call_later(self._phase(), carry_on)

    def _plan(self) -> None:
        plan = self._robot.plan
        if plan is not None and self.pipeline.is_empty:
            for activity in plan.run(plan.inbox.values()):
                self.pipeline.push(Queued(activity, plan.priority, plan.name))

    def _react(self, model: ReactiveModel) -> None:
        activity = model.run()
        if activity is not None:
            self.pipeline.push(Queued(activity, model.priority, model.name))

    def _execute(self) -> Generator[float, None, None]:
        while True:
            queued = self.pipeline.next()
            if queued is not None:
                on_action = self._robot.execute.on_action
                if on_action is not None:
                    on_action(queued)
                queued.activity.start()
                while is_running(queued.activity.update()):
                    yield SLEEP
                queued.activity.stop()
            yield EXECUTE_SLEEP


def _cycle(run: Callable[[], None]) -> Generator[float, None, None]:
    while True:
        run()
        yield SLEEP
