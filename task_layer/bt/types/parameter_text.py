"""The text of parameters in XML."""

from __future__ import annotations

from enum import Enum
from typing import Protocol, runtime_checkable


@runtime_checkable
class HasText(Protocol):
    """A parameter or a condition that was compiled from text."""

    @property
    def text(self) -> str:
        """The text in the XML."""
        ...


class NotWritableError(Exception):
    """A node or a value that XML has no way to write; the message says why."""


def text_of(value: object) -> str:
    """The text of a parameter's value.

    Raises:
        NotWritableError: if it is a function that was not compiled from text, or a value that would be read back
            as something else.
    """
    if isinstance(value, HasText):
        return value.text
    if callable(value):
        raise NotWritableError("is a Python function")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, list | tuple):
        return ";".join(text_of(item) for item in value)
    text = str(value)
    if text.startswith("{") and text.endswith("}"):
        raise NotWritableError(f"is the text {text!r}, which would be read as an entry of the blackboard")
    return text
