"""The errors of the framework: each says what is wrong, where, and how to fix it."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass


class RosaError(Exception):
    """Base of every error that is somebody's input or request, not a defect of the program."""


@dataclass(frozen=True, slots=True)
class Location:
    """A place in a file; ``line`` counts from 1."""

    file: str
    line: int | None = None

    def __str__(self) -> str:
        return self.file if self.line is None else f"{self.file}:{self.line}"


@dataclass(frozen=True, slots=True)
class Problem:
    """What is wrong with an input, where, and a hint how to fix it, as far as there are any."""

    what: str
    where: Location | None = None
    hint: str | None = None

    def __str__(self) -> str:
        text = self.what if self.where is None else f"{self.where}: {self.what}"
        return text if self.hint is None else f"{text} ({self.hint})"


class InputError(RosaError):
    """A file or a command line that cannot be used. ``problems`` holds every one that was found."""

    def __init__(self, problems: Problem | str | Sequence[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))


class KnowledgeModelError(InputError):
    """A knowledge model that cannot be read or does not hold together."""


class KnowledgeBaseError(RosaError):
    """A write or a question that the knowledge base refuses; it has changed nothing."""


class UnknownElementError(KnowledgeBaseError, LookupError):
    """The knowledge base has no element of that kind and name."""


class RequestRefusedError(KnowledgeBaseError):
    """An action was requested that is unfeasible; the message gives the chain of reasons."""


class QueryError(InputError, KnowledgeBaseError):
    """A query that cannot be answered: it cannot be read, asks for what is not known, or would take too long."""


class InvalidValueError(KnowledgeBaseError, ValueError):
    """A value that the knowledge base cannot hold, such as a measurement that is not a finite number."""


class KnowledgeChangeRefusedError(KnowledgeBaseError, KnowledgeModelError):
    """Elements that cannot be added or removed; ``problems`` says of each what is wrong and the hint."""


class KnowledgeBaseClosedError(KnowledgeBaseError):
    """A write to a knowledge base that has been closed."""


class JournalError(InputError):
    """A journal that cannot be used: no journal, damaged, of another model, or in use by another process."""


class JournalWriteError(KnowledgeBaseError):
    """The journal could not take a write, so the knowledge base has refused it; the message has the reason."""


def unwritable(path: object, error: OSError, hint: str) -> InputError:
    """What is said of a file or directory that cannot be written, and what to do about it."""
    return InputError(Problem(f"cannot write it: {error.strerror}", Location(str(path)), hint))


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The hint for a misspelt name.

    >>> nearest("batery", ["battery", "visibility"])
    "did you mean 'battery'?"

    Args:
        name: what was written.
        known: the names that there are.

    Returns:
        the hint, or None when nothing known is near.
    """
    matches = difflib.get_close_matches(name, list(known), n=1, cutoff=0.6)
    return f"did you mean '{matches[0]}'?" if matches else None
