"""What a run leaves behind: inputs, versions, events, metrics, trajectory; as a directory and as one document.

Everything but ``wall_clock.json`` is the same, byte for byte, whenever the same inputs are run with the same seed.
"""

from __future__ import annotations

import csv
import json
import platform
import traceback
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_simulation.metric import MEAN_REACTION_TIME

PACKAGES = ("rosa-coadaptation", "mujoco", "numpy", "py_trees", "unified-planning", "up-pyperplan")


@dataclass(frozen=True, slots=True)
class MissionEvent:
    """One thing that happened, with what followed from it at once; ``time_s`` is mission time.

    ``facts`` holds the same for programs: each a mapping with the key ``fact`` saying what it is.
    """

    time_s: float
    text: str
    facts: tuple[Mapping[str, Any], ...] = ()


def raised_event(time_s: float, who: str, error: Exception) -> MissionEvent:
    """Something raised where the mission goes on; the traceback is among the facts.

    Args:
        time_s: mission time, s.
        who: the name of the behaviour, step or sensor.
        error: that it raised.
    """
    what = f"{type(error).__name__}: {error}"
    trace = "".join(traceback.format_exception(error))
    fact = {"fact": "raised", "who": who, "error": what, "traceback": trace}
    return MissionEvent(time_s, f"'{who}' raised {what}: it has failed", (fact,))


@dataclass(frozen=True, slots=True)
class Reaction:
    """From an uncertainty to the adaptation to it: simulated delay plus wall-clock time of deciding, in s."""

    cause_s: float
    delay_s: float
    compute_s: float

    @property
    def total_s(self) -> float:
        """The reaction time."""
        return self.delay_s + self.compute_s


@dataclass(frozen=True, slots=True)
class RecordedPlan:
    """A plan that the task layer made, or that there was none and why.

    Attributes:
        time_s: mission time at which it was made, s.
        reason: why the plan before was not good any more.
        steps: as PDDL writes them; empty if there was no plan.
        kept: how many of the steps, the first ones, were already running.
        no_plan: why there was none; empty if there was one.
        cached: whether it was known from before.
        engine: what made it.
        cost_s: the wall-clock time that planning took, s.
    """

    time_s: float
    reason: str
    steps: tuple[str, ...]
    kept: int
    no_plan: str
    cached: bool
    engine: str
    cost_s: float

    def document(self) -> dict[str, Any]:
        """Everything but what it cost."""
        return {
            "time_s": self.time_s,
            "reason": self.reason,
            "steps": list(self.steps),
            "kept": self.kept,
            "no_plan": self.no_plan,
            "cached": self.cached,
            "engine": self.engine,
        }


@dataclass(frozen=True, slots=True)
class AwaitedAction:
    """An action that a mission was waiting for when it ended: it would have performed it, had it been feasible.

    Attributes:
        action: its name in the knowledge base.
        reason: why it was unfeasible.
        remedies: what would have had to change, all of it; empty if nothing that is known would have done.
    """

    action: str
    reason: str
    remedies: tuple[str, ...]

    def document(self) -> dict[str, Any]:
        """The same, as JSON has it."""
        return {"action": self.action, "reason": self.reason, "remedies": list(self.remedies)}


def package_versions() -> dict[str, str]:
    """The versions of Python and of the packages that a run's outcome depends on."""
    return dict(_package_versions())


@cache
def _package_versions() -> dict[str, str]:
    versions = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            versions[name] = version(name)
        except PackageNotFoundError:
            versions[name] = "not installed"
    return versions


@dataclass(frozen=True, slots=True)
class RunRecord:
    """One run of a scenario.

    Attributes:
        completed: it ran to its designed end, whatever it achieved.
        ended_by: why it ended, in words.
        duration_s: of the mission, s.
        inputs: everything that the run was made of, as JSON has it.
        metrics: values by the metric's name, in its unit.
        reactions: by uncertainty, in the order in which they happened.
        trajectory_columns: ``time_s`` and what is sampled.
        trajectory: a row ``(time_s, *values)`` for each sample.
        wall_clock_s: how long the run took, s.
        managing_s: how much of that the managing system spent, s.
        plans: empty if the task layer made none.
        waiting_for: empty if the mission was not waiting for an action when it ended.
    """

    scenario: str
    manager: str
    task_layer: str
    seed: int
    completed: bool
    ended_by: str
    duration_s: float
    inputs: Mapping[str, Any]
    metrics: Mapping[str, Any]
    reactions: Mapping[str, tuple[Reaction, ...]]
    events: tuple[MissionEvent, ...]
    trajectory_columns: tuple[str, ...]
    trajectory: tuple[tuple[float, ...], ...]
    wall_clock_s: float
    managing_s: float
    versions: Mapping[str, str] = field(default_factory=package_versions)
    plans: tuple[RecordedPlan, ...] = ()
    waiting_for: tuple[AwaitedAction, ...] = ()

    def document(self) -> dict[str, Any]:
        """The run as one JSON document, wall-clock figures included."""
        return {
            **self._repeatable(),
            "metrics": dict(self.metrics),
            "reaction_times": {
                name: [{"delay_s": r.delay_s, "compute_s": r.compute_s, "total_s": r.total_s} for r in reactions]
                for name, reactions in self.reactions.items()
            },
            "events": len(self.events),
            **({"plans": [{**plan.document(), "cost_s": plan.cost_s} for plan in self.plans]} if self.plans else {}),
            "wall_clock_s": self.wall_clock_s,
            "managing_s": self.managing_s,
        }

    def write(self, directory: Path) -> None:
        """Write ``run.json``, ``events.jsonl``, ``trajectory.csv`` and ``wall_clock.json`` into a directory.

        Args:
            directory: made if it is not there; files of another run in it are replaced.

        Raises:
            InputError: if the directory cannot be written.
        """
        timed = {MEAN_REACTION_TIME.name}
        run = {
            **self._repeatable(),
            "metrics": {name: value for name, value in self.metrics.items() if name not in timed},
            "reactions": {
                name: [{"cause_s": r.cause_s, "delay_s": r.delay_s} for r in reactions]
                for name, reactions in self.reactions.items()
            },
            **({"plans": [plan.document() for plan in self.plans]} if self.plans else {}),
            "inputs": dict(self.inputs),
            "versions": dict(self.versions),
        }
        wall_clock = {
            "wall_clock_s": self.wall_clock_s,
            "managing_s": self.managing_s,
            "metrics": {name: self.metrics[name] for name in timed & set(self.metrics)},
            "compute_s": {name: [r.compute_s for r in reactions] for name, reactions in self.reactions.items()},
            **({"planning_s": [plan.cost_s for plan in self.plans]} if self.plans else {}),
        }
        try:
            directory.mkdir(parents=True, exist_ok=True)
            _write_json(directory / "run.json", run)
            _write_json(directory / "wall_clock.json", wall_clock)
            with (directory / "events.jsonl").open("w", encoding="utf-8") as file:
                file.writelines(_json_line(event) for event in self.events)
            _write_rows(directory / "trajectory.csv", self.trajectory_columns, self.trajectory)
        except OSError as error:
            hint = "name another directory with --out"
            raise InputError(Problem(f"cannot write it: {error.strerror}", Location(str(directory)), hint)) from None

    def _repeatable(self) -> dict[str, Any]:
        waiting = [awaited.document() for awaited in self.waiting_for]
        return {
            "scenario": self.scenario,
            "manager": self.manager,
            "task_layer": self.task_layer,
            "seed": self.seed,
            "completed": self.completed,
            "ended_by": self.ended_by,
            "duration_s": self.duration_s,
            **({"waiting_for": waiting} if waiting else {}),
        }


def _write_json(path: Path, document: Mapping[str, Any]) -> None:
    path.write_text(json.dumps(document, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def _json_line(event: MissionEvent) -> str:
    line = {"time_s": event.time_s, "text": event.text, "facts": [dict(fact) for fact in event.facts]}
    return json.dumps(line, ensure_ascii=False) + "\n"


def _write_rows(path: Path, columns: Iterable[str], rows: Iterable[tuple[float, ...]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([f"{value:.6g}" for value in row] for row in rows)
