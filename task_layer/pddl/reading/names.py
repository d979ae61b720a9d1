"""When two names mean the same."""

from __future__ import annotations

import re


def comparable(name: str) -> str:
    """What a name is compared by: neither case counts, nor whether words are joined by ``-``, ``_``, ``.`` or a space.

    Example:
        >>> comparable("Search-Pipeline") == comparable("search pipeline")
        True
    """
    return re.sub(r"[-_. ]", "_", name.lower())
