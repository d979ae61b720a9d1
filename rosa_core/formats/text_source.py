"""Text files from outside: what cannot be read is an error that says why."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from rosa_core.errors import InputError, Location, Problem

LARGEST_FILE = 256 << 20
"""Bytes of a file that is read; a device may have no end."""


def read_text(path: str | PathLike[str]) -> str:
    """The text of a UTF-8 file.

    Raises:
        InputError: if there is no such file, it cannot be read, is larger than :data:`LARGEST_FILE`, or is not UTF-8.
    """
    where = Location(str(path))
    try:
        with Path(path).open("rb") as file:
            data = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise InputError(Problem(f"cannot read it: {error.strerror}", where)) from None
    except ValueError as error:
        # A path with a NUL character, for one, is refused by Python itself.
        raise InputError(Problem(f"cannot read it: {error}", where)) from None
    if len(data) > LARGEST_FILE:
        raise InputError(Problem("it is too large", where, f"at most {LARGEST_FILE >> 20} MB are read"))
    try:
        # Lines end as in every text file of Python.
        return data.decode("utf-8").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError:
        raise InputError(Problem("it is not UTF-8 text", where, "save it as UTF-8")) from None
