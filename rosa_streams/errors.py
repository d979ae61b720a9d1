"""Errors of texts that point at the place where reading stopped."""

from __future__ import annotations

from rosa_core.errors import InputError, Location, Problem


class TagError(InputError):
    """A tag that cannot be read; the message points at the place."""


class FormulaError(InputError):
    """A formula that cannot be read or used; the message points at the place."""


class StreamError(InputError):
    """A specification, an environment or a request that does not hold together."""


def pointing(what: str, text: str, offset: int, *, where: Location | None = None, hint: str | None = None) -> Problem:
    """A problem at ``offset`` of a one-line ``text``, with the text and a caret below the message."""
    line = " ".join(text.split("\n")) if "\n" in text else text
    start = max(0, offset - 60)
    shown = line[start : start + 100]
    caret = " " * (offset - start) + "^"
    return Problem(f"{what} at column {offset + 1}\n    {shown}\n    {caret}", where, hint)
