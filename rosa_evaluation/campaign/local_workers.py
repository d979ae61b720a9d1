"""Workers in processes of this machine; one that dies is replaced.

Each worker has a pipe of its own, so that it is known which run a worker had when it died, and so that workers end by
themselves when their parent does, however it does.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from rosa_evaluation.campaign.workers import RunOutcome, WorkerLost, WorkersError, perform
from rosa_simulation.scenario import RunRequest, Scenario

_READY = "ready"
_START_TIMEOUT = 120.0
"""Seconds."""


def usable_cores() -> int:
    """How many cores this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


class LocalWorkers:
    """Processes of this machine that carry out runs of a scenario.

    Args:
        scenario: it is sent to each process once, so that pickle must be able to find it by its module and name.
        count: how many processes.

    Raises:
        WorkersError: if a process cannot be started.
    """

    def __init__(self, scenario: Scenario, count: int) -> None:
        self._scenario = scenario
        self._workers: list[_Worker] = []
        try:
            self._workers.extend(_Worker(scenario) for _ in range(count))
            for worker in self._workers:
                worker.await_ready()
        except BaseException:
            self.close()
            raise

    def free(self) -> int:
        """How many workers have nothing to do."""
        return sum(worker.key is None for worker in self._workers)

    def submit(self, key: str, request: RunRequest) -> None:
        """Give a run to a worker that has none; one that has died meanwhile is replaced first.

        Args:
            key: of the run, unique in the campaign; its outcome comes back under it.
            request: must be picklable.

        Raises:
            StopIteration: if every worker has a run.
        """
        index = next(index for index, worker in enumerate(self._workers) if worker.key is None)
        try:
            self._workers[index].send(key, request)
        except (BrokenPipeError, ConnectionResetError):
            self._replace(index).send(key, request)

    def finished(self, timeout: float) -> list[tuple[str, RunOutcome]]:
        """The runs that ended since the last call.

        Args:
            timeout: how long to wait for the first, s.

        Returns:
            key and outcome of each; nothing if none ended in that time.
        """
        ended = set(wait([worker.connection for worker in self._workers if worker.key is not None], timeout))
        outcomes: list[tuple[str, RunOutcome]] = []
        for index, worker in enumerate(self._workers):
            if worker.key is not None and worker.connection in ended:
                key, outcome = worker.key, worker.receive()
                outcomes.append((key, outcome))
                if isinstance(outcome, WorkerLost):
                    self._replace(index)
        return outcomes

    def close(self) -> None:
        """End the processes."""
        for worker in self._workers:
            worker.kill()
        for worker in self._workers:
            worker.join()
        self._workers.clear()

    def _replace(self, index: int) -> _Worker:
        self._workers[index].kill()
        self._workers[index].join()
        worker = self._workers[index] = _Worker(self._scenario)
        worker.await_ready()
        return worker


class _Worker:
    """A process, the pipe to it, and the run that it has."""

    def __init__(self, scenario: Scenario) -> None:
        # Spawned, not forked: a child has nothing of its parent's threads, locks and files.
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.key: str | None = None
        self._process: BaseProcess = context.Process(target=_work, args=(theirs, scenario), daemon=True)
        try:
            self._process.start()
        except (OSError, AttributeError, TypeError) as error:
            raise WorkersError(f"a worker process cannot be started: {error}") from error
        finally:
            theirs.close()

    def await_ready(self) -> None:
        try:
            if self.connection.poll(_START_TIMEOUT) and self.connection.recv() == _READY:
                return
        except (EOFError, ConnectionResetError):
            pass
        raise WorkersError(f"a worker process does not start: {self._ending()}")

    def send(self, key: str, request: RunRequest) -> None:
        self.connection.send(request)
        self.key = key

    def receive(self) -> RunOutcome:
        self.key = None
        try:
            outcome: RunOutcome = self.connection.recv()
        except (EOFError, ConnectionResetError):
            return WorkerLost(self._ending())
        return outcome

    def kill(self) -> None:
        self.connection.close()
        self._process.kill()

    def join(self) -> None:
        self._process.join()
        self._process.close()

    def _ending(self) -> str:
        self._process.join(timeout=10.0)
        code = self._process.exitcode
        if code is None:
            return "it hangs"
        if code >= 0:
            return f"it ended with exit code {code}"
        try:
            return f"it was ended by signal {signal.Signals(-code).name}"
        except ValueError:
            return f"it was ended by signal {-code}"


def _work(connection: Connection, scenario: Scenario) -> None:
    """The life of a worker: runs, one after the other, until the other end of the pipe is gone."""
    # Ctrl-C reaches every process of a terminal; what it means is decided by the campaign.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        connection.send(_READY)
        while True:
            connection.send(perform(scenario, connection.recv()))
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass
