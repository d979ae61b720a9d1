"""The thread in which processes are started, heard and ended, and the keeper that ends them if the manager dies.

Processes are told to die with the thread that started them (``PR_SET_PDEATHSIG``, set by ``setpriv``), so that thread
must live as long as they do: it is the supervisor's own. What they in turn have started, the keeper kills
(:mod:`rosa_processes.keeper`).
"""

from __future__ import annotations

import asyncio
import logging
import os
import shutil
import subprocess
import sys
import threading
import uuid
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

from rosa_processes import keeper

logger = logging.getLogger(__name__)

_T = TypeVar("_T")


class Supervisor:
    """An event loop in a thread of its own, with a keeper beside it. Close it at the end.

    Raises:
        OSError: if this is not Linux: elsewhere nothing says at once that a process has ended.
    """

    def __init__(self) -> None:
        if not hasattr(os, "pidfd_open"):
            raise OSError("processes can be managed on Linux only: os.pidfd_open is needed")
        self.mark = uuid.uuid4().hex
        """What the processes have in their environment, in :data:`keeper.VARIABLE`."""
        # A manager that is itself managed keeps the mark by which it is ended.
        self._marks = ":".join(filter(None, (os.environ.get(keeper.VARIABLE), self.mark)))
        setpriv = shutil.which("setpriv")
        self._prefix = [] if setpriv is None else [setpriv, "--pdeathsig", "KILL", "--"]
        self.loop = asyncio.new_event_loop()
        self._closing = False
        self._thread = threading.Thread(target=self._run, name="rosa supervisor", daemon=True)
        self._thread.start()
        self.call(self._start_keeper).result()

    def call(self, function: Callable[[], _T]) -> Future[_T]:
        """Call a function in the thread; any thread may ask for that."""
        answer: Future[_T] = Future()

        def work() -> None:
            try:
                answer.set_result(function())
            except BaseException as error:
                answer.set_exception(error)

        self.loop.call_soon_threadsafe(work)
        return answer

    def start(
        self,
        command: list[str],
        *,
        environment: dict[str, str],
        folder: str,
        stdin: int = subprocess.DEVNULL,
        stdout: int = subprocess.DEVNULL,
    ) -> subprocess.Popen[bytes]:
        """Start a process, in a process group of its own; call this in the thread.

        Args:
            command: the program and its arguments.
            environment: all of its environment but the mark.
            folder: where it works.
            stdin: as for ``Popen``.
            stdout: likewise; errors go to the same place.

        Raises:
            OSError: if it cannot be started.
        """
        return subprocess.Popen(  # noqa: S603  # the robot's own programs, as its owner declares them
            [*self._prefix, *command],
            env={**environment, keeper.VARIABLE: self._marks},
            cwd=folder,
            stdin=stdin,
            stdout=stdout,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def when_ended(self, process: subprocess.Popen[bytes], then: Callable[[], None]) -> None:
        """Call a function in the thread when a process has ended, before it is waited for; call this in the thread."""
        fd = os.pidfd_open(process.pid)

        def ended() -> None:
            self.loop.remove_reader(fd)
            os.close(fd)
            then()

        self.loop.add_reader(fd, ended)

    def close(self, timeout: float = 10.0) -> None:
        """Kill whatever is left, and end. Closing it again does nothing."""
        if self._closing:
            return
        self._closing = True
        stdin = self._keeper.stdin
        if stdin is not None:
            stdin.close()
        try:
            self._keeper.wait(timeout)
        except subprocess.TimeoutExpired:
            logger.error("processes with %s=%s cannot be killed", keeper.VARIABLE, self.mark)
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join(timeout)

    def _run(self) -> None:
        try:
            self.loop.run_forever()
        finally:
            self.loop.close()

    def _start_keeper(self) -> None:
        # Not marked: it is not to kill itself.
        self._keeper = subprocess.Popen(  # noqa: S603
            [sys.executable, "-I", "-S", keeper.__file__, str(os.getpid()), self.mark],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            start_new_session=True,
        )
        self.when_ended(self._keeper, self._replace_keeper)

    def _replace_keeper(self) -> None:
        if not self._closing:
            logger.warning("the keeper has ended; another one takes its place")
            self._keeper.wait()
            if self._keeper.stdin is not None:
                self._keeper.stdin.close()
            self._start_keeper()
