"""Ends what a manager has started when the manager itself has ended, however that happened (Linux only).

A program of its own, started with ``python -I -S keeper.py MANAGER_PID MARK`` by :mod:`rosa_processes.supervisor`. It
imports nothing but the standard library, and waits until its standard input or the manager's process has ended. Then it
kills every process that has the mark in its environment, which children and their children inherit, wherever they have
moved: into another process group, session or parent.
"""

from __future__ import annotations

import contextlib
import os
import select
import signal
import sys
import time

VARIABLE = "ROSA_PROCESSES_MARK"
"""The environment variable that marks what a manager has started."""
_CLEAN_ROUNDS = 5
_BETWEEN_ROUNDS = 0.02
_LONGEST_START = 2.0
"""How long, in s, a process may be between having been forked by the manager and becoming another program."""


def marked(mark: str) -> list[int]:
    """The processes of this user that have a mark, perhaps among others: managers may manage managers."""
    name_in, mark_in = f"{VARIABLE}=".encode(), mark.encode()
    found = []
    for name in os.listdir("/proc"):  # noqa: PTH208  # pathlib would double the start-up time
        if name.isdigit() and int(name) != os.getpid():
            with contextlib.suppress(OSError), open(f"/proc/{name}/environ", "rb") as file:  # noqa: PTH123
                if any(entry.startswith(name_in) and mark_in in entry for entry in file.read().split(b"\0")):
                    found.append(int(name))
    return found


def kill_marked(mark: str, timeout: float = 10.0) -> None:
    """Kill what has a mark until there is nothing left of it.

    Args:
        mark: the mark.
        timeout: when to give up, in s: what waits for a broken device cannot be killed.
    """
    clean, until = 0, time.monotonic() + timeout
    while clean < _CLEAN_ROUNDS and time.monotonic() < until:
        processes = marked(mark)
        for pid in processes:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        # What was being started in the meantime shows its mark a moment later.
        clean = 0 if processes else clean + 1
        time.sleep(_BETWEEN_ROUNDS)


def main(manager: int, mark: str) -> None:
    """Wait for the end of the manager, and clear up."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    with contextlib.suppress(ProcessLookupError):
        ended = os.pidfd_open(manager)
        if os.getppid() == manager:
            select.select([sys.stdin.fileno(), ended], [], [])
    # What the manager was just forking has no mark yet, but it holds the other end of the pipe until it has one.
    select.select([sys.stdin.fileno()], [], [], _LONGEST_START)
    kill_marked(mark)


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2])
