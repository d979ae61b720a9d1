"""The regular expressions of ``like``, matched by RE2: in time linear in the text, whatever the expression.

TypeDB's own are Java's (``java.util.regex``), and match the whole text. What RE2 cannot do, or would understand in
another way than Java, is refused.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import re2

MOST_CHARACTERS = 1000
"""How long an expression may be."""
_MOST_MEMORY = 1 << 20  # bytes that RE2 may use for one expression
_CHARACTERS_A_STEP = 1000  # characters times instructions that take as long as one step of a search

_TOKEN = re.compile(
    r"\\Q.*?(?:\\E|\Z)|\\[pPx]\{[^}]*\}|\\.|\{\d+(?:,\d*)?\}|\[\^?\]?|&&|\(\?<?.?|[^\\]|\\\Z", flags=re.DOTALL
)
_LOOK_AROUND = ("look-around is not supported", "use several statements, with not {...} for what must not be")
_ONCE = ("atomic groups and possessive repetitions are not supported", "leave out the extra '+' or the '?>'")
_REFUSED = {
    "\\C": ("'\\C' is not supported", "write . for any character"),
    "\\v": ("'\\v' is not supported", "write \\x0B, or a class such as [\\n\\r]"),
    "(?=": _LOOK_AROUND,
    "(?!": _LOOK_AROUND,
    "(?<=": _LOOK_AROUND,
    "(?<!": _LOOK_AROUND,
    "(?>": _ONCE,
    "(?U": ("the flag U is not supported", "leave it out"),
    "&&": ("intersections of classes are not supported", "write out the characters, or use two statements"),
    "[": ("a class within a class is not supported", "write \\[ for the character, or put them into one class"),
    "{": ("'{' begins no repetition here", "write \\{ for the character"),
}
_REASONS = {
    "missing ):": "a '(' is not closed",
    "unexpected ):": "a ')' has no '('",
    "missing ]:": "a '[' is not closed",
    "trailing \\": "it ends with a '\\'",
    "no argument for repetition operator:": "there is nothing to repeat before",
    "invalid repetition size:": "a repetition is too large, or its bounds are the wrong way round:",
    "invalid character class range:": "there is no such range or class of characters:",
    "invalid escape sequence:": "not supported:",
    "invalid perl operator:": "not supported:",
    "pattern too large": "it is too large",
}


class RegularExpressionError(ValueError):
    """An expression that cannot be used.

    Args:
        what: why.
        hint: how to do without, if it is known.
    """

    def __init__(self, what: str, hint: str | None = None) -> None:
        super().__init__(what if hint is None else f"{what} ({hint})")
        self.what, self.hint = what, hint


class RegularExpression:
    """A compiled expression.

    Args:
        pattern: at most ``MOST_CHARACTERS`` characters of the syntax that Java and RE2 share
            (https://github.com/google/re2/wiki/Syntax): no back-references, look-around, atomic groups, possessive
            repetitions, or intersections of classes.

    Raises:
        RegularExpressionError: if the expression cannot be used.

    >>> RegularExpression("c_(front|rear)_[0-9]+").matches("c_rear_12")
    True
    >>> RegularExpression("c_").matches("c_rear_12")
    False
    """

    def __init__(self, pattern: str) -> None:
        self._compiled = _compiled(pattern)

    def steps(self, text: str) -> int:
        """How much work it is to match this text, in steps of a search."""
        size: int = self._compiled.programsize
        return 1 + len(text) * size // _CHARACTERS_A_STEP

    def matches(self, text: str) -> bool:
        """Whether the whole text matches."""
        return self._compiled.fullmatch(text.encode("utf-8", "surrogatepass")) is not None


@lru_cache(maxsize=64)
def _compiled(pattern: str) -> Any:
    if len(pattern) > MOST_CHARACTERS:
        raise RegularExpressionError(f"it has more than {MOST_CHARACTERS} characters", "split it into several")
    _check_syntax(pattern)
    options = re2.Options()
    options.log_errors = False
    options.max_mem = _MOST_MEMORY
    try:
        return re2.compile(pattern, options)
    except UnicodeEncodeError:
        raise RegularExpressionError("it has a character that is none (half of a surrogate pair)") from None
    except re2.error as error:
        said = error.args[0].decode("utf-8", "replace")
        raise RegularExpressionError(*_reason(said)) from None


def _check_syntax(pattern: str) -> None:
    """Refuse what RE2 would take for something else than Java does, or would not explain.

    Raises:
        RegularExpressionError: for the first such thing.
    """
    in_class = False
    for part in _TOKEN.findall(pattern):
        if part.startswith("["):
            if in_class:
                raise RegularExpressionError(*_REFUSED["["])
            in_class = True
        elif part == "]":
            in_class = False
        elif len(part) == 2 and part[0] == "\\" and part[1].isdigit():
            raise RegularExpressionError(f"'{part}' is not supported: no back-references, no octal numbers")
        elif part in _REFUSED and (in_class or part != "&&") and not (in_class and part[0] in "({"):
            raise RegularExpressionError(*_REFUSED[part])


def _reason(said: str) -> tuple[str, str | None]:
    """RE2's message in the words of ours, with the hint."""
    if said.startswith("bad repetition operator"):
        return _ONCE if said.endswith("+") else ("a repetition is repeated", "put the inner one in a group")
    for begin, what in _REASONS.items():
        if said.startswith(begin):
            part = said.removeprefix(begin).strip()[:40]
            return (f"{what} '{part}'" if what[-1] == ":" or what.endswith("before") else what), None
    return said, None
