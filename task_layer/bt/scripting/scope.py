"""The names that a script may use, and the error of a script that cannot be read or run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TypeAlias

from rosa_core import RosaError
from task_layer.bt.ports.blackboard import Blackboard

MAX_TEXT = 10_000
"""Characters of a text that a script makes; a list that is read from it has no more items."""


class ScriptError(RosaError, ValueError):
    """A script that cannot be read, or does something that cannot be done."""


def joined(left: str, right: str) -> str:
    """Two texts as one.

    Raises:
        ScriptError: if it would be longer than :data:`MAX_TEXT`: a text that is doubled at every tick fills the memory.

    >>> joined("dock", "_2")
    'dock_2'
    """
    length = len(left) + len(right)
    if length > MAX_TEXT:
        raise ScriptError(f"the text would have {length} characters; a script makes texts of at most {MAX_TEXT}")
    return left + right


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
