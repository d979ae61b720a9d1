"""Extension of Griffe: the roles of Sphinx in docstrings (``:class:`~rosa_core.Status```) become code on the site."""

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
            obj.docstring.value = _ROLE.sub(_code, obj.docstring.value)


def _code(role: re.Match[str]) -> str:
    tilde, target = role.groups()
    return f"`{target.rsplit('.', 1)[-1] if tilde else target}`"
