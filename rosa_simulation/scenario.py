"""A scenario: a robot in a world with a mission, run under one managing system or another."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_simulation.metric import Metric
from rosa_simulation.run_record import MissionEvent, RunRecord

if TYPE_CHECKING:
    from task_layer.bt import TreeRunner

ENTRY_POINTS = "rosa.scenarios"


@dataclass(frozen=True, slots=True)
class RunRequest:
    """What to run.

    ``time_limit`` is in s of mission time; ``mission_config`` is a file of the scenario's own kind. ``parameters`` sets
    some of the scenario's parameters, as plain values that YAML could hold. Instead of the scenario's own mission,
    ``mission`` is a tree in BehaviorTree.CPP XML for the task layer ``bt``, ``domain`` and ``problem`` are PDDL files
    for the task layer ``pddl``. ``video`` is a file into which the mission is to be filmed.
    """

    manager: str = "rosa"
    task_layer: str = "bt"
    seed: int = 0
    time_limit: float | None = None
    mission_config: Path | None = None
    parameters: Mapping[str, Any] = field(default_factory=dict)
    mission: Path | None = None
    domain: Path | None = None
    problem: Path | None = None
    video: Path | None = None


@dataclass(frozen=True, slots=True)
class Parameter:
    """Something about mission or world that an experiment may set.

    ``read`` makes the scenario's own value of a plain one (text, number, truth value, list), or raises a ValueError
    that says what is expected.
    """

    description: str
    read: Callable[[object], Any]


class Observer(Protocol):
    """Whoever watches a run while it happens."""

    def started(self, time_limit: float) -> None:
        """The run begins; it will last at most ``time_limit`` seconds of mission time."""
        ...

    def event(self, event: MissionEvent) -> None:
        """Something happened."""
        ...

    def progress(self, mission_time: float) -> None:
        """So much mission time has passed, s."""
        ...

    def warning(self, text: str) -> None:
        """Something about the inputs that the user should know."""
        ...

    def tree(self, runner: TreeRunner) -> None:
        """The mission is a behaviour tree, which this will run; called before its first tick, if there is one."""
        ...


class SilentObserver:
    """Watches nothing."""

    def started(self, time_limit: float) -> None:
        """Nothing."""

    def event(self, event: MissionEvent) -> None:
        """Nothing."""

    def progress(self, mission_time: float) -> None:
        """Nothing."""

    def warning(self, text: str) -> None:
        """Nothing."""

    def tree(self, runner: TreeRunner) -> None:
        """Nothing."""


class Scenario(Protocol):
    """What an entry point of the group ``rosa.scenarios`` must name."""

    @property
    def name(self) -> str:
        """What it is called on the command line."""
        ...

    @property
    def description(self) -> str:
        """One line on what it is about."""
        ...

    @property
    def managers(self) -> tuple[str, ...]:
        """The managing systems that it can be run with."""
        ...

    @property
    def task_layers(self) -> tuple[str, ...]:
        """The kinds of mission that it can be run with."""
        ...

    @property
    def parameters(self) -> Mapping[str, Parameter]:
        """What ``RunRequest.parameters`` may set."""
        ...

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What its runs measure, in the order of their records."""
        ...

    def check(self, request: RunRequest) -> None:
        """That the request can be run; costs next to nothing.

        Raises:
            InputError: if it cannot: a manager that this mission does not have, parameters that do not go together.
        """
        ...

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Run the mission to its end.

        A scenario that heeds ``request.video`` has an attribute ``films`` that is true; others are never given one.
        One that has a method ``report_spec`` says how a report shows its runs: see
        :mod:`rosa_evaluation.report.spec`.

        Raises:
            InputError: if the request or a file that it names cannot be used.
        """
        ...


def scenario_names() -> list[str]:
    """The scenarios that are installed."""
    return sorted({entry.name for entry in entry_points(group=ENTRY_POINTS)})


def find_scenario(name: str) -> Scenario:
    """The installed scenario of that name.

    Raises:
        InputError: if there is none.
    """
    for entry in entry_points(group=ENTRY_POINTS):
        if entry.name == name:
            scenario: Scenario = entry.load()
            return scenario
    names = scenario_names()
    hint = nearest(name, names) or f"there are: {', '.join(names)}"
    raise InputError(Problem(f"there is no scenario '{name}'", hint=hint))


def declared_metrics(scenario: str) -> tuple[Metric, ...]:
    """What runs of an installed scenario measure; nothing is declared by one that is not installed."""
    return find_scenario(scenario).metrics if scenario in scenario_names() else ()


def choose(kind: str, name: str, known: tuple[str, ...]) -> str:
    """``name``, if it is known.

    Raises:
        InputError: if it is not.
    """
    if name in known:
        return name
    hint = nearest(name, known) or f"there are: {', '.join(known)}"
    raise InputError(Problem(f"there is no {kind} '{name}' for this scenario", hint=hint))


def read_parameters(
    known: Mapping[str, Parameter], given: Mapping[str, Any], where: Callable[[str], Location | None] = lambda _: None
) -> dict[str, Any]:
    """The scenario's own values of the parameters that are given; ``where`` says in which line one was.

    Raises:
        InputError: for every parameter that the scenario does not have, or whose value does not fit.
    """
    values: dict[str, Any] = {}
    problems: list[Problem] = []
    for name, raw in given.items():
        if name not in known:
            hint = nearest(name, known) or f"there are: {', '.join(known) or 'none'}"
            problems.append(Problem(f"this scenario has no parameter '{name}'", where(name), hint))
            continue
        try:
            values[name] = known[name].read(raw)
        except ValueError as error:
            problems.append(Problem(f"{name} is {raw!r}", where(name), str(error)))
    if problems:
        raise InputError(problems)
    return values
