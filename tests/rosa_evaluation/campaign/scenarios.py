"""A scenario that costs nothing and fails in every way that a run can; workers import it."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rosa_core import InputError
from rosa_evaluation.campaign import CampaignPlan, Experiment, make_plan, read_managers
from rosa_simulation.metric import MEAN_REACTION_TIME, Better, Metric, MetricKind
from rosa_simulation.run_record import MissionEvent, Reaction, RunRecord
from rosa_simulation.scenario import Observer, Parameter, RunRequest, Scenario


def _number(raw: object) -> float:
    if not isinstance(raw, int | float):
        raise ValueError("a number is expected")
    return float(raw)


@dataclass(frozen=True, slots=True)
class Walk(Scenario):
    """A random walk.

    Attributes:
        log: file to which each run adds a line (manager, seed, process) when it begins.
        faults: what goes wrong in a run, by seed: it raises an ``error``, calls ``exit``, its worker may ``die``,
            always or ``die once``; or it has to ``wait`` until the file of :meth:`release` is there.
    """

    log: str = ""
    faults: tuple[tuple[int, str], ...] = ()
    name: str = "walk"
    description: str = "a random walk"
    managers: tuple[str, ...] = ("calm", "wild")
    task_layers: tuple[str, ...] = ("bt", "pddl")

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        return {"drift": Parameter("of the walk", _number), "width": Parameter("of the way", _number)}

    @property
    def metrics(self) -> tuple[Metric, ...]:
        return (
            Metric("furthest_m", "m", "the largest coordinate", MetricKind.DISTANCE, Better.MORE),
            Metric("home", "", "whether it ended near its start", MetricKind.TRUTH, Better.MORE),
            MEAN_REACTION_TIME,
        )

    def check(self, request: RunRequest) -> None:
        if request.parameters.get("width", 1.0) <= request.parameters.get("drift", 0.0):
            raise InputError("the way is not as wide as the drift")

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        self._fail_as_ordered(request)
        rng = np.random.default_rng(request.seed)
        walk = rng.normal(request.parameters.get("drift", 0.0), 1.0, 20).cumsum().tolist()
        return RunRecord(
            scenario=self.name,
            manager=request.manager,
            task_layer=request.task_layer,
            seed=request.seed,
            completed=True,
            ended_by="time limit",
            duration_s=20.0,
            inputs={"parameters": dict(request.parameters), "start": [0.0, 0.1]},
            metrics={"furthest_m": max(walk), "home": abs(walk[-1]) < 1.0, "mean_reaction_time_s": {"U1": 0.5}},
            reactions={"U1": (Reaction(3.0, 0.1, 0.02), Reaction(9.5, 0.2, 1e-5)), "U2": ()},
            events=(MissionEvent(0.0, "off “we” go", ({"fact": "begun", "of": 1},)), MissionEvent(3.0, "stumbled")),
            trajectory_columns=("time_s", "x_m"),
            trajectory=tuple((float(second), x) for second, x in enumerate(walk)),
            wall_clock_s=0.01,
            managing_s=0.001,
        )

    def _fail_as_ordered(self, request: RunRequest) -> None:
        if self.log:
            with Path(self.log).open("a", encoding="utf-8") as file:
                file.write(f"{request.manager} {request.seed} {os.getpid()}\n")
        match dict(self.faults).get(request.seed):
            case "error":
                raise ZeroDivisionError("the ground is missing")
            case "exit":
                sys.exit(3)
            case "die":
                os.kill(os.getpid(), signal.SIGKILL)
            case "die once" if len(self.visits(request)) == 1:
                os.kill(os.getpid(), signal.SIGKILL)
            case "wait":
                while not self._released.exists():
                    time.sleep(0.005)

    @property
    def _released(self) -> Path:
        return Path(f"{self.log}.released")

    def release(self) -> None:
        """Let the runs go on that wait."""
        self._released.touch()

    def begun(self) -> list[str]:
        """The lines of the log."""
        path = Path(self.log)
        return path.read_text(encoding="utf-8").splitlines() if path.exists() else []

    def visits(self, request: RunRequest) -> list[int]:
        """The processes in which a run was begun."""
        lines = [line.split() for line in self.begun()]
        return [
            int(process) for manager, seed, process in lines if (manager, seed) == (request.manager, str(request.seed))
        ]


def plan(walk: Walk, runs: int = 4, managers: str = "calm,wild", experiment: Experiment | None = None) -> CampaignPlan:
    """A campaign of that many runs for each manager, with seeds from 100 on."""
    return make_plan(walk, read_managers(managers, walk), range(100, 100 + runs), experiment)
