"""What the names in a script stand for, and why running one fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TypeAlias

from rosa_core import RosaError
from task_layer.bt.ports.blackboard import Blackboard


class ScriptError(RosaError, ValueError):
    """A script that cannot be read, or does something that cannot be done."""


@dataclass(frozen=True, slots=True)
class Scope:
    """Where a script runs.

    Attributes:
        blackboard: holds the variables.
        enums: names of constants; they hide variables of the same name.
    """

    blackboard: Blackboard
    enums: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    def value(self, name: str) -> object:
        """What a name stands for."""
        return float(self.enums[name]) if name in self.enums else self.blackboard.get(name)


Evaluate: TypeAlias = Callable[[Scope], object]
"""A compiled expression."""
