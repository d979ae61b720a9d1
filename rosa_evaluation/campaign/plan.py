"""Which runs a campaign consists of: every manager with the same seeds and the same draws, in pairs."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Problem, nearest
from rosa_evaluation.campaign.experiment import Experiment
from rosa_simulation.run_record import package_versions
from rosa_simulation.scenario import RunRequest, Scenario, read_parameters

_ID_DIGITS = 24


@dataclass(frozen=True, slots=True)
class ManagerSpec:
    """A manager with a task layer.

    Attributes:
        name: on the command line, such as ``rosa-pddl``.
        manager: such as ``rosa``.
        task_layer: ``bt`` or ``pddl``.
    """

    name: str
    manager: str
    task_layer: str


@dataclass(frozen=True, slots=True)
class PlannedRun:
    """One run of a campaign.

    Attributes:
        run_id: the same whenever scenario, manager, task layer, seed, inputs and versions are.
        manager: with its task layer.
        request: what the scenario is asked to run.
    """

    run_id: str
    manager: ManagerSpec
    request: RunRequest


@dataclass(frozen=True, slots=True)
class CampaignPlan:
    """A campaign: the same seeds for each manager.

    Attributes:
        scenario: what is run.
        managers: in the order in which they were named.
        seeds: one run for each, under each manager.
        experiment: what is set, and what is drawn anew for each seed.
        runs: in the order in which they are carried out: all managers with one seed, then with the next.
        versions: of the packages that make the outcome; part of every run's id, except Python's.
    """

    scenario: Scenario
    managers: tuple[ManagerSpec, ...]
    seeds: range
    experiment: Experiment
    runs: tuple[PlannedRun, ...]
    versions: Mapping[str, str] = field(default_factory=package_versions)

    @property
    def campaign_id(self) -> str:
        """The same for the same runs, when managers and experiment are called the same."""
        names = [manager.name for manager in self.managers]
        return _digest([names, self.experiment.name, [run.run_id for run in self.runs]])


def read_managers(text: str, scenario: Scenario) -> tuple[ManagerSpec, ...]:
    """Managers from a list with commas.

    Args:
        text: such as ``none,rosa,rosa-pddl``; ``rosa-pddl`` is the manager ``rosa`` with the task layer ``pddl``.
        scenario: whose managers and task layers they are.

    Returns:
        the managers in that order; one without a task layer has the scenario's first.

    Raises:
        InputError: if the scenario does not have one of them, or one is there twice.
    """
    known = {spec.name: spec for spec in _specs(scenario)}
    specs: list[ManagerSpec] = []
    for name in (part.strip() for part in text.split(",")):
        if name not in known:
            hint = nearest(name, known) or f"there are: {', '.join(known)}"
            raise InputError(Problem(f"there is no manager '{name}' for this scenario", hint=hint))
        spec = known[name]
        same = next((other.name for other in specs if _same(other, spec)), None)
        if same is not None:
            raise InputError(Problem(f"--managers has '{same}' and '{name}', which is the same", hint="name it once"))
        specs.append(spec)
    return tuple(specs)


def _specs(scenario: Scenario) -> Iterator[ManagerSpec]:
    for manager in scenario.managers:
        yield ManagerSpec(manager, manager, scenario.task_layers[0])
        for layer in scenario.task_layers:
            yield ManagerSpec(f"{manager}-{layer}", manager, layer)


def _same(one: ManagerSpec, other: ManagerSpec) -> bool:
    return (one.manager, one.task_layer) == (other.manager, other.task_layer)


def make_plan(
    scenario: Scenario, managers: tuple[ManagerSpec, ...], seeds: range, experiment: Experiment | None = None
) -> CampaignPlan:
    """Plan a campaign; whatever is wrong with it is found here, before anything runs.

    Args:
        scenario: what is run.
        managers: each has all seeds.
        seeds: of the runs.
        experiment: what is set or drawn; nothing by default.

    Returns:
        the plan, in which a run's id follows from its inputs and the versions of the packages.

    Raises:
        InputError: if the scenario refuses a manager, or a parameter that the experiment sets or draws.
    """
    experiment = experiment or Experiment()
    drawn = {seed: experiment.draw(seed) for seed in seeds}
    for parameters in drawn.values():
        read_parameters(scenario.parameters, parameters, experiment.where)
    versions = package_versions()
    runs = []
    for seed in seeds:
        for manager in managers:
            request = RunRequest(manager.manager, manager.task_layer, seed, parameters=drawn[seed])
            scenario.check(request)
            runs.append(PlannedRun(_run_id(scenario, request, versions), manager, request))
    return CampaignPlan(scenario, managers, seeds, experiment, tuple(runs), versions)


def _run_id(scenario: Scenario, request: RunRequest, versions: Mapping[str, str]) -> str:
    # A patch release of Python changes no outcome, and would have everything run again.
    packages = {name: version for name, version in versions.items() if name != "python"}
    parameters = dict(request.parameters)
    return _digest([scenario.name, request.manager, request.task_layer, request.seed, parameters, packages])


def _digest(value: Any) -> str:
    text = json.dumps(value, sort_keys=True, ensure_ascii=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:_ID_DIGITS]
