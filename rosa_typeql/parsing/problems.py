"""What is wrong with TypeQL text, in words, with line and hint."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager

from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from rosa_core.errors import InputError, Location, Problem

_WRITES = ("insert", "delete", "update", "put")
_REFUSED = {
    ("model", "define"): ("this is a schema, not a model", "leave it out: the schema of ROSA is built in"),
    ("model", "undefine"): ("this is a schema, not a model", "leave it out: the schema of ROSA is built in"),
    ("model", "fetch"): ("this is a query, not a model", "ask it with 'rosa query FILE... QUERY'"),
    ("model", "get"): ("this is a query, not a model", "ask it with 'rosa query FILE... QUERY'"),
    ("model", "delete"): ("a model file only inserts", "take the statement out where it was inserted"),
    ("query", "define"): ("a query only reads", "the schema of ROSA is built in"),
    ("query", "undefine"): ("a query only reads", "the schema of ROSA is built in"),
    ("query", "group"): ("'group' is not supported", "fetch the rows and group them by the variable"),
    **{("query", word): ("a query only reads", "to change knowledge, use a model file or the KB") for word in _WRITES},
}
_WORDS = {
    "VARIABLE": "a variable such as $a",
    "LABEL": "a name",
    "TEXT": "text in quotes",
    "NUMBER": "a number",
    "MATCH": "'match'",
    "INSERT": "'insert'",
    "ISA": "'isa'",
    "HAS": "'has'",
    "SEMICOLON": "';'",
    "COMMA": "','",
    "COLON": "':'",
    "LPAR": "'('",
    "RPAR": "')'",
    "RBRACE": "'}'",
    "BLOCK_BEGIN": "'{'",
    "FETCH": "'fetch'",
    "GET": "'get'",
    "COMPARATOR": "'=' or another comparison",
    "OR": "'or'",
    "NOT": "'not'",
}


def syntax_problem(error: UnexpectedInput, text: str, start: str, file: str) -> Problem:
    """The problem with a text; ``start`` is the rule of the grammar that it should follow: model or query.

    Args:
        error: of the parser.
        text: that was parsed.
        start: the rule of the grammar that it should follow, model or query; what to say of a word depends on it.
        file: its name, for the place.
    """
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        expected = _expected(error.expected)
        return Problem("it ends in the middle of a statement", Location(file, text.count("\n") + 1), expected)
    where = Location(file, max(error.line, 1))
    if isinstance(error, UnexpectedToken):
        token = str(error.token)
        if (start, token) in _REFUSED:
            what, hint = _REFUSED[start, token]
            return Problem(what, where, hint)
        shown = token if len(token) <= 40 else f"{token[:40]}..."
        return Problem(f"{shown!r} cannot stand here", where, _expected(error.expected))
    if isinstance(error, UnexpectedCharacters):
        return _bad_character(error.char, where)
    return Problem("it cannot be read", where)


def _bad_character(character: str, where: Location) -> Problem:
    if character in "\"'":
        return Problem("the text that begins here does not end", where, f"close it with {character}")
    if character == "?":
        return Problem("value variables ('?x') are not supported", where, "compare attributes: $a < $b")
    return Problem(f"{character!r} cannot stand here", where)


def _expected(expected: Collection[str]) -> str | None:
    words = [word for name, word in _WORDS.items() if name in expected]
    return f"expected {', '.join(words[:6])}" if words else None


class Problems:
    """What is wrong with one text, gathered so that all of it can be fixed at once.

    Args:
        file: what the text is called.
        found: the list that problems are added to.
    """

    def __init__(self, file: str, found: list[Problem]) -> None:
        self.found = found
        self._file = file

    def at(self, line: int) -> Location:
        """A line of the text."""
        return Location(self._file, line)

    def add(self, line: int, what: str, hint: str | None = None) -> None:
        """Something is wrong in a line.

        Args:
            line: from 1.
            what: is wrong, without the place.
            hint: how to fix it, if that is known.
        """
        self.found.append(Problem(what, self.at(line), hint))

    def error(self, line: int, what: str, hint: str | None = None) -> InputError:
        """The same, to be raised: what it is about cannot be read any further.

        Args:
            line: from 1.
            what: is wrong, without the place.
            hint: how to fix it, if that is known.

        Returns:
            the error, to be raised; it is not among ``found``.
        """
        return InputError(Problem(what, self.at(line), hint))

    @contextmanager
    def gathering(self) -> Iterator[None]:
        """Go on after an error that is raised in here."""
        try:
            yield
        except InputError as error:
            self.found.extend(error.problems)
