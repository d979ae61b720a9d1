"""A scenario: a robot in a world with a mission, run under one managing system or another."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_simulation.metric import Metric
from rosa_simulation.run_record import MissionEvent, RunRecord

if TYPE_CHECKING:
    from task_layer.bt import Registry, TreeRunner, TreeSource

ENTRY_POINTS = "rosa.scenarios"


@dataclass(frozen=True, slots=True)
class RunRequest:
    """What to run.

    Attributes:
        manager: the managing system.
        task_layer: the kind of mission, ``bt`` or ``pddl``.
        seed: decides everything that is left to chance.
        time_limit: s of mission time; None: the scenario's own.
        mission_config: a file of the scenario's own kind that says what is uncertain, or how the world is.
        parameters: the values of some of the scenario's parameters, as YAML could hold them.
        mission: instead of the scenario's own mission, a tree in BehaviorTree.CPP XML for the task layer ``bt``:
            a file, a folder, or one of its trees.
        domain: instead of the scenario's own domain, a PDDL file for the task layer ``pddl``.
        problem: the same for the problem.
        video: a file into which the mission is to be filmed.
    """

    manager: str = "rosa"
    task_layer: str = "bt"
    seed: int = 0
    time_limit: float | None = None
    mission_config: Path | None = None
    parameters: Mapping[str, Any] = field(default_factory=dict)
    mission: Path | TreeSource | None = None
    domain: Path | None = None
    problem: Path | None = None
    video: Path | None = None


@dataclass(frozen=True, slots=True)
class MissionFiles:
    """The files of a mission.

    Attributes:
        tree: the mission as a behaviour tree in BehaviorTree.CPP XML; None: there is none.
        domain: the mission's PDDL domain; None: there is none.
        problem: the mission's PDDL problem; None: there is none, or it is made for each run.
    """

    tree: Path | TreeSource | None = None
    domain: Path | None = None
    problem: Path | None = None

    def requested(self, request: RunRequest) -> MissionFiles:
        """The files with those that a request names instead.

        Args:
            request: of the run; what it does not name stays.
        """
        return MissionFiles(
            request.mission or self.tree, request.domain or self.domain, request.problem or self.problem
        )


@dataclass(frozen=True, slots=True)
class Parameter:
    """Something about mission or world that an experiment may set.

    Attributes:
        description: what it is, with its unit.
        read: makes the scenario's own value of a plain one (text, number, truth value, list), or raises a ValueError
            that says what is expected.
        default: its value if nothing sets it, for scenarios that have no settings but their parameters.
    """

    description: str
    read: Callable[[object], Any]
    default: Any = None


class Observer(Protocol):
    """Watches a run while it happens."""

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
    """What an entry point of the group ``rosa.scenarios`` must name.

    :class:`~rosa_simulation.simulated_scenario.SimulatedScenario` is all of it for a simulated robot. A class that does
    it all by itself inherits from this one, and has then the defaults for what it does not offer.
    """

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
        return {}

    @property
    def metrics(self) -> tuple[Metric, ...]:
        """What its runs measure, in the order of their records."""
        return ()

    @property
    def films(self) -> bool:
        """Whether it can film a run into ``RunRequest.video``."""
        return False

    @property
    def takes_missions(self) -> bool:
        """Whether it can run a tree that it is given as ``RunRequest.mission``; it has :meth:`mission_leaves` then."""
        return False

    def mission_leaves(self) -> Registry:
        """The leaves that a tree given to it may name.

        Raises:
            InputError: if it cannot be given one.
        """
        raise InputError(Problem(f"the scenario '{self.name}' takes no mission files", hint="leave --mission out"))

    def report_spec(self) -> Any:
        """How a report shows its runs, as a ``rosa_evaluation.report.ReportSpec``; None: everything they measured."""
        return None

    def check(self, request: RunRequest) -> None:
        """Make sure that the request can be run; costs next to nothing.

        Raises:
            InputError: if it cannot: a manager that this mission does not have, parameters that do not go together.
        """
        ...

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Run the mission to its end.

        Args:
            request: what to run.
            observer: watches it while it happens.

        Raises:
            InputError: if the request or a file that it names cannot be used.
        """
        ...


_OFFERED = (
    *("name", "description", "managers", "task_layers", "parameters", "metrics", "films", "takes_missions"),
    *("mission_leaves", "report_spec", "check", "run"),
)


def scenario_names() -> list[str]:
    """The scenarios that are installed."""
    return sorted({entry.name for entry in entry_points(group=ENTRY_POINTS)})


def find_scenario(name: str) -> Scenario:
    """The installed scenario of that name.

    Args:
        name: the name of its entry point.

    Raises:
        InputError: if there is none, or it is not what a scenario must be.
    """
    for entry in entry_points(group=ENTRY_POINTS):
        if entry.name == name:
            return _load(entry)
    names = scenario_names()
    hint = nearest(name, names) or f"there are: {', '.join(names)}"
    raise InputError(Problem(f"there is no scenario '{name}'", hint=hint))


def _load(entry: EntryPoint) -> Scenario:
    at = f"the entry point '{entry.name} = {entry.value}' of the group {ENTRY_POINTS}"
    try:
        scenario: Scenario = entry.load()
    except (ImportError, AttributeError) as error:
        what = f"the scenario '{entry.name}' cannot be loaded: {error}"
        raise InputError(Problem(what, hint=f"correct {at}")) from error
    # Without computing any property.
    missing = [name for name in _OFFERED if inspect.getattr_static(scenario, name, None) is None]
    if missing:
        hint = "make it a SimulatedScenario, or let its class inherit from rosa_simulation.scenario.Scenario"
        raise InputError(Problem(f"{at} names no scenario: it has no {', '.join(missing)}", hint=hint))
    return scenario


def declared_metrics(scenario: str) -> tuple[Metric, ...]:
    """What runs of an installed scenario measure; nothing is declared by one that is not installed."""
    return find_scenario(scenario).metrics if scenario in scenario_names() else ()


def no_warnings(_: str) -> None:
    """Discard a warning: for asking only whether a request can be run."""


def choose(kind: str, name: str, known: tuple[str, ...]) -> str:
    """``name``, if it is known.

    Args:
        kind: what the names are of, for the error, such as ``manager``.
        name: that is asked for.
        known: those that there are.

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
    """The scenario's own values of the parameters that are given.

    Args:
        known: the scenario's parameters by name.
        given: values by name, as they stand in a file or on the command line.
        where: from a name to the line in which it is given, for the errors.

    Returns:
        values by name, only of those given.

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
