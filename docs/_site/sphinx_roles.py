"""Extension of Griffe: roles of Sphinx (``:class:`~rosa_core.Status```) and doctests become code on the site."""

from __future__ import annotations

import re
from typing import Any

import griffe

_ROLE = re.compile(r":(?:class|meth|mod|func|attr|data|exc):`(~?)([^`]+)`")


class SphinxRoles(griffe.Extension):
    """Shows what a role names as code: its last part if there is a tilde, as in Sphinx."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Rewrite the docstring of whatever was loaded."""
        if obj.docstring:
            obj.docstring.value = _with_fences(_ROLE.sub(_code, obj.docstring.value))


def _code(role: re.Match[str]) -> str:
    tilde, target = role.groups()
    return f"`{target.rsplit('.', 1)[-1] if tilde else target}`"


def _with_fences(text: str) -> str:
    """The text with every doctest, up to the next empty line, in a fence."""
    lines: list[str] = []
    fence: str | None = None
    for line in text.splitlines():
        if fence is None and line.lstrip().startswith(">>>"):
            fence = line[: len(line) - len(line.lstrip())] + "```"
            lines.append(f"{fence}pycon")
        elif fence is not None and not line.strip():
            lines.append(fence)
            fence = None
        lines.append(line)
    return "\n".join(lines if fence is None else [*lines, fence])
