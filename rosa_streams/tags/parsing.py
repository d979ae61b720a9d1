"""Tags as text: description logic and Manchester spelling, and first-order predicates, each with its errors."""

from __future__ import annotations

import re
from typing import NamedTuple, NoReturn

from rosa_core.errors import Location
from rosa_streams.errors import TagError, pointing
from rosa_streams.tags.concepts import EVERYTHING, Concept, Named, One, Predicate, Some

LONGEST = 10_000
"""How many characters a tag may have."""

DEEPEST = 40
"""How deep parentheses and existentials may be nested."""

_TOKEN = re.compile(
    r"\s*(?:(?P<name><[^<>\s]+>|[^\W\d][\w\-]*(?::[\w\-]+)?|:[\w\-]+)|(?P<sign>[⊓∃⊤.(){},&])|(?P<number>\d+))"
)
_BEYOND = {
    "or": "a disjunction", "⊔": "a disjunction", "not": "a negation", "¬": "a negation", "only": "a universal",
    "∀": "a universal", "min": "a number restriction", "max": "a number restriction", "exactly": "a number restriction",
    "that": "'that'", "≥": "a number restriction", "≤": "a number restriction",
}  # fmt: skip
_AND = {"⊓", "and", "&"}
_EVERYTHING = {"⊤", "Thing", "owl:Thing"}
_WORDS = {"and", "some", "value", "exists", *_BEYOND}


class _Token(NamedTuple):
    kind: str
    text: str
    offset: int


def parse_tag(text: str, where: Location | None = None) -> Concept:
    """Read a tag in any spelling; spellings may be mixed. A tag that begins with ``[`` is read as Turtle.

    Args:
        text: such as ``Undistorted ⊓ ∃hasSource.cam1``, ``Undistorted and (hasSource some Camera)`` or
            ``Undistorted(cam1)``.
        where: what errors name as the place.

    Raises:
        TagError: if it cannot be read, or goes beyond conjunction, existential and nominals.

    >>> parse_tag("Undistorted and (hasSource some Camera)") == parse_tag("Undistorted ⊓ ∃hasSource.Camera")
    True
    """
    if text.lstrip().startswith("["):
        from rosa_streams.tags.owl import parse_turtle_tag

        return parse_turtle_tag(text, where)
    return _Reader(text, where).whole()


class _Reader:
    """A recursive-descent reader of one tag."""

    def __init__(self, text: str, where: Location | None) -> None:
        self._text = text
        self._where = where
        if len(text) > LONGEST:
            raise TagError(pointing(f"a tag has at most {LONGEST} characters; it stops", text, LONGEST, where=where))
        self._tokens = self._split()
        self._next = 0

    def whole(self) -> Concept:
        concept = self._conjunction(0)
        token = self._peek()
        if token.kind != "end":
            self._fail(f"expected 'and' or the end, found '{token.text}'", token)
        return concept

    def _split(self) -> list[_Token]:
        tokens: list[_Token] = []
        at, text = 0, self._text
        while at < len(text.rstrip()):
            match = _TOKEN.match(text, at)
            if match is None:
                offset = at + len(text[at:]) - len(text[at:].lstrip())
                self._beyond(text[offset], offset)
                self._fail(f"cannot read '{text[offset]}'", _Token("sign", text[offset], offset))
            kind = str(match.lastgroup)
            tokens.append(_Token(kind, match[kind], match.start(kind)))
            at = match.end()
        tokens.append(_Token("end", "the end", len(text.rstrip())))
        return tokens

    def _peek(self, ahead: int = 0) -> _Token:
        return self._tokens[min(self._next + ahead, len(self._tokens) - 1)]

    def _take(self) -> _Token:
        token = self._peek()
        self._next += 1
        return token

    def _expect(self, text: str) -> None:
        token = self._take()
        if token.text != text:
            self._fail(f"expected '{text}', found {_shown(token)}", token)

    def _conjunction(self, depth: int) -> Concept:
        concept = self._conjunct(depth)
        while self._peek().text in _AND:
            self._take()
            concept = concept.both(self._conjunct(depth))
        return concept

    def _conjunct(self, depth: int) -> Concept:
        token = self._take()
        if depth > DEEPEST:
            self._fail(f"nested more than {DEEPEST} levels deep", token)
        if token.text == "(":
            concept = self._conjunction(depth + 1)
            self._expect(")")
            return concept
        if token.text in {"∃", "exists"}:
            role = self._name("a role")
            self._expect(".")
            return Concept.of(Some(role, self._conjunct(depth + 1)))
        if token.text == "{":
            individual = self._name("an individual")
            if self._peek().text == ",":
                self._fail("a nominal names one individual; of several it is a disjunction, beyond EL", self._peek())
            self._expect("}")
            return Concept.of(One(individual))
        if token.text in _EVERYTHING:
            return EVERYTHING
        return self._named(token, depth)

    def _named(self, token: _Token, depth: int) -> Concept:
        self._beyond(token.text, token.offset)
        if token.kind != "name" or token.text in _WORDS:
            self._fail(f"expected a concept, found {_shown(token)}", token)
        following = self._peek()
        if following.text == "some":
            self._take()
            return Concept.of(Some(_local(token.text), self._conjunct(depth + 1)))
        if following.text == "value":
            self._take()
            return Concept.of(Some(_local(token.text), Concept.of(One(self._name("an individual")))))
        if following.text == "(":
            return Concept.of(Predicate(_local(token.text), self._arguments()))
        self._beyond(following.text, following.offset)
        return Concept.of(Named(_local(token.text)))

    def _arguments(self) -> tuple[str, ...]:
        self._expect("(")
        arguments = [self._argument()]
        while self._peek().text == ",":
            self._take()
            arguments.append(self._argument())
        self._expect(")")
        return tuple(arguments)

    def _argument(self) -> str:
        token = self._take()
        if token.kind not in {"name", "number"}:
            self._fail(f"expected an argument of the predicate, found {_shown(token)}", token)
        return token.text

    def _name(self, what: str) -> str:
        token = self._take()
        if token.kind != "name" or token.text in _WORDS:
            self._fail(f"expected {what}, found {_shown(token)}", token)
        return _local(token.text)

    def _beyond(self, text: str, offset: int) -> None:
        if text in _BEYOND:
            what = f"{_BEYOND[text]} ('{text}') is beyond the tag language"
            hint = "a tag is a conjunction of classes, existentials and nominals (EL)"
            raise TagError(pointing(what, self._text, offset, where=self._where, hint=hint))

    def _fail(self, what: str, token: _Token) -> NoReturn:
        hint = "write for example: Undistorted and (hasSource some Camera)"
        raise TagError(pointing(what, self._text, token.offset, where=self._where, hint=hint))


def _shown(token: _Token) -> str:
    return token.text if token.kind == "end" else f"'{token.text}'"


def _local(name: str) -> str:
    """The local name: of ``<http://example.org/robots#Ball>``, ``rc:Ball`` and ``:Ball`` it is ``Ball``."""
    if name.startswith("<"):
        return re.split(r"[#/]", name[1:-1].rstrip("#/"))[-1]
    return name.rpartition(":")[2]
