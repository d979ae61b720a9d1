"""What a report is about: the runs of several managing systems in one mission, wherever they come from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from statistics import fmean

from rosa_evaluation.report.spec import PublishedRow, ReportSpec
from rosa_simulation.metric import Metric, find_metric
from rosa_simulation.run_record import RunRecord


@dataclass(frozen=True, slots=True)
class TimedReaction:
    """How long a reaction took, s: in all, and, where that is known, as simulated delay and computing."""

    total_s: float
    delay_s: float | None = None
    compute_s: float | None = None


@dataclass(frozen=True, slots=True)
class ReportedRun:
    """What is shown of one run.

    ``name`` is the seed, or the date of a run of somebody else's.
    ``load`` fetches everything else about it; ``date`` is when it ended, if that is known.
    """

    name: str
    metrics: Mapping[str, float | bool]
    reactions: Mapping[str, tuple[TimedReaction, ...]]
    load: Callable[[], RunRecord] | None = None
    date: datetime | None = None


@dataclass(frozen=True, slots=True)
class Group:
    """The runs under one managing system; ``label`` is unique within its study."""

    label: str
    manager: str
    runs: tuple[ReportedRun, ...]
    failed: int = 0

    def metric(self, name: str) -> list[float]:
        """The values of a metric, one for each run that has it; truth values as 0 and 1."""
        return [float(run.metrics[name]) for run in self.runs if name in run.metrics]

    def reactions(self, uncertainty: str) -> list[TimedReaction]:
        """All reactions of all runs."""
        return [reaction for run in self.runs for reaction in run.reactions.get(uncertainty, ())]

    def mean_reactions(self, uncertainty: str) -> list[float]:
        """The mean reaction time of each run that reacted, s: reactions within one run are not independent."""
        several = (run.reactions.get(uncertainty, ()) for run in self.runs)
        return [fmean(reaction.total_s for reaction in reactions) for reactions in several if reactions]


@dataclass(frozen=True, slots=True)
class Study:
    """Groups to be compared with one another.

    Attributes:
        title: unique within a report.
        scenario: whose runs they are.
        groups: in the order in which they are shown.
        spec: how the scenario wants them to be shown.
        declared: the metrics that the scenario, or the format of a file, declares.
    """

    title: str
    scenario: str
    groups: tuple[Group, ...]
    spec: ReportSpec = field(default_factory=ReportSpec)
    declared: tuple[Metric, ...] = ()

    @property
    def metrics(self) -> list[Metric]:
        """The metrics to be shown, of those that some run has."""
        found: dict[str, float | bool] = {}
        for group in self.groups:
            for run in group.runs:
                found.update(run.metrics)
        names = [name for name in self.spec.metrics or found if name in found]
        return [find_metric(name, self.declared, found[name]) for name in names]

    @property
    def uncertainties(self) -> list[str]:
        """Those that some run reacted to, by name."""
        return sorted(
            {name for group in self.groups for run in group.runs for name, all_ in run.reactions.items() if all_}
        )

    def published(self, group: Group) -> Sequence[PublishedRow]:
        """What was published for the managing system of a group."""
        return [row for row in self.spec.published if row.manager == group.manager]
