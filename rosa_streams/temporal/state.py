"""A state of the streams, and what evaluates an atom at one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

State: TypeAlias = Mapping[str, Any]
"""The values of variables at one time; a variable that is missing, None or not a number (NaN) is unknown."""

Evaluator: TypeAlias = Callable[[State], bool | None]
"""True, false, or None where it is unknown."""
