"""Whether a process that has been started is ready to do its work."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from rosa_processes.declarations import ReadyEntry

LOOK_EVERY = 0.01
"""How often a process that is starting is looked at, in s."""
PROBE_EVERY = 0.1
"""How long after a probe that has failed the next one is made, in s."""
LONGEST_PROBE = 5.0
"""How long a probe may take, in s."""

StartProbe = Callable[[list[str]], "subprocess.Popen[bytes]"]


class Readiness(Protocol):
    """A way in which a process shows that it is ready; a new one for every start."""

    def hear(self, line: str) -> None:
        """A line of its output."""
        ...

    def is_ready(self) -> bool:
        """Whether it is ready by now; asked every :data:`LOOK_EVERY` seconds until it is; must return at once."""
        ...

    def close(self) -> None:
        """It is ready, or has ended."""
        ...


def readiness(entry: ReadyEntry | None, folder: Path, start_probe: StartProbe) -> Readiness:
    """The way that is declared; call it just before the process is started.

    Args:
        entry: what is declared; None: a process is ready when it runs.
        folder: what files are relative to.
        start_probe: starts a command.
    """
    if entry is None:
        return _Always()
    if entry.line is not None:
        return _ByLine(entry.line)
    if entry.file is not None:
        return _ByFile(folder / entry.file)
    if entry.port is not None:
        return _ByPort(entry.port)
    return _ByProbe(list(entry.probe or ()), start_probe)


class _Always:
    def hear(self, line: str) -> None:
        pass

    def is_ready(self) -> bool:
        return True

    def close(self) -> None:
        pass


class _ByLine(_Always):
    def __init__(self, text: str) -> None:
        self._text = text
        self._seen = False

    def hear(self, line: str) -> None:
        self._seen = self._seen or self._text in line

    def is_ready(self) -> bool:
        return self._seen


class _ByFile(_Always):
    def __init__(self, file: Path) -> None:
        self._file = file
        file.unlink(missing_ok=True)

    def is_ready(self) -> bool:
        return self._file.exists()


class _ByPort(_Always):
    def __init__(self, port: int) -> None:
        self._port = port

    def is_ready(self) -> bool:
        for family, host in ((socket.AF_INET, "127.0.0.1"), (socket.AF_INET6, "::1")):
            with contextlib.suppress(OSError), socket.socket(family, socket.SOCK_STREAM) as connection:
                connection.settimeout(LOOK_EVERY)
                connection.connect((host, self._port))
                return True
        return False


class _ByProbe(_Always):
    def __init__(self, command: list[str], start: StartProbe) -> None:
        self._command = command
        self._start = start
        self._probe: subprocess.Popen[bytes] | None = None
        self._next = self._until = 0.0

    def is_ready(self) -> bool:
        now = time.monotonic()
        if self._probe is None:
            if now >= self._next:
                self._probe, self._until = self._start(self._command), now + LONGEST_PROBE
            return False
        code = self._probe.poll()
        if code is None and now < self._until:
            return False
        self.close()
        self._next = now + PROBE_EVERY
        return code == 0

    def close(self) -> None:
        if self._probe is not None:
            if self._probe.poll() is None:
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(self._probe.pid, 9)
                self._probe.wait()
            self._probe = None
