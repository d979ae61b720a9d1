"""What carries out runs: the interface of workers, and what happens inside one."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

from rosa_core.errors import RosaError
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, Scenario, SilentObserver


class WorkersError(RosaError):
    """Workers that cannot be started or reached, or that run other versions."""


class WorkersGoneError(WorkersError):
    """Workers that were there, and are gone in the middle of a campaign."""


@dataclass(frozen=True, slots=True)
class RunFailed:
    """The run raised an error, or may not be tried again; ``reason`` is the traceback."""

    reason: str


@dataclass(frozen=True, slots=True)
class WorkerLost:
    """The worker ended in the middle of the run; ``reason`` says how."""

    reason: str


RunOutcome = RunRecord | RunFailed | WorkerLost


class Workers(Protocol):
    """Carry out runs of one scenario, several at a time. A run is known by a key of the caller's."""

    def free(self) -> int:
        """How many more runs can be taken just now."""
        ...

    def submit(self, key: str, request: RunRequest) -> None:
        """Take a run; allowed while :meth:`free` is above 0.

        Args:
            key: by which :meth:`finished` names it.
            request: what to run.

        Raises:
            WorkersGoneError: if there is nobody to take it.
        """
        ...

    def finished(self, timeout: float) -> list[tuple[str, RunOutcome]]:
        """The runs that ended since the last call.

        Args:
            timeout: how long to wait for the first, s.

        Returns:
            key and outcome of each; nothing if none ended in that time.

        Raises:
            WorkersGoneError: if there will be no more.
        """
        ...

    def close(self) -> None:
        """End the workers, or leave them; runs that have not ended are abandoned."""
        ...


_ONE_AT_A_TIME = threading.Lock()


def perform(scenario: Scenario, request: RunRequest) -> RunRecord | RunFailed:
    """Make one run, inside of a worker. Whatever goes wrong in it is an outcome.

    A worker may have several threads; runs are kept apart, since behaviour trees share a blackboard in a process, and
    since the time that managing takes is measured.

    Args:
        scenario: what is run.
        request: how.

    Returns:
        the run's record, or the traceback of what it raised.
    """
    with _ONE_AT_A_TIME:
        try:
            return scenario.run(request, SilentObserver())
        except (Exception, SystemExit):
            return RunFailed(traceback.format_exc())


def differences(versions: Mapping[str, str], others: Mapping[str, str]) -> list[str]:
    """Where the versions that make a run's outcome differ.

    Args:
        versions: by package, as they should be.
        others: by package, as they are.

    Returns:
        a phrase for each package; Python's version makes no difference.

    Example:
        >>> differences({"numpy": "2.1", "python": "3.12"}, {"numpy": "2.0", "python": "3.11"})
        ['numpy 2.0 instead of 2.1']
    """
    return [
        f"{name} {others.get(name, 'missing')} instead of {version}"
        for name, version in versions.items()
        if name != "python" and others.get(name) != version
    ]
