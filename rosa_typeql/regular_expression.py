"""Regular expressions whose matching takes time linear in the text, whatever the expression.

Python's own engine tries alternatives one after the other, and some expressions make it try exponentially many
(``(a+)+b``). Here all of them advance together, one character at a time (Thompson, CACM 11(6), 1968). What that cannot
do is refused: back-references and look-around. Like TypeDB's ``like``, an expression must match the whole text.
"""

from __future__ import annotations

from collections.abc import Callable

_Test = Callable[[str], bool]
_MOST_STATES = 2000
_LARGEST_REPEAT = 200
_DEEPEST = 50
_CLASSES: dict[str, _Test] = {
    "d": str.isdecimal,
    "w": lambda c: c.isalnum() or c == "_",
    "s": str.isspace,
}
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v"}


class RegularExpressionError(ValueError):
    """An expression that is not well-formed, not supported, or too large."""


class RegularExpression:
    """A compiled expression.

    Supported: literals, ``.``, classes ``[a-z]`` ``[^...]``, ``\\d \\w \\s`` and their complements, groups ``( )``
    ``(?: )``, ``|``, ``* + ? {m} {m,} {m,n}`` (lazy ones match the same), ``^`` at the beginning and ``$`` at the end.

    Raises:
        RegularExpressionError: if the expression cannot be used; the message says what it is about.
    """

    def __init__(self, pattern: str) -> None:
        self._tests: list[_Test | None] = []
        self._next: list[list[int]] = []
        start, end = _Parser(pattern, self._state).parse()
        self._end = end
        self._start = self._closure({start})
        self._moves: dict[tuple[frozenset[int], str], frozenset[int]] = {}

    @property
    def size(self) -> int:
        """How many states there are: the work for one character is at most proportional to it."""
        return len(self._tests)

    def matches(self, text: str) -> bool:
        """Whether the whole text matches."""
        states = self._start
        for character in text:
            if not states:
                return False
            states = self._step(states, character)
        return self._end in states

    def _step(self, states: frozenset[int], character: str) -> frozenset[int]:
        move = (states, character)
        if move not in self._moves:
            if len(self._moves) > 10_000:
                self._moves.clear()
            reached = set()
            for state in states:
                test = self._tests[state]
                if test is not None and test(character):
                    reached.update(self._next[state])
            self._moves[move] = self._closure(reached)
        return self._moves[move]

    def _closure(self, states: set[int]) -> frozenset[int]:
        """The states, and those that can be reached from them without a character."""
        left = list(states)
        while left:
            state = left.pop()
            if self._tests[state] is None:
                new = [following for following in self._next[state] if following not in states]
                states.update(new)
                left.extend(new)
        return frozenset(states)

    def _state(self, test: _Test | None, following: list[int]) -> int:
        if len(self._tests) >= _MOST_STATES:
            raise RegularExpressionError("it is too large")
        self._tests.append(test)
        self._next.append(following)
        return len(self._tests) - 1


_Fragment = tuple[int, list[int]]
"""Where a part of the automaton begins, and the list of what follows its (single) last state."""


class _Parser:
    """Recursive descent over the pattern, building the automaton from the parts."""

    def __init__(self, pattern: str, state: Callable[[_Test | None, list[int]], int]) -> None:
        if pattern.startswith("^"):
            pattern = pattern[1:]
        if pattern.endswith("$") and not pattern.endswith("\\$"):
            pattern = pattern[:-1]
        self._pattern = pattern
        self._at = 0
        self._depth = 0
        self._state = state

    def parse(self) -> tuple[int, int]:
        """The first and the last state."""
        first, out = self._alternatives()
        if self._at < len(self._pattern):
            raise RegularExpressionError("a ')' has no '('")
        last = self._state(None, [])
        out.append(last)
        return first, last

    def _peek(self) -> str:
        return self._pattern[self._at] if self._at < len(self._pattern) else ""

    def _take(self) -> str:
        character = self._peek()
        self._at += 1
        return character

    def _alternatives(self) -> _Fragment:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise RegularExpressionError("its groups nest too deeply")
        branches = [self._sequence()]
        while self._peek() == "|":
            self._take()
            branches.append(self._sequence())
        self._depth -= 1
        if len(branches) == 1:
            return branches[0]
        out: list[int] = []
        join = self._state(None, out)
        for _, branch_out in branches:
            branch_out.append(join)
        return self._state(None, [first for first, _ in branches]), out

    def _sequence(self) -> _Fragment:
        out: list[int] = []
        first = self._state(None, out)
        while self._peek() not in ("", "|", ")"):
            part_first, part_out = self._repeated()
            out.append(part_first)
            out = part_out
        return first, out

    def _repeated(self) -> _Fragment:
        begin = self._at
        fragment = self._atom()
        end = self._at
        bounds = self._bounds()
        if bounds is None:
            return fragment
        if self._peek() == "?":
            self._take()
        if self._peek() in ("*", "+", "?") and self._peek():
            raise RegularExpressionError("a repetition is repeated; use a group")
        after = self._at
        result = self._copies(begin, end, fragment, *bounds)
        self._at = after
        return result

    def _bounds(self) -> tuple[int, int | None] | None:
        simple = {"*": (0, None), "+": (1, None), "?": (0, 1)}.get(self._peek())
        if simple is not None:
            self._take()
            return simple
        close = self._pattern.find("}", self._at)
        if self._peek() != "{" or close < 0:
            return None
        low, comma, high = self._pattern[self._at + 1 : close].partition(",")
        if not _is_count(low) or (high and not _is_count(high)):
            return None
        self._at = close + 1
        least = int(low)
        most = (int(high) if high else None) if comma else least
        if max(least, most or 0) > _LARGEST_REPEAT:
            raise RegularExpressionError(f"a repetition is larger than {_LARGEST_REPEAT}")
        if most is not None and most < least:
            raise RegularExpressionError("a repetition {m,n} has m larger than n")
        return least, most

    def _copies(self, begin: int, end: int, first_copy: _Fragment, least: int, most: int | None) -> _Fragment:
        """The part ``least`` to ``most`` times; each copy is parsed again from the pattern."""
        copies = [first_copy]
        while len(copies) < max(least if most is None else most, 1):
            self._at = begin
            copies.append(self._atom())
            if self._at != end:
                raise RegularExpressionError("it cannot be read")
        out: list[int] = []
        join = self._state(None, out)
        for index, (_, copy_out) in enumerate(copies):
            copy_out.append(copies[index + 1][0] if index + 1 < len(copies) else join)
            if index + 1 >= least and index + 1 < len(copies):
                copy_out.append(join)
        if most is None:
            copies[-1][1].append(copies[-1][0])
        if most == 0:
            return self._state(None, [join]), out
        entry = [copies[0][0], join] if least == 0 else [copies[0][0]]
        return self._state(None, entry), out

    def _atom(self) -> _Fragment:
        character = self._take()
        if character == "(":
            return self._group()
        if character == "[":
            return self._one(self._character_class())
        if character == ".":
            return self._one(lambda c: c != "\n")
        if character == "\\":
            return self._one(self._escape())
        if character in "*+?":
            raise RegularExpressionError(f"there is nothing for '{character}' to repeat")
        if character in "^$":
            raise RegularExpressionError(f"'{character}' stands in the middle; write \\{character} for the character")
        return self._one(lambda c: c == character)

    def _one(self, test: _Test) -> _Fragment:
        """One character; an empty state follows, so that what comes after can be added to a list of its own."""
        out: list[int] = []
        after = self._state(None, out)
        return self._state(test, [after]), out

    def _group(self) -> _Fragment:
        if self._peek() == "?":
            if self._pattern[self._at : self._at + 2] != "?:":
                raise RegularExpressionError("'(?' is supported only as '(?:'")
            self._at += 2
        fragment = self._alternatives()
        if self._take() != ")":
            raise RegularExpressionError("a '(' is not closed")
        return fragment

    def _escape(self) -> _Test:
        character = self._take()
        if not character:
            raise RegularExpressionError("it ends with a '\\'")
        if character.lower() in _CLASSES:
            test = _CLASSES[character.lower()]
            return test if character.islower() else (lambda c: not test(c))
        if character in _ESCAPES:
            literal = _ESCAPES[character]
            return lambda c: c == literal
        if character.isalnum():
            raise RegularExpressionError(f"'\\{character}' is not supported")
        return lambda c: c == character

    def _character_class(self) -> _Test:
        negated = self._peek() == "^"
        if negated:
            self._take()
        tests: list[_Test] = []
        while self._peek() != "]" or not tests:
            if not self._peek():
                raise RegularExpressionError("a '[' is not closed")
            tests.append(self._class_item())
        self._take()
        return lambda c: any(test(c) for test in tests) is not negated

    def _class_item(self) -> _Test:
        low = self._take()
        if low == "\\":
            return self._escape()
        following = self._pattern[self._at : self._at + 2]
        if len(following) == 2 and following[0] == "-" and following[1] not in "]\\":
            self._at += 2
            high = following[1]
            if high < low:
                raise RegularExpressionError(f"the range {low}-{high} is empty")
            return lambda c: low <= c <= high
        return lambda c: c == low


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 9
