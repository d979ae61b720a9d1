"""Where the runs of a report come from: results of campaigns, run records, CSV files as the exemplar writes them."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_evaluation.campaign import Results, RunState, StoredCampaign, StoredRun
from rosa_evaluation.campaign.schema import FILE_NAME, RESULTS
from rosa_evaluation.exemplar_csv import (
    MISSION_METRICS,
    REACTION_SUFFIXES,
    ExemplarMission,
    reaction_file,
    read_missions,
    read_reactions,
)
from rosa_evaluation.report.spec import report_spec_of
from rosa_evaluation.report.studies import Group, ReportedRun, Study, TimedReaction
from rosa_simulation.metric import Metric
from rosa_simulation.run_reader import RUN_FILE, read_run
from rosa_simulation.run_record import Reaction, RunRecord
from rosa_simulation.scenario import declared_metrics


@dataclass(frozen=True, slots=True)
class Origin:
    """How some of the runs came about: where they are, and what makes them again (nothing, if they are foreign)."""

    path: str
    what: str
    command: str = ""
    seeds: str = ""
    experiment: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    missing: int = 0
    failures: tuple[str, ...] = ()


@dataclass
class _StudyUnderConstruction:
    """The groups of one study, while runs are read: by name, so that none is counted twice."""

    scenario: str
    title: str
    groups: dict[str, tuple[str, dict[str, ReportedRun], set[str]]] = field(default_factory=dict)
    declared: tuple[Metric, ...] = ()

    def add(self, label: str, manager: str, runs: Mapping[str, ReportedRun], failed: Iterable[str] = ()) -> None:
        _, known, known_failed = self.groups.setdefault(label, (manager, {}, set()))
        known.update(runs)
        known_failed.update(failed)

    def study(self) -> Study:
        groups = [
            Group(label, manager, tuple(runs.values()), len(failed))
            for label, (manager, runs, failed) in self.groups.items()
        ]
        declared = (*declared_metrics(self.scenario), *self.declared)
        return Study(self.title, self.scenario, tuple(groups), report_spec_of(self.scenario), declared)


class RunSources:
    """Reads runs from directories and files; a context manager, which keeps results open until they are shown.

    Attributes:
        origins: of everything that was read.
    """

    def __init__(self) -> None:
        self.origins: list[Origin] = []
        self._studies: dict[tuple[str, ...], _StudyUnderConstruction] = {}
        self._open: list[Results] = []

    def __enter__(self) -> RunSources:
        return self

    def __exit__(self, *_: object) -> None:
        for results in self._open:
            results.close()

    def studies(self) -> list[Study]:
        """What was read, in the order in which it came."""
        return [study.study() for study in self._studies.values()]

    def add(self, paths: Sequence[Path]) -> None:
        """Read everything that is in directories and files.

        Raises:
            InputError: for what is none of the three, and what is damaged.
        """
        csv_files: list[Path] = []
        for path in dict.fromkeys(paths):
            if (path / FILE_NAME).is_file():
                self._add_results(path)
            elif (path / RUN_FILE).is_file():
                self._add_run(path)
            else:
                csv_files += _csv_files(path)
        # Last, so that they come into the study of a campaign with the same mission.
        for file in csv_files:
            self._add_csv(file, named=len(csv_files) > 1)

    def _add_results(self, directory: Path) -> None:
        results = Results(directory)
        self._open.append(results)
        campaigns = results.campaigns()
        if not campaigns:
            raise InputError(Problem("no campaign was begun here", Location(str(directory)), "run one first"))
        for campaign in campaigns:
            runs = results.runs(campaign.campaign_id)
            self._add_campaign(results, campaign, runs)
            self.origins.append(_campaign_origin(directory, campaign, runs))

    def _add_campaign(self, results: Results, campaign: StoredCampaign, runs: Sequence[StoredRun]) -> None:
        varied = json.dumps(campaign.experiment, sort_keys=True)
        packages = {name: version for name, version in campaign.versions.items() if name != "python"}
        key = (campaign.scenario, campaign.experiment_name, varied, json.dumps(packages, sort_keys=True))
        study = self._study(key, campaign.scenario, campaign.experiment_name)
        for name, (manager, layer) in campaign.managers.items():
            mine = [run for run in runs if run.manager_name == name]
            done = {run.run_id: _stored_run(results, run) for run in mine if run.state is RunState.DONE}
            failed = (run.run_id for run in mine if run.state is RunState.FAILED)
            study.add(name, name if layer != "bt" else manager, done, failed)

    def _add_run(self, directory: Path) -> None:
        record = read_run(directory)
        layer = "" if record.task_layer == "bt" else f"-{record.task_layer}"
        manager = record.manager + layer
        run = _reported_run(str(record.seed), record.metrics, record.reactions, lambda: record)
        study = self._study((record.scenario, "single runs"), record.scenario, "single runs")
        study.add(manager, manager, {str(directory.resolve()): run})
        command = ["rosa", "run", record.scenario, "--manager", record.manager]
        command += ["--task-layer", record.task_layer, "--seed", str(record.seed), "--out", str(directory)]
        what = f"1 run of {manager} in {record.scenario}"
        origin = Origin(str(directory), what, shlex.join(command), str(record.seed), versions=record.versions)
        self.origins.append(origin)

    def _add_csv(self, file: Path, *, named: bool) -> None:
        missions = read_missions(file)
        reactions = _csv_reactions(file)
        by_mission: dict[tuple[str, str], dict[str, ReportedRun]] = {}
        for number, mission in enumerate(missions):
            scenario, _, manager = mission.mission_name.partition(" ")
            mine = by_mission.setdefault((scenario.replace("_", "-"), manager or "unnamed"), {})
            mine[f"{file.resolve()}:{number}"] = _csv_run(mission, reactions)
        for (scenario, manager), runs in by_mission.items():
            where = f"{file.parent.name}/{file.name}" if named else file.name
            study = self._plain_study(scenario)
            study.add(f"{manager} ({where})", manager, runs)
            study.declared = MISSION_METRICS
        self.origins.append(Origin(str(file), f"{len(missions)} runs in the exemplar's CSV format"))

    def _study(self, key: tuple[str, ...], scenario: str, addition: str) -> _StudyUnderConstruction:
        if key not in self._studies:
            title = f"{scenario}, {addition}" if addition else scenario
            same = sum(study.title.split(" (")[0] == title for study in self._studies.values())
            self._studies[key] = _StudyUnderConstruction(scenario, f"{title} ({same + 1})" if same else title)
        return self._studies[key]

    def _plain_study(self, scenario: str) -> _StudyUnderConstruction:
        """The study of a scenario as it is, if there is one; else one of its own."""
        for study in self._studies.values():
            if study.scenario == study.title == scenario:
                return study
        return self._study((scenario, "csv"), scenario, "")


def _reported_run(
    name: str,
    metrics: Mapping[str, Any],
    reactions: Mapping[str, Sequence[Reaction]],
    load: Callable[[], RunRecord],
) -> ReportedRun:
    timed = {
        uncertainty: tuple(TimedReaction(r.total_s, r.delay_s, r.compute_s) for r in several)
        for uncertainty, several in reactions.items()
    }
    numbers = {name: value for name, value in metrics.items() if isinstance(value, bool | int | float)}
    return ReportedRun(name, numbers, timed, load)


def _stored_run(results: Results, run: StoredRun) -> ReportedRun:
    reported = _reported_run(str(run.seed), run.metrics, run.reactions, partial(results.record, run.run_id))
    try:
        return replace(reported, date=datetime.fromisoformat(run.finished_at))
    except ValueError as error:
        raise RESULTS.damaged(results.path, f"run '{run.run_id}': {error}") from None


def _csv_run(mission: ExemplarMission, reactions: Mapping[tuple[str, object], Mapping[str, Any]]) -> ReportedRun:
    metrics = {
        "pipeline_found": mission.pipeline_found,
        "search_time_s": mission.search_time_s,
        "distance_inspected_m": mission.distance_inspected_m,
    }
    mine = reactions.get((mission.mission_name, mission.date), {})
    return ReportedRun(str(mission.date), metrics, {name: tuple(several) for name, several in mine.items()})


def _csv_reactions(file: Path) -> dict[tuple[str, object], dict[str, list[TimedReaction]]]:
    """The reactions in the files that belong to one of missions, by mission, date and uncertainty."""
    found: dict[tuple[str, object], dict[str, list[TimedReaction]]] = {}
    for uncertainty in REACTION_SUFFIXES:
        reactions = reaction_file(file, uncertainty)
        for row in read_reactions(reactions) if reactions.is_file() else ():
            of_run = found.setdefault((row.mission_name, row.date), {})
            of_run.setdefault(uncertainty, []).append(TimedReaction(row.reaction_time_s))
    return found


def _csv_files(path: Path) -> list[Path]:
    """The files of missions that a path stands for: itself, or all in a directory."""
    if path.is_file():
        return [path]
    suffixes = tuple(REACTION_SUFFIXES.values())
    files = sorted(file for file in path.glob("*.csv") if not file.stem.endswith(suffixes)) if path.is_dir() else []
    if not files:
        what = "there is nothing here that can be reported" if path.exists() else "there is no such file or directory"
        hint = "name a directory of rosa campaign --out or rosa run --out, or CSV files of the SUAVE exemplar"
        raise InputError(Problem(what, Location(str(path)), hint))
    return files


def _campaign_origin(directory: Path, campaign: StoredCampaign, runs: Sequence[StoredRun]) -> Origin:
    managers = list(campaign.managers)
    first, several = campaign.seeds.start, len(campaign.seeds)
    command = ["rosa", "campaign", campaign.scenario, "--managers", ",".join(managers), "--runs", str(several)]
    command += ["--seed", str(first), "--out", str(directory)]
    if campaign.experiment:
        command += ["--experiment", f"{campaign.experiment_name}.yaml"]
    return Origin(
        path=str(directory),
        what=f"{several} runs of each of {', '.join(managers)} in {campaign.scenario}",
        command=shlex.join(command),
        seeds=f"{first} to {first + several - 1}",
        experiment=_experiment_file(campaign),
        versions=campaign.versions,
        missing=campaign.missing,
        failures=tuple(_failures(runs)),
    )


def _failures(runs: Sequence[StoredRun]) -> Iterator[str]:
    for run in runs:
        if run.state is RunState.FAILED:
            reason = (run.error or "no reason is recorded").strip().splitlines()[-1]
            yield f"{run.manager_name}, seed {run.seed}: {reason}"


def _experiment_file(campaign: StoredCampaign) -> str:
    """The experiment as a file that could be given to ``--experiment``."""
    if not campaign.experiment:
        return ""
    import yaml

    text: str = yaml.safe_dump(dict(campaign.experiment), sort_keys=False, allow_unicode=True)
    return text
