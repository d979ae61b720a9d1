"""One simulated run: its clock, its random numbers, and its observer."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from rosa_core.clock import SimulationClock
from rosa_simulation.run_recorder import RunRecorder
from rosa_simulation.scenario import MissionFiles, Observer, RunRequest, SilentObserver


class Wakeable(Protocol):
    """A runner of a mission."""

    def wake(self) -> None:
        """Look soon what is to be done."""
        ...


class Simulation:
    """What a scenario's robot, world and mission are assembled on.

    Args:
        request: what is to be run.
        files: the mission's files: those that were asked for, or the scenario's own.
        observer: watches the run.

    Attributes:
        clock: simulated time.
        rng: random numbers of the world, decided by the request's seed.
        manager_rng: random numbers of the managing system, so that the world's stay the same whoever manages the robot.
    """

    def __init__(
        self, request: RunRequest, files: MissionFiles | None = None, observer: Observer | None = None
    ) -> None:
        self.request = request
        self.files = files or MissionFiles()
        self.observer = observer or SilentObserver()
        self.clock = SimulationClock()
        self.rng = np.random.default_rng(request.seed)
        self.manager_rng = np.random.default_rng((request.seed, 1))
        self._runner: Wakeable | None = None

    def recorder(self, *, effect_time: float = 0.01, start_time: Callable[[], float] = lambda: 0.0) -> RunRecorder:
        """A recorder of this run.

        Args:
            effect_time: as of :class:`RunRecorder`, s.
            start_time: as of :class:`RunRecorder`: when the mission began, s.
        """
        return RunRecorder(self.observer, self.clock, effect_time=effect_time, start_time=start_time)

    def set_runner(self, runner: Wakeable) -> None:
        """From now on this is what runs the mission."""
        self._runner = runner

    def wake(self) -> None:
        """Let the task layer look soon what is to be done, if it runs yet."""
        if self._runner is not None:
            self._runner.wake()
