"""When two names mean the same."""

from __future__ import annotations

import re


def loosely(name: str) -> str:
    """A name without regard to case, and to whether words are joined by hyphens, underscores, dots or spaces."""
    return re.sub(r"[-_. ]", "_", name.lower())
