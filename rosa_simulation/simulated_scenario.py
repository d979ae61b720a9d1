"""A scenario of a simulated robot, declared: what is the same for all robots is here, what is not is named."""

from __future__ import annotations

import pkgutil
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.managers.registry import load_manager, manager_entries, manager_entry
from rosa_simulation.metric import Metric
from rosa_simulation.parameters import requested_parameters
from rosa_simulation.plans import awaited_actions, check_planning, why_given_up
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import (
    MissionFiles,
    Observer,
    Parameter,
    RunRequest,
    SilentObserver,
    choose,
    find_scenario,
    no_warnings,
)

if TYPE_CHECKING:
    from rosa_simulation.mission import Mission
    from rosa_simulation.robot_event import RobotEvent
    from rosa_simulation.simulation import Simulation
    from task_layer.bt import Registry, TreeRunner
    from task_layer.pddl import PlanExecutor

Configure: TypeAlias = "Callable[[RunRequest, Callable[[str], None]], Any]"
"""Reads the settings of a run from its request. It is also given a function that warns the user, in words."""
Assemble: TypeAlias = "Callable[[Any, Simulation], Mission]"
"""Makes robot, world and mission of the settings, on a simulation."""
Film: TypeAlias = "Callable[[Path], Callable[[RunRecord], None]]"
"""Makes sure that a video can be written to a path, and returns what will film a run into it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SimulatedScenario:
    """A robot in its world with a mission, run under one managing system or another; a ``Scenario``.

    Functions may be named as ``module:function``; they are then imported when they are needed, so that listing the
    scenarios does not load simulators. Pickling a scenario keeps its name only: it is found again by its entry point.

    Attributes:
        name: what it is called on the command line, and what its entry point is called.
        description: one line on what it is about.
        assemble: makes the :class:`~rosa_simulation.mission.Mission` of a run.
        configure: makes the settings that ``assemble`` is given; None: they are the values of all parameters by name.
        files: the mission; with a PDDL domain it can also be run as a plan.
        parameters: what an experiment may set.
        metrics: what a run measures, in the order of its record.
        own_managers: managing systems besides ``rosa`` and ``none``, each as ``module:function``. Other packages can
            bring more (:mod:`rosa_simulation.managers.registry`).
        tree_managers: those of them that have a tree of their own, in which mission and adaptation are one.
        waking: the robot's events at which the task layer looks at once what is to be done.
        columns: names of the values of :attr:`Mission.sample`, which make the trajectory.
        film: how a run is filmed; None: it cannot be.
        spec: makes the ``rosa_evaluation.report.ReportSpec``; None: a report shows everything that was measured.
    """

    name: str
    description: str
    assemble: str | Assemble
    configure: str | Configure | None = None
    files: MissionFiles
    parameters: Mapping[str, Parameter] = field(default_factory=dict)
    metrics: tuple[Metric, ...] = ()
    own_managers: Mapping[str, str] = field(default_factory=dict)
    tree_managers: Collection[str] = ()
    waking: Collection[Enum] = ()
    columns: tuple[str, ...] = ()
    film: str | Film | None = None
    spec: str | Callable[[], Any] | None = None

    def __reduce__(self) -> tuple[Callable[[str], Any], tuple[str]]:
        return find_scenario, (self.name,)

    @property
    def managers(self) -> tuple[str, ...]:
        """The managing systems that are there for it; none of them is imported."""
        return tuple(manager_entries(self.name, self.own_managers))

    @property
    def task_layers(self) -> tuple[str, ...]:
        """The kinds of mission that it has."""
        return ("bt",) if self.files.domain is None else ("bt", "pddl")

    @property
    def films(self) -> bool:
        """Whether a run can be filmed."""
        return self.film is not None

    @property
    def takes_missions(self) -> bool:
        """It runs any tree that names its leaves."""
        return True

    def models(self) -> tuple[Path, ...]:
        """The files of its robot's knowledge model."""
        return self._usual_mission().models

    def mission_leaves(self) -> Registry:
        """The leaves that a mission file may name."""
        mission = self._usual_mission()
        return mission.managed_leaves(mission.knowledge_base())

    def _usual_mission(self) -> Mission:
        request = RunRequest()
        return self._assemble(request, self._configure(request, no_warnings), SilentObserver())

    def report_spec(self) -> Any:
        """How a report shows its runs."""
        return None if self.spec is None else _resolve(self.spec)()

    def check(self, request: RunRequest) -> None:
        """Make sure that there are such a manager, task layer, mission and parameters, and that they go together.

        Raises:
            InputError: if not.
        """
        self._settings(request, no_warnings)

    def run(self, request: RunRequest, observer: Observer) -> RunRecord:
        """Run the mission until the task layer is done with it, or the robot's mission is over.

        Args:
            request: what to run.
            observer: watches it while it happens.

        Raises:
            InputError: if the request or a file that it names cannot be used.
        """
        settings = self._settings(request, observer.warning)
        if request.video is None:
            return self._run(request, settings, observer)
        if self.film is None:
            raise InputError(Problem(f"the scenario '{self.name}' cannot be filmed", hint="leave --video out"))
        # What films is prepared before the simulator is loaded, which may depend on it.
        film = _resolve(self.film)(request.video)
        record = self._run(request, settings, observer)
        film(record)
        return record

    def _settings(self, request: RunRequest, warn: Callable[[str], None]) -> Any:
        manager_entry(self.name, self.own_managers, request.manager)
        choose("task layer", request.task_layer, self.task_layers)
        check_planning(request)
        if request.mission is not None and request.manager in self.tree_managers:
            what = f"the manager '{request.manager}' has a tree of its own, in which mission and adaptation are one"
            raise InputError(Problem(what, hint="leave --mission out, or fly it with another manager"))
        return self._configure(request, warn)

    def _configure(self, request: RunRequest, warn: Callable[[str], None]) -> Any:
        if self.configure is None:
            defaults = {name: parameter.default for name, parameter in self.parameters.items()}
            return defaults | requested_parameters(self.parameters, request)
        return _resolve(self.configure)(request, warn)

    def _assemble(self, request: RunRequest, settings: Any, observer: Observer) -> Mission:
        from rosa_simulation.simulation import Simulation

        mission: Mission = _resolve(self.assemble)(
            settings, Simulation(request, self.files.requested(request), observer)
        )
        return mission

    def _run(self, request: RunRequest, settings: Any, observer: Observer) -> RunRecord:
        from py_trees.common import Status

        from task_layer.bt import TreeRunner
        from task_layer.pddl import ExecutionStatus

        mission = self._assemble(request, settings, observer)
        robot, recorder, simulation = mission.robot, mission.recorder, mission.simulation
        observer.started(mission.time_limit)
        with self._runner(request, mission) as runner:
            simulation.set_runner(runner)
            robot.on_event.append(self._wake(simulation))
            recorder.sample(self.columns, mission.sample, period=mission.sample_period)
            mission.begin()
            if isinstance(runner, TreeRunner):
                observer.tree(runner)
            ended = runner.run(until=lambda: robot.over, timeout=mission.timeout)
        ran = recorder.close()
        gave_up = why_given_up(runner, ended)
        failed = ended in (Status.FAILURE, ExecutionStatus.FAILURE)
        return recorder.record(
            self.name,
            request,
            duration=mission.duration(ran),
            completed=not gave_up and mission.completed(failed),
            ended_by=gave_up or mission.ended_by(failed),
            inputs=mission.inputs,
            metrics=mission.summary(ran),
            reactions=mission.reaction_times.reactions,
            waiting_for=awaited_actions(runner),
        )

    def _runner(self, request: RunRequest, mission: Mission) -> TreeRunner | PlanExecutor:
        if request.task_layer == "bt":
            return load_manager(manager_entry(self.name, self.own_managers, request.manager))(mission)
        from rosa_simulation.managers.rosa_pddl import rosa_pddl_manager

        return rosa_pddl_manager(mission)

    def _wake(self, simulation: Simulation) -> Callable[[RobotEvent], None]:
        waking = frozenset(self.waking)

        def wake(event: RobotEvent) -> None:
            if event.kind in waking:
                simulation.wake()

        return wake


def _resolve(function: str | Callable[..., Any]) -> Callable[..., Any]:
    """The function, imported if it is only named."""
    found: Callable[..., Any] = pkgutil.resolve_name(function) if isinstance(function, str) else function
    return found
