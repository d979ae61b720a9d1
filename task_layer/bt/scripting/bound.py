"""Scripts as conditions and actions of a node: each is bound to the blackboard that it runs on."""

from __future__ import annotations

from dataclasses import dataclass

from task_layer.bt.ports.conversion import ConversionError, to_bool
from task_layer.bt.scripting.parser import Script
from task_layer.bt.scripting.scope import Scope, ScriptError


@dataclass(frozen=True, slots=True)
class BoundScript:
    """Runs a script when it is called."""

    script: Script
    scope: Scope

    @property
    def text(self) -> str:
        """The script's text."""
        return self.script.text

    def __call__(self) -> object:
        """Run it."""
        return self.script.run(self.scope)


class BoundCondition(BoundScript):
    """Runs a script when it is called; the result is true or false."""

    __slots__ = ()

    def __call__(self) -> bool:
        """Run it."""
        try:
            return to_bool(self.script.run(self.scope))
        except ConversionError as error:
            raise ScriptError(f"the condition {self.text!r} is no condition: {error}") from None
