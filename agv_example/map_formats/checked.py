"""Values out of a file, checked one by one; everything that is wrong is collected with its line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource

_LARGEST = 1e9


class Checked:
    """A value in a file, where it stands, and the list of what has been found wrong with the file."""

    def __init__(
        self, source: YamlSource, value: Any, path: KeyPath = (), problems: list[Problem] | None = None
    ) -> None:
        self.source = source
        self.value = value
        self.path = path
        self.problems: list[Problem] = [] if problems is None else problems

    @property
    def where(self) -> Location:
        """File and line."""
        return self.source.location(self.path)

    def complain(self, what: str, hint: str | None = None) -> None:
        """Something is wrong here."""
        self.problems.append(Problem(what, self.where, hint))

    def raise_problems(self) -> None:
        """Stop if anything is wrong.

        Raises:
            InputError: with all of it.
        """
        if self.problems:
            raise InputError(self.problems)

    def __contains__(self, key: str) -> bool:
        return isinstance(self.value, Mapping) and key in self.value

    def __getitem__(self, key: str | int) -> Checked:
        value = self.value
        inside: Any = None
        if isinstance(value, Mapping):
            inside = value.get(key)
        elif isinstance(value, list) and isinstance(key, int):
            inside = value[key]
        return Checked(self.source, inside, (*self.path, key), self.problems)

    def items(self) -> Iterator[tuple[str, Checked]]:
        """The entries of a mapping; a complaint, and none, if it is no mapping."""
        if isinstance(self.value, Mapping):
            for key in self.value:
                yield str(key), self[key]
        elif self.value is not None:
            self.complain(f"{_shown(self.value)} is not a mapping", "write 'name: value' lines")

    def entries(self) -> Iterator[Checked]:
        """The entries of a list; a complaint, and none, if it is no list."""
        if isinstance(self.value, list):
            for index in range(len(self.value)):
                yield self[index]
        elif self.value is not None:
            self.complain(f"{_shown(self.value)} is not a list", "write '- item' lines, or [item, item]")

    def only(self, known: Iterable[str]) -> None:
        """Complain of the keys that are not known."""
        names = list(known)
        for key, entry in self.items():
            if key not in names:
                entry.complain(f"'{key}' means nothing here", nearest(key, names) or f"there are: {', '.join(names)}")

    def number(self, default: float | None = None, *, least: float = -_LARGEST, most: float = _LARGEST) -> float:
        """A number; the default if nothing is there."""
        if self.value is None and default is not None:
            return default
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            self.complain(f"{_shown(value)} is not a number" if value is not None else "a number is missing")
        elif not least <= value <= most:
            self.complain(f"{value:g} is out of range", f"from {least:g} to {most:g}")
        else:
            return float(value)
        return least if default is None else default

    def whole(self, default: int, *, least: int = 0, most: int = 10_000) -> int:
        """A whole number; the default if nothing is there."""
        number = self.number(float(default), least=least, most=most)
        if number != int(number):
            self.complain(f"{number:g} is not a whole number")
        return int(number)

    def flag(self, default: bool) -> bool:
        """True or false; the default if nothing is there."""
        if self.value is None:
            return default
        if not isinstance(self.value, bool):
            self.complain(f"{_shown(self.value)} is neither true nor false")
            return default
        return self.value

    def text(self, default: str | None = None) -> str:
        """A word or a number as text; the default if nothing is there."""
        if self.value is None and default is not None:
            return default
        if isinstance(self.value, bool) or not isinstance(self.value, str | int | float) or self.value == "":
            self.complain(f"{_shown(self.value)} is not a name" if self.value is not None else "a name is missing")
            return default or ""
        return str(self.value)

    def texts(self) -> tuple[str, ...]:
        """One word, or a list of them."""
        if isinstance(self.value, list):
            return tuple(entry.text() for entry in self.entries())
        return (self.text(),)


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
