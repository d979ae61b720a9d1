"""Workers of an existing Dask cluster (extra ``cluster``).

The scheduler starts a run again when its worker dies, and gives up on one whose workers die again and again. No more
runs are handed out than there are threads, so that a worker's death is blamed on the run that it had.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from concurrent.futures import CancelledError
from typing import Any

from rosa_core.errors import InputError, Problem
from rosa_evaluation.campaign.workers import (
    RunFailed,
    RunOutcome,
    WorkersError,
    differences,
    perform,
)
from rosa_evaluation.run_record import package_versions
from rosa_evaluation.scenario import RunRequest, Scenario

_CONNECTING_TAKES_AT_MOST = 20.0


class ClusterWorkers:
    """The workers of the Dask scheduler at an address, such as ``tcp://10.0.0.1:8786``.

    Raises:
        InputError: if the extra is not installed, or the address is not one.
        WorkersError: if nobody answers there, there are no workers, or they have other versions of the packages.
    """

    def __init__(self, scenario: Scenario, address: str) -> None:
        try:
            import distributed
        except ImportError:
            mend = "install the extra: pip install 'rosa-coadaptation[cluster]'"
            raise InputError(Problem("--cluster needs Dask", mend=mend)) from None
        self._distributed = distributed
        self._scenario = scenario
        self._address = address
        self._keys: dict[Any, str] = {}
        try:
            self._client = distributed.Client(address, timeout=_CONNECTING_TAKES_AT_MOST, set_as_default=False)
        except OSError:
            mend = "is the scheduler running? start one with: dask scheduler"
            raise WorkersError(str(Problem(f"no Dask scheduler answers at {address}", mend=mend))) from None
        except ValueError as error:
            mend = "an address looks like tcp://10.0.0.1:8786"
            raise InputError(Problem(f"--cluster {address}: {error}", mend=mend)) from None
        try:
            self._check_versions()
        except BaseException:
            self.close()
            raise

    def free(self) -> int:
        """How many threads the cluster has without a run of ours."""
        threads: int = sum(self._client.nthreads().values())
        return max(0, threads - len(self._keys))

    def submit(self, key: str, request: RunRequest) -> None:
        """Hand a run to the scheduler."""
        self._keys[self._client.submit(perform, self._scenario, request, pure=False)] = key

    def finished(self, timeout: float) -> list[tuple[str, RunOutcome]]:
        """The runs that ended since the last call."""
        if not self._keys:
            time.sleep(timeout)
            return []
        try:
            done = self._distributed.wait(list(self._keys), timeout, return_when="FIRST_COMPLETED").done
        except TimeoutError:
            if self._client.status not in ("running", "connecting"):
                raise self._gone() from None
            return []
        except CancelledError:
            raise self._gone() from None
        # In the order of handing out: a set has none.
        return [(self._keys.pop(future), self._outcome(future)) for future in list(self._keys) if future in done]

    def close(self) -> None:
        """Leave the cluster, which goes on without us; what has not ended is cancelled."""
        self._client.close()

    def _outcome(self, future: Any) -> RunOutcome:
        if future.cancelled():
            raise self._gone()
        error = future.exception()
        if isinstance(error, self._distributed.KilledWorker):
            return RunFailed(f"its workers died again and again: {error}")
        if error is not None:
            return RunFailed(f"{type(error).__name__}: {error}")
        outcome: RunOutcome = future.result()
        return outcome

    def _gone(self) -> WorkersError:
        what = f"the Dask scheduler at {self._address} is gone"
        return WorkersError(str(Problem(what, mend="what is finished is kept; the same command goes on")))

    def _check_versions(self) -> None:
        try:
            found: Mapping[str, Any] = self._client.run(package_versions, on_error="return")
        except (OSError, CancelledError):
            raise self._gone() from None
        if not found:
            mend = f"start one with: dask worker {self._address} --nthreads 1"
            raise WorkersError(str(Problem(f"the Dask cluster at {self._address} has no workers", mend=mend)))
        for worker, versions in sorted(found.items()):
            if not isinstance(versions, Mapping):
                mend = "install this package there, in the same version"
                raise WorkersError(str(Problem(f"the worker {worker} cannot run this: {versions}", mend=mend)))
            different = differences(package_versions(), versions)
            if different:
                mend = "install the same versions everywhere, for instance with constraints.txt"
                raise WorkersError(str(Problem(f"the worker {worker} has {', '.join(different)}", mend=mend)))
