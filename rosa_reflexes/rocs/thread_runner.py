"""Runs a robot in real time, a thread for each block (RoCS paper, section 5.2); a block sleeps until it is woken."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from types import TracebackType

from rosa_core.clock import Clock, WallClock
from rosa_reflexes.rocs.robot import Robot


class ThreadRunner:
    """Runs a robot in threads, as long as the ``with`` block lasts.

    Args:
        robot: what is run.
        on_error: called with a block's name and what it raised; the robot then stops. It should command what is safe.
        clock: what periods are waited for on.

    Attributes:
        errors: what blocks have raised.
    """

    def __init__(self, robot: Robot, on_error: Callable[[str, Exception], None], *, clock: Clock | None = None) -> None:
        self.errors: list[tuple[str, Exception]] = []
        self._robot, self._on_error, self._clock = robot, on_error, clock or WallClock()
        self._stopped = threading.Event()
        self._wakes: list[threading.Event] = []
        self._threads: list[threading.Thread] = []

    def __enter__(self) -> ThreadRunner:
        robot, pipeline = self._robot, self._robot.execute.pipeline
        for analyze in robot.analyzes:
            analyze.inbox.on_delivery = self._add(analyze.name, analyze.publish, None).set
        plan, execute = robot.plan, robot.execute
        if plan is not None:

            def decide() -> None:
                if execute.idle:
                    plan.decide(pipeline)

            plan.inbox.on_delivery = self._add(plan.name, decide, plan.period).set
        pipeline.on_change = self._add("execute", execute.step, execute.period).set
        reactions = [self._add(one.name, partial(robot.react, one), one.period) for one in robot.knowledge.reactive]
        for monitor in robot.monitors:
            self._add(monitor.name, self._publishing(monitor.publish, reactions), monitor.period)
        for thread in self._threads:
            thread.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, _: TracebackType | None) -> None:
        self.stop()
        for thread in self._threads:
            thread.join()

    def stop(self) -> None:
        """Let all threads end."""
        self._stopped.set()
        for wake in self._wakes:
            wake.set()

    @staticmethod
    def _publishing(publish: Callable[[], None], reactions: list[threading.Event]) -> Callable[[], None]:
        def run() -> None:
            for wake in reactions:
                wake.set()
            publish()

        return run

    def _add(self, name: str, run: Callable[[], None], period: float | None) -> threading.Event:
        """A thread that runs whenever it is woken, and at the latest every ``period`` seconds."""
        wake = threading.Event()

        def cycle() -> None:
            try:
                while not self._stopped.is_set():
                    run()
                    self._clock.wait(wake, threading.TIMEOUT_MAX if period is None else period)
                    wake.clear()
            except Exception as error:
                self.errors.append((name, error))
                self.stop()
                self._on_error(name, error)

        self._wakes.append(wake)
        self._threads.append(threading.Thread(target=cycle, name=f"{self._robot.name}: {name}", daemon=True))
        return wake
