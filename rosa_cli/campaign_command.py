"""``rosa campaign``: many runs under several managers, in parallel; interrupted, it goes on where it stopped."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from types import FrameType, TracebackType

from rich.console import Console

from rosa_cli.campaign_view import CampaignView, campaign_document, print_summary
from rosa_cli.exit_codes import ExitCode
from rosa_cli.options import CampaignOptions
from rosa_cli.output import print_json
from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_evaluation.campaign import (
    CampaignOutcome,
    CampaignPlan,
    Experiment,
    LocalWorkers,
    Results,
    ResultsWriter,
    Workers,
    WorkersGoneError,
    execute_campaign,
    make_plan,
    read_managers,
)
from rosa_evaluation.campaign.local_workers import usable_cores
from rosa_simulation.scenario import Scenario, find_scenario


def run_campaign(options: CampaignOptions) -> ExitCode:
    """Carry a campaign out or on, and print what came of it.

    Raises:
        InputError: if the options do not fit together, or a file cannot be used.
        WorkersError: if workers cannot be started or reached.
    """
    if options.workers is not None and options.cluster is not None:
        raise InputError(Problem("--workers and --cluster exclude each other", hint="leave one of them out"))
    scenario = find_scenario(options.scenario)
    managers = read_managers(options.managers, scenario)
    experiment = Experiment() if options.experiment is None else Experiment.load(options.experiment)
    plan = make_plan(scenario, managers, range(options.seed, options.seed + options.runs), experiment)
    began = time.perf_counter()
    try:
        outcome = _execute(plan, options, CampaignView(Console(stderr=True, highlight=False), quiet=options.quiet))
    except KeyboardInterrupt:
        return _interrupted("what was finished is kept", options.out)
    except WorkersGoneError as error:
        print(f"rosa: {error}", file=sys.stderr)
        return ExitCode.BROKE_OFF
    with Results(options.out) as results:
        runs = results.runs(plan.campaign_id)
    document = campaign_document(plan, outcome, runs, options.out, time.perf_counter() - began)
    if options.as_json:
        print_json(document)
    else:
        print_summary(document, scenario.metrics, Console(highlight=False))
    if outcome.missing:
        return _interrupted(f"{outcome.done + outcome.failed} of {len(plan.runs)} runs are there", options.out)
    return ExitCode.BROKE_OFF if outcome.failed else ExitCode.DONE


def _execute(plan: CampaignPlan, options: CampaignOptions, view: CampaignView) -> CampaignOutcome:
    with ExitStack() as stack:
        interrupts = stack.enter_context(_Interrupts(view.stopping))
        writer = stack.enter_context(ResultsWriter(options.out))
        stack.enter_context(view)
        workers = _workers(plan.scenario, options)
        return execute_campaign(
            plan, writer, workers, view, retry_failed=options.retry_failed, stopping=interrupts.stopping
        )


def _workers(scenario: Scenario, options: CampaignOptions) -> Callable[[int], Workers]:
    def start(runs: int) -> Workers:
        if options.cluster is not None:
            from rosa_evaluation.campaign.cluster_workers import ClusterWorkers

            return ClusterWorkers(scenario, options.cluster)
        return LocalWorkers(scenario, min(runs, options.workers or usable_cores()))

    return start


def _interrupted(what: str, out: Path) -> ExitCode:
    print(f"rosa: interrupted: {what} in {out}; the same command goes on with the rest", file=sys.stderr)
    return ExitCode.INTERRUPTED


class _Interrupts:
    """The first Ctrl-C asks to stop, and the runs that have begun are finished; the second breaks off.

    Args:
        on_first: called once, when it is noticed that stopping was asked for.
    """

    def __init__(self, on_first: Callable[[], None]) -> None:
        self._on_first = on_first
        self._asked = self._noticed = False

    def stopping(self) -> bool:
        """Whether it was pressed."""
        if self._asked and not self._noticed:
            self._noticed = True
            self._on_first()
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
