"""The statuses that an element can have; the values are the words of the ROSA paper (figure 3)."""

from __future__ import annotations

from enum import StrEnum


class Status(StrEnum):
    """An element has exactly one status at a time."""

    NOT_EVALUATED = "not evaluated"
    SATISFIED = "satisfied"
    VIOLATED = "violated"
    FAILURE = "failure"
    UNFEASIBLE = "unfeasible"
    CONFIGURATION_ERROR = "configuration error"
    IMPLICIT_CONFIGURATION_ERROR = "implicit configuration error"
    UNSOLVED = "unsolved"
    SOLVED = "solved"
    FEASIBLE = "feasible"


class Result(StrEnum):
    """How a required action or a reconfiguration plan ended."""

    COMPLETED = "completed"
    FAILED = "failed"
    ABANDONED = "abandoned"
