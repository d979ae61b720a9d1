"""Text files from outside: what cannot be read is an error that says why."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from rosa_core.errors import InputError, Location, Problem


def read_text(path: str | PathLike[str]) -> str:
    """The text of a UTF-8 file.

    Raises:
        InputError: if there is no such file, it cannot be read, or it is not UTF-8.
    """
    where = Location(str(path))
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(Problem(f"cannot read it: {error.strerror}", where)) from None
    except UnicodeDecodeError:
        raise InputError(Problem("it is not UTF-8 text", where, "save it as UTF-8")) from None
    except ValueError as error:
        # A path with a NUL character, for one, is refused by Python itself.
        raise InputError(Problem(f"cannot read it: {error}", where)) from None
