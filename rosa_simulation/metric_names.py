"""Metrics carry their unit at the end of their name, such as ``search_time_s``; people read it apart."""

from __future__ import annotations

_UNITS = {"_s": "s", "_m": "m"}


def label(name: str) -> tuple[str, str]:
    """The name of a metric in words, and its unit."""
    for suffix, unit in _UNITS.items():
        if name.endswith(suffix):
            return name.removesuffix(suffix).replace("_", " "), unit
    return name.replace("_", " "), ""
