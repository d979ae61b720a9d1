"""The names that a script may use, and the error of a script that cannot be read or run."""

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
    """The variables and constants of a script.

    Attributes:
        blackboard: holds the variables.
        enums: names and values of constants, which hide variables of the same name.
    """

    blackboard: Blackboard
    enums: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))

    def value(self, name: str) -> object:
        """The value of a name."""
        return float(self.enums[name]) if name in self.enums else self.blackboard.get(name)


Evaluate: TypeAlias = Callable[[Scope], object]
"""A compiled expression."""
