"""Workers of an existing Dask cluster (extra ``cluster``).

The scheduler starts a run again when its worker dies, and gives up on one whose workers die again and again. No more
runs are handed out than there are threads, so that a worker's death is blamed on the run that it had.
"""

from __future__ import annotations

from asyncio import CancelledError as TaskCancelled
from collections.abc import Iterator, Mapping
from concurrent.futures import CancelledError as FutureCancelled
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from typing import Any
from urllib.parse import urlsplit

from rosa_core.errors import InputError, Problem
from rosa_evaluation.campaign.workers import (
    RunFailed,
    RunOutcome,
    WorkersError,
    WorkersGoneError,
    differences,
    perform,
)
from rosa_simulation.run_record import package_versions
from rosa_simulation.scenario import RunRequest, Scenario

_CONNECTION_TIMEOUT = 20.0
"""Seconds."""
_PROTOCOLS = ("tcp", "tls", "ws", "wss")


class ClusterWorkers:
    """The workers of a Dask scheduler.

    Args:
        scenario: it is sent with each run, so that pickle must be able to find it by its module and name.
        address: of the scheduler, such as ``tcp://10.0.0.1:8786``.

    Raises:
        InputError: if the extra is not installed, or the address is not one.
        WorkersError: if nobody answers there, there are no workers, or they have other versions of the packages.
    """

    def __init__(self, scenario: Scenario, address: str) -> None:
        _check_address(address)
        try:
            import distributed
        except ImportError:
            hint = "install the extra: pip install 'rosa-coadaptation[cluster]'"
            raise InputError(Problem("--cluster needs Dask", hint=hint)) from None
        self._distributed = distributed
        self._scenario = scenario
        self._address = address
        # Dask drops a task whose future nobody holds.
        self._runs: dict[str, tuple[str, Any]] = {}
        self._ended: SimpleQueue[Any] = SimpleQueue()
        try:
            self._client = distributed.Client(address, timeout=_CONNECTION_TIMEOUT, set_as_default=False)
        except OSError:
            hint = "is the scheduler running? start one with: dask scheduler"
            raise WorkersError(str(Problem(f"no Dask scheduler answers at {address}", hint=hint))) from None
        try:
            self._check_versions()
        except BaseException:
            self.close()
            raise

    def free(self) -> int:
        """How many threads the cluster has without a run of ours."""
        with self._reached():
            threads: int = sum(self._client.nthreads().values())
        return max(0, threads - len(self._runs))

    def submit(self, key: str, request: RunRequest) -> None:
        """Hand a run to the scheduler.

        Args:
            key: of the run, unique in the campaign; its outcome comes back under it.
            request: must be picklable.
        """
        with self._reached():
            future = self._client.submit(perform, self._scenario, request, pure=False)
        self._runs[future.key] = key, future
        future.add_done_callback(self._ended.put)

    def finished(self, timeout: float) -> list[tuple[str, RunOutcome]]:
        """The runs that ended since the last call."""
        outcomes: list[tuple[str, RunOutcome]] = []
        try:
            future = self._ended.get(timeout=timeout)
            while True:
                outcomes.append((self._runs[future.key][0], self._outcome(future)))
                del self._runs[future.key]
                future = self._ended.get_nowait()
        except Empty:
            return outcomes
        except WorkersGoneError:
            if not outcomes:
                raise
            # What has come is handed over first.
            self._ended.put(future)
            return outcomes

    def close(self) -> None:
        """Leave the cluster, which goes on without us; what has not ended is cancelled."""
        self._client.close()

    def _outcome(self, future: Any) -> RunOutcome:
        with self._reached():
            if future.cancelled():
                raise TaskCancelled
            error = future.exception()
            outcome: RunOutcome | None = None if error is not None else future.result()
        if outcome is not None:
            return outcome
        if isinstance(error, self._distributed.KilledWorker):
            return RunFailed(f"its workers died again and again: {error}")
        return RunFailed(f"{type(error).__name__}: {error}")

    @contextmanager
    def _reached(self) -> Iterator[None]:
        try:
            yield
        except (OSError, FutureCancelled, TaskCancelled):
            what = f"the Dask scheduler at {self._address} is gone"
            hint = "what is finished is kept; the same command goes on"
            raise WorkersGoneError(str(Problem(what, hint=hint))) from None

    def _check_versions(self) -> None:
        with self._reached():
            found: Mapping[str, Any] = self._client.run(package_versions, on_error="return")
        if not found:
            hint = f"start one with: dask worker {self._address} --nthreads 1"
            raise WorkersError(str(Problem(f"the Dask cluster at {self._address} has no workers", hint=hint)))
        for worker, versions in sorted(found.items()):
            if not isinstance(versions, Mapping):
                hint = "install this package there, in the same version"
                raise WorkersError(str(Problem(f"the worker {worker} cannot run this: {versions}", hint=hint)))
            different = differences(package_versions(), versions)
            if different:
                hint = "install the same versions everywhere, for instance with constraints.txt"
                raise WorkersError(str(Problem(f"the worker {worker} has {', '.join(different)}", hint=hint)))


def _check_address(address: str) -> None:
    # Dask tries for a long time to reach what is no address at all.
    try:
        parts = urlsplit(address)
        fits = parts.scheme in _PROTOCOLS and bool(parts.hostname) and parts.port is not None
    except ValueError:
        fits = False
    if not fits:
        hint = "an address looks like tcp://10.0.0.1:8786"
        raise InputError(Problem(f"'{address}' is not the address of a Dask scheduler", hint=hint))
