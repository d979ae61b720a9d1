"""The problems of one file or one tree, as many as anybody wants to read."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from rosa_core.errors import Location, Problem
from task_layer.bt.xml.limits import MAX_PROBLEMS


class TooManyProblemsError(Exception):
    """There are so many problems that looking for more is no use."""


@dataclass(slots=True)
class ProblemList:
    """Collects the problems of one file or one tree.

    Attributes:
        found: the problems, in order.
    """

    found: list[Problem] = field(default_factory=list)

    def add(self, what: str, where: Location | None, hint: str | None = None) -> None:
        """Add a problem.

        Raises:
            TooManyProblemsError: if there are too many to go on.
        """
        self.found.append(Problem(what, where, hint))
        if len(self.found) >= MAX_PROBLEMS:
            raise TooManyProblemsError


def first_problems(problems: Iterable[Problem], where: Location) -> list[Problem]:
    """The problems without repetitions; the first of them, and that there may be more, if there are too many."""
    different = list(dict.fromkeys(problems))
    if len(different) < MAX_PROBLEMS:
        return different
    return [*different[:MAX_PROBLEMS], Problem("that is enough; there may be more", where)]
