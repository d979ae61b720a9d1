"""The nodes of BehaviorTree.CPP v4 that run scripts, or read or write the blackboard themselves."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf
from task_layer.bt.engine.node import Flow
from task_layer.bt.engine.outcome import FAILURE, OUTCOMES_BY_NAME, RUNNING, SUCCESS
from task_layer.bt.nodes.decorators import Decorator
from task_layer.bt.ports.blackboard import EMPTY, Blackboard
from task_layer.bt.ports.bound_ports import PortError
from task_layer.bt.ports.conversion import parse, to_text
from task_layer.bt.ports.parameter import Parameter, value_of


class ScriptAction(Leaf):
    """Runs a script and succeeds."""

    def __init__(self, name: str, code: Callable[[], object]) -> None:
        super().__init__(name)
        self.code = code

    def update(self) -> Status:
        """Run it."""
        self.code()
        return SUCCESS


class ScriptCondition(Leaf):
    """SUCCESS if a script evaluates to true, otherwise FAILURE."""

    def __init__(self, name: str, code: Callable[[], bool]) -> None:
        super().__init__(name)
        self.code = code

    def update(self) -> Status:
        """Run it."""
        return SUCCESS if self.code() else FAILURE


class Precondition(Decorator):
    """Ticks its child if a condition holds or the child is running; otherwise it has a fixed outcome.

    Args:
        name: the node's name in the tree.
        child: the child.
        holds: the condition.
        otherwise: the name of the outcome when the condition does not hold.
    """

    def __init__(self, name: str, child: Behaviour, holds: Callable[[], bool], otherwise: Parameter[str]) -> None:
        super().__init__(name, child)
        self.holds = holds
        self.otherwise = otherwise

    def flow(self) -> Flow:
        """Check the condition, and tick."""
        child = self.decorated
        if child.status is not RUNNING and not self.holds():
            otherwise = value_of(self.otherwise)
            if otherwise not in OUTCOMES_BY_NAME:
                raise PortError(f"port 'else': {otherwise!r} is not one of {', '.join(OUTCOMES_BY_NAME)}")
            return OUTCOMES_BY_NAME[otherwise]
        outcome = yield child
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_child(child)
        return outcome


class SetBlackboard(Leaf):
    """Writes a text, or a copy of another entry, to an entry of the blackboard; FAILURE if the other entry is empty.

    Args:
        name: the behaviour's name in the tree.
        blackboard: the blackboard of both entries.
        value: the text, if ``source`` is None.
        source: the entry that is copied.
        output_key: the entry that is written.
    """

    def __init__(
        self, name: str, blackboard: Blackboard, value: str, source: str | None, output_key: Parameter[object]
    ) -> None:
        super().__init__(name)
        self._blackboard = blackboard
        self._value = value
        self._source = source
        self._output_key = output_key

    def update(self) -> Status:
        """Write it."""
        key = to_text(value_of(self._output_key))
        value: object = self._value
        kind: object = str
        if self._source is not None:
            source = self._blackboard.entry(self._source)
            if source is None or source.value is EMPTY:
                self.feedback_message = f"there is nothing in the entry '{self._source}'"
                return FAILURE
            value, kind = source.value, source.type
        entry = self._blackboard.entry(key)
        if entry is None:
            entry = self._blackboard.create(key, kind)
        if entry.type not in (object, str) and isinstance(value, str):
            value = parse(value, entry.type)
        if entry.type is object:
            entry.write(value)
        else:
            self._blackboard.set(key, value)
        return SUCCESS


class UnsetBlackboard(Leaf):
    """Removes an entry of the blackboard."""

    def __init__(self, name: str, blackboard: Blackboard, key: Parameter[str]) -> None:
        super().__init__(name)
        self._blackboard = blackboard
        self._key = key

    def update(self) -> Status:
        """Remove it."""
        self._blackboard.unset(value_of(self._key))
        return SUCCESS
