"""PDDL text as nested forms that know their lines: what errors point at, and what is handed to the reader."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from rosa_core import InputError
from rosa_core.errors import Location, Problem

MOST_CHARACTERS = 5_000_000
MOST_NESTED = 60

_TOKEN = re.compile(r";[^\n]*|[()]|[^\s();]+|\n")


@dataclass(frozen=True, slots=True)
class Symbol:
    """A word of PDDL and the line that it stands on."""

    text: str
    line: int

    @property
    def key(self) -> str:
        """The word as PDDL compares it: without regard to case."""
        return self.text.lower()


@dataclass(frozen=True, slots=True)
class Form:
    """A parenthesised list, and the line on which it opens."""

    line: int
    items: list[Symbol | Form] = field(default_factory=list)

    @property
    def head(self) -> str:
        """The first word in lower case; empty if the form does not begin with a word."""
        first = self.items[0] if self.items else None
        return first.key if isinstance(first, Symbol) else ""

    @property
    def forms(self) -> Iterator[Form]:
        """The forms directly inside."""
        return (item for item in self.items if isinstance(item, Form))

    def after(self, keyword: str) -> Symbol | Form | None:
        """What follows a keyword such as ``:effect``; None if there is no such keyword."""
        for item, following in zip(self.items, self.items[1:], strict=False):
            if isinstance(item, Symbol) and item.key == keyword:
                return following
        return None


def parse_forms(text: str, file: str) -> Form:
    """The one outermost form of a PDDL file.

    Raises:
        InputError: if parentheses do not match, nest too deeply, or there is not exactly one outermost form.
    """
    if len(text) > MOST_CHARACTERS:
        raise InputError(Problem(f"it has more than {MOST_CHARACTERS} characters", Location(file), "split it"))
    outermost, opened, line = Form(1), list[Form](), 1
    for match in _TOKEN.finditer(text):
        word = match.group()
        if word == "\n":
            line += 1
        elif word == "(":
            form = Form(line)
            (opened[-1] if opened else outermost).items.append(form)
            opened.append(form)
            if len(opened) > MOST_NESTED:
                what = f"forms are nested more than {MOST_NESTED} deep"
                raise InputError(Problem(what, Location(file, line), "write simpler conditions"))
        elif word == ")":
            if not opened:
                raise InputError(Problem("')' closes nothing", Location(file, line), "remove it, or add its '('"))
            opened.pop()
        elif not word.startswith(";"):
            (opened[-1] if opened else outermost).items.append(Symbol(word, line))
    if opened:
        what = f"'({opened[-1].head}' is never closed" if opened[-1].head else "'(' is never closed"
        raise InputError(Problem(what, Location(file, opened[-1].line), "add the ')' that is missing"))
    return _definition(outermost, file)


def _definition(outermost: Form, file: str) -> Form:
    if len(outermost.items) != 1 or not isinstance(outermost.items[0], Form) or outermost.items[0].head != "define":
        line = outermost.items[1].line if len(outermost.items) > 1 else 1
        hint = "a file is one form: (define (domain NAME) ...) or (define (problem NAME) ...)"
        raise InputError(Problem("this is not a PDDL definition", Location(file, line), hint))
    return outermost.items[0]


class PlainNames:
    """Names made plain for the reader: letters, digits, hyphens and underscores, in lower case.

    The same name always becomes the same plain name, and two names never the same.
    """

    def __init__(self) -> None:
        self._plain: dict[str, str] = {}
        self._written: dict[str, str] = {}

    def plain(self, symbol: Symbol) -> str:
        """What the reader is given for a word."""
        key = symbol.key
        if key in self._plain:
            return self._plain[key]
        if key.startswith(":") or is_number(key) or not _LETTER.search(key):
            return key
        mark = "?" if key.startswith("?") else ""
        plain = re.sub(r"[^a-z0-9_-]", "_", key.removeprefix("?"))
        plain = plain if plain[:1].isalpha() else f"n{plain}"
        while mark + plain in self._written:
            plain += "_"
        self._plain[key] = mark + plain
        self._written[mark + plain] = symbol.text
        return mark + plain

    def written(self, plain: str) -> str:
        """The name as it was first written in the files."""
        return self._written.get(plain, plain)


_LETTER = re.compile(r"[^\W\d_]")
"""Words without one are operators."""

_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.ASCII)


def is_number(word: str) -> bool:
    """Whether a word, in lower case, is a number."""
    return _NUMBER.fullmatch(word) is not None


def render(form: Form, names: PlainNames) -> str:
    """The text of a form with plain names, each word on the line where it stands in the file."""
    written: list[str] = []
    at = 1

    def put(text: str, line: int) -> None:
        nonlocal at
        written.append("\n" * (line - at) or " ")
        written.append(text)
        at = max(at, line)

    def walk(item: Symbol | Form) -> None:
        if isinstance(item, Symbol):
            put(names.plain(item), item.line)
            return
        put("(", item.line)
        for inner in item.items:
            walk(inner)
        written.append(")")

    walk(form)
    return "".join(written)
