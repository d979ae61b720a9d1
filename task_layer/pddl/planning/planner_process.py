"""A solver in a process of its own, which can be ended when time is up, and which may crash without harm.

The process is kept between plans. It is started as ``python -m task_layer.pddl.planning.planner_process`` rather than
forked or spawned, so that programs with threads, and those without a main guard, can plan as well.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from typing import IO, Any

from rosa_core import InputError
from task_layer.pddl.grounding.ground_task import GroundTask, State
from task_layer.pddl.planning.engines import EngineSolver, TimedOperators
from task_layer.pddl.planning.errors import PlannerFailedError

_START_UP = 60.0
"""The most time for the process to start and import the engine, in s; it does not count as planning."""


class ProcessSolver:
    """Plans with an engine of unified-planning in a process of its own, in bounded time.

    Args:
        task: what is to be planned.
        engine: the engine's name.
        timeout: the most time for a plan, in s of wall-clock time.

    Raises:
        InputError: if there is no such engine, or it cannot plan this task.
        PlannerFailedError: if the process cannot be started.
    """

    def __init__(self, task: GroundTask, engine: str, timeout: float) -> None:
        if not timeout > 0:
            raise ValueError(f"the time for planning must be positive, not {timeout}")
        self._task = task
        self._engine = engine
        self._timeout = timeout
        self._reader = ThreadPoolExecutor(1, "planner")
        self._process: subprocess.Popen[bytes] | None = None
        self.overlapping = False
        try:
            self._start()
        except BaseException:
            self.close()
            raise

    def solve(self, state: State, excluded: Collection[int]) -> TimedOperators | None:
        """Ask the process; it is started anew if it has ended."""
        if self._process is None:
            self._start()
        answer = self._ask((state, frozenset(excluded)), self._timeout)
        if isinstance(answer, PlannerFailedError):
            raise answer
        return None if answer is None else [(self._task.operators[index], start) for index, start in answer]

    def close(self) -> None:
        """End the process."""
        self._end()
        self._reader.shutdown()

    def _start(self) -> None:
        # It imports what this process would, and nothing that happens to lie in the current directory.
        path = os.pathsep.join(entry for entry in sys.path if entry)
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "task_layer.pddl.planning.planner_process"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
                env={**os.environ, "PYTHONPATH": path},
            )
        except OSError as error:
            raise PlannerFailedError(f"{self._engine} failed: its process does not start: {error}") from None
        answer = self._ask((self._task, self._engine), _START_UP)
        if isinstance(answer, Exception):
            self._end()
            raise answer
        self.overlapping = answer

    def _ask(self, request: object, timeout: float) -> Any:
        process = self._process
        if process is None or process.stdin is None or process.stdout is None:
            raise PlannerFailedError(f"{self._engine} failed: its process is not there")
        try:
            pickle.dump(request, process.stdin)
            process.stdin.flush()
            return self._reader.submit(pickle.load, process.stdout).result(min(timeout, threading.TIMEOUT_MAX))
        except FutureTimeoutError:
            self._end()
            raise PlannerFailedError(f"{self._engine} found no plan within {timeout:g} s, and was stopped") from None
        except (OSError, EOFError, pickle.UnpicklingError):
            self._end()
            code = process.returncode
            raise PlannerFailedError(f"{self._engine} failed: its process ended with exit code {code}") from None

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        # Engines have processes of their own, which are in its group.
        with suppress(ProcessLookupError, PermissionError):
            if hasattr(os, "killpg"):
                os.killpg(process.pid, signal.SIGKILL)
            else:
                process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                with suppress(OSError):
                    pipe.close()


def serve(requests: IO[bytes], answers: IO[bytes]) -> None:
    """Answer requests until there are no more: first a task and an engine, then states."""

    def answer(given: object) -> None:
        pickle.dump(given, answers)
        answers.flush()

    task, engine = pickle.load(requests)  # noqa: S301  # from the process that started this one
    try:
        solver = EngineSolver(task, engine)
    except InputError as error:
        answer(error)
        return
    answer(solver.overlapping)
    while True:
        try:
            state, excluded = pickle.load(requests)  # noqa: S301
        except EOFError:
            return
        try:
            found = solver.solve(state, excluded)
        except PlannerFailedError as error:
            answer(PlannerFailedError(str(error)))
        else:
            answer(None if found is None else [(operator.index, start) for operator, start in found])


def _end_with(parent: int) -> None:
    """End this process, and the engine's, with its parent: no search goes on that nobody waits for."""
    while os.getppid() == parent:
        time.sleep(1.0)
    os.killpg(0, signal.SIGKILL)


if __name__ == "__main__":
    if hasattr(os, "killpg"):
        threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    private = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # What engines print must not get between the answers.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    serve(sys.stdin.buffer, private)
