"""What the exit code of a command says."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes of all commands."""

    DONE = 0
    """Also a mission that ran to its designed end, whatever it achieved."""
    BROKE_OFF = 1
    """Or the answer is no: a run failed, there is no plan."""
    BAD_INPUT = 2
    PLANNER_FAILED = 3
    INTERRUPTED = 130
