"""Says in plain words why a file is no XML, and what to write instead.

BehaviorTree.CPP's own parser takes ``&&`` and ``<`` in attributes, ``--`` in comments and text before the declaration;
XML, and every other tool, does not.
"""

from __future__ import annotations

import re

_ESCAPES = "in XML, && is written &amp;&amp; and < is written &lt;"
_OPEN_ENTITY = re.compile(r"&[#\w.-]*$")
_WINDOW = 100_000
"""Bytes before a fault that are looked at."""


def syntax_problem(data: bytes, message: str, line: int, column: int) -> tuple[str, str | None]:
    """What is wrong at a place of a file that is no XML, and the hint.

    Args:
        data: the file's content.
        message: what the parser says.
        line: the line at which it gave up, from 1.
        column: the column, in bytes from 0.
    """
    before, after = _around(data, line, column)
    if "declaration not at start" in message or _is_text_before_xml(data, before, after):
        return "there is something before the XML begins", "delete what stands before <?xml ...?> or <root>"
    if "junk after document element" in message:
        return "there is something after the outermost element", "put all of it into one <root>"
    if "invalid token" in message:
        if before.rfind("<!--") > before.rfind("-->"):
            return "'--' inside a comment", "in XML only the end of a comment may have '--': write one - there, or ="
        if _OPEN_ENTITY.search(before):
            return "a bare '&'", _ESCAPES
        if after.startswith("<") and _is_in_quotes(before[before.rfind("<") :]):
            return "a bare '<' in an attribute", _ESCAPES
    if "undefined entity" in message:
        return (
            "an entity that XML has not",
            "only &amp; &lt; &gt; &quot; &apos; and numbers such as &#38; can be written",
        )
    return message, None


def _around(data: bytes, line: int, column: int) -> tuple[str, str]:
    """What stands before a place, not all of it, and a few letters after it."""
    start = 0
    for _ in range(line - 1):
        start = data.find(b"\n", start) + 1
    place = start + column
    before = data[max(0, place - _WINDOW) : place].decode("utf-8", "replace")
    return before, data[place : place + 10].decode("utf-8", "replace")


def _is_text_before_xml(data: bytes, before: str, after: str) -> bool:
    return not before.strip() and not after.startswith("<") and (b"<?xml" in data or b"<root" in data)


def _is_in_quotes(tag: str) -> bool:
    """Whether a tag that begins like this ends inside the quotes of an attribute."""
    quote = ""
    for letter in tag:
        if not quote and letter in "\"'":
            quote = letter
        elif letter == quote:
            quote = ""
    return bool(quote)
