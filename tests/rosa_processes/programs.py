"""Small programs to be managed, and ways to wait for what becomes of them."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rosa_core.mape import ComponentState
from rosa_processes import ProcessEntry, ProcessSystem

SOON = 30.0
"""How long to wait for an event that must come, in s; no test depends on how soon it comes."""
FOR_EVER = "import signal; print('ready', flush=True); signal.pause()"


def program(text: str, **declared: Any) -> ProcessEntry:
    """A component that is this Python program."""
    return ProcessEntry(command=(sys.executable, "-I", "-S", "-c", text), **declared)


class Changes:
    """What a system announces, to wait until something is so."""

    def __init__(self, system: ProcessSystem) -> None:
        self._system = system
        self._changed = threading.Condition()
        system.subscribe(self._on_change)

    def _on_change(self, component: str) -> None:
        with self._changed:
            self._changed.notify_all()

    def wait(self, so: Callable[[], object]) -> None:
        with self._changed:
            assert self._changed.wait_for(so, SOON), "it did not come"

    def become(self, component: str, state: ComponentState) -> None:
        self.wait(lambda: self._system.state(component) is state)


def kill(pid: int | None) -> None:
    assert pid is not None
    os.kill(pid, signal.SIGKILL)


def wait_for_end(pids: list[int]) -> None:
    """Until the processes, which need not be children, have ended; by the kernel's word."""
    import select

    for pid in pids:
        try:
            fd = os.pidfd_open(pid)
        except ProcessLookupError:
            continue
        try:
            assert select.select([fd], [], [], SOON)[0], f"{pid} lives on"
        finally:
            os.close(fd)


def lines_of(file: Path, count: int) -> list[str]:
    """The first lines of a file that is being written, once there are so many."""
    import time

    until = time.monotonic() + SOON
    while time.monotonic() < until:
        if file.exists() and len(lines := file.read_text().splitlines()) >= count:
            return lines
        time.sleep(0.005)
    raise AssertionError(f"{file} has not {count} lines")
