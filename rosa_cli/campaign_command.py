"""``rosa campaign``: many runs under several managers, in parallel; interrupted, it goes on where it stopped."""

from __future__ import annotations

import json
import signal
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, TracebackType

from rich.console import Console

from rosa_cli.campaign_view import CampaignView, campaign_document, print_summary
from rosa_evaluation.campaign import (
    CampaignPlan,
    Conducted,
    Experiment,
    LocalWorkers,
    Results,
    ResultsWriter,
    Workers,
    WorkersGoneError,
    conduct,
    make_plan,
    read_managers,
)
from rosa_evaluation.campaign.local_workers import usable_cores
from rosa_simulation.scenario import Scenario, find_scenario

EXIT_DONE = 0
EXIT_BROKE_OFF = 1
EXIT_INTERRUPTED = 130


@dataclass(frozen=True, slots=True)
class CampaignRequest:
    """The options of the command. ``workers`` are on this machine; ``cluster`` is a Dask scheduler's address."""

    scenario: str
    managers: str
    runs: int
    out: Path
    seed: int
    workers: int | None
    cluster: str | None
    experiment: Path | None
    retry_failed: bool


def run_campaign(request: CampaignRequest, *, quiet: bool, as_json: bool) -> int:
    """Carry a campaign out or on, print what came of it, and return the exit code."""
    scenario = find_scenario(request.scenario)
    managers = read_managers(request.managers, scenario)
    experiment = Experiment() if request.experiment is None else Experiment.load(request.experiment)
    plan = make_plan(scenario, managers, range(request.seed, request.seed + request.runs), experiment)
    began = time.perf_counter()
    try:
        conducted = _conduct(plan, request, CampaignView(Console(stderr=True, highlight=False), quiet=quiet))
    except KeyboardInterrupt:
        return _interrupted("what was finished is kept", request.out)
    except WorkersGoneError as error:
        print(f"rosa: {error}", file=sys.stderr)
        return EXIT_BROKE_OFF
    with Results(request.out) as results:
        runs = results.runs(plan.campaign_id)
    document = campaign_document(plan, conducted, runs, request.out, time.perf_counter() - began)
    if as_json:
        print(json.dumps(document, indent=2, ensure_ascii=False))
    else:
        print_summary(document, scenario.metrics, Console(highlight=False))
    if conducted.missing:
        return _interrupted(f"{conducted.done + conducted.failed} of {len(plan.runs)} runs are there", request.out)
    return EXIT_BROKE_OFF if conducted.failed else EXIT_DONE


def _conduct(plan: CampaignPlan, request: CampaignRequest, view: CampaignView) -> Conducted:
    with ExitStack() as stack:
        interrupts = stack.enter_context(_Interrupts(view.stopping))
        writer = stack.enter_context(ResultsWriter(request.out))
        stack.enter_context(view)
        workers = _workers(plan.scenario, request)
        return conduct(plan, writer, workers, view, retry_failed=request.retry_failed, stopping=interrupts.stopping)


def _workers(scenario: Scenario, request: CampaignRequest) -> Callable[[int], Workers]:
    def start(runs: int) -> Workers:
        if request.cluster is not None:
            from rosa_evaluation.campaign.cluster_workers import ClusterWorkers

            return ClusterWorkers(scenario, request.cluster)
        return LocalWorkers(scenario, min(runs, request.workers or usable_cores()))

    return start


def _interrupted(what: str, out: Path) -> int:
    print(f"rosa: interrupted: {what} in {out}; the same command goes on with the rest", file=sys.stderr)
    return EXIT_INTERRUPTED


class _Interrupts:
    """The first Ctrl-C asks to stop, and the runs that have begun are finished; the second breaks off.

    Args:
        tell: called once, when it is noticed that stopping was asked for.
    """

    def __init__(self, tell: Callable[[], None]) -> None:
        self._tell = tell
        self._asked = self._told = False

    def stopping(self) -> bool:
        """Whether it was pressed."""
        if self._asked and not self._told:
            self._told = True
            self._tell()
        return self._asked

    def __enter__(self) -> _Interrupts:
        self._before = signal.signal(signal.SIGINT, self._pressed)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        signal.signal(signal.SIGINT, self._before)

    def _pressed(self, _signal: int, _frame: FrameType | None) -> None:
        if self._asked:
            raise KeyboardInterrupt
        self._asked = True
