"""The errors of the framework: each says what is wrong, where, and how to fix it."""

from __future__ import annotations

import difflib
import errno
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

LONGEST_TOKEN = 200
"""Characters of a word, name or path that a message repeats; its middle is left out beyond that."""

MOST_LINES = 20
"""Lines of a message about an input; the others are counted."""

_LONG_TOKEN = re.compile(rf"\S{{{LONGEST_TOKEN + 1},}}")
_LONGEST_LINE = 2000


def shortened(text: str) -> str:
    """A text for a message: whatever somebody's input has put into it, it can be read.

    >>> len(shortened("no such file: " + "a" * 5000))
    214

    Args:
        text: one or several lines.

    Returns:
        the text without the middle of words beyond :data:`LONGEST_TOKEN` characters, and of lines beyond 2000.
    """
    if len(text) <= LONGEST_TOKEN:
        return text
    text = _LONG_TOKEN.sub(lambda token: _without_middle(token.group(), LONGEST_TOKEN), text)
    return "\n".join(_without_middle(line, _LONGEST_LINE) for line in text.split("\n"))


def _without_middle(text: str, most: int) -> str:
    if len(text) <= most:
        return text
    end = most // 3
    return f"{text[: most - end - 3]}...{text[-end:]}"


class RosaError(Exception):
    """Base of every error that is somebody's input or request, not a defect of the program."""

    def __str__(self) -> str:
        return shortened(super().__str__())


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
        return shortened(text if self.hint is None else f"{text} ({self.hint})")


class InputError(RosaError):
    """A file or a command line that cannot be used. ``problems`` holds every one that was found."""

    def __init__(self, problems: Problem | str | Sequence[Problem]) -> None:
        if isinstance(problems, str):
            problems = Problem(problems)
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    def __str__(self) -> str:
        lines = super().__str__().split("\n")
        if len(lines) > MOST_LINES:
            lines[MOST_LINES:] = [f"... and {len(lines) - MOST_LINES} more"]
        return "\n".join(lines)


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


NO_SPACE = (errno.ENOSPC, errno.EDQUOT)
"""The operating system's numbers for a disk, or somebody's share of it, that is full."""


def unwritable(path: object, error: OSError, hint: str) -> InputError:
    """What is said of a file or directory that cannot be written, and what to do about it."""
    if error.errno in NO_SPACE:
        hint = "make room on the disk, and do it again"
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
