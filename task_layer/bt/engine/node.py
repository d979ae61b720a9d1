"""How the control nodes and decorators are ticked and halted: as in BehaviorTree.CPP v4, and as py_trees behaviours.

A node is a coroutine (:meth:`Node.flow`): it yields the child to be ticked, is sent the outcome, and returns its own
outcome. The node at the top of a tree runs the coroutines of all nodes below it in one loop (:meth:`Node.tick`), which
yields every node that it has visited, as py_trees' visitors expect. One loop instead of nested generators, and no debug
strings, make these trees faster than py_trees' own.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.conditions import Conditions, conditions_of
from task_layer.bt.engine.failing import Leaf, fail
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.engine.tick_context import NO_RUNNER, TickContext

Flow = Generator[Behaviour, Outcome, Outcome]
"""Yields children, is sent the outcomes of their ticks, returns the outcome of the node's own tick."""


class Node(Behaviour):
    """A control node or decorator with BehaviorTree.CPP's way of ticking and halting.

    A subclass also derives from a py_trees composite or decorator, which holds the children. It defines :meth:`flow`,
    and :meth:`reset` if it keeps anything from one tick to the next.

    Args:
        name: the node's name in the tree.

    >>> from py_trees.behaviours import Failure, Success
    >>> from py_trees.composites import Composite
    >>> class LastOutcome(Node, Composite):
    ...     def flow(self):
    ...         self.status = RUNNING
    ...         for child in self.children:
    ...             outcome = yield child
    ...         return outcome
    >>> root = LastOutcome("root", [Failure("first"), Success("second")])
    >>> root.tick_once()
    >>> root.status.name
    'SUCCESS'
    """

    bt_conditions: Conditions | None = None
    tick_context: TickContext = NO_RUNNER
    current_child: Behaviour | None = None
    steps_done: int = 0
    """How many steps it has done of those that it will do: a node that counts them does not try the same for ever."""

    def flow(self) -> Flow:
        """One tick: yield each child to be ticked, and return the node's outcome.

        Raises:
            TypeError: if a subclass does not define it.
        """
        raise TypeError(f"{type(self).__name__} must define flow()")

    def reset(self) -> None:
        """Discard what was kept from earlier ticks: the node is halted, and the next tick starts afresh."""

    def setup(self, **kwargs: Any) -> None:
        """Keep what the runner passes: see :class:`~task_layer.bt.engine.tick_context.TickContext`."""
        self.tick_context = TickContext.of(kwargs)

    def update(self) -> Status:
        """Not used: a node's status is the outcome of its :meth:`flow`."""
        return self.status

    def tick(self) -> Iterator[Behaviour]:
        """Tick once, and yield every node that was visited, after its children; py_trees calls this."""
        above: list[tuple[Node, Flow]] = []
        node: Node = self
        flow = self._start()
        outcome: Any = None  # None starts a coroutine
        while True:
            try:
                child = flow.send(outcome)
            except StopIteration as end:
                outcome = end.value
                if outcome is not SKIPPED:
                    node.status = outcome
                    yield node
            except Exception as error:
                outcome = node._fail(node, error)
                yield node
            else:
                node.current_child = child
                if isinstance(child, Node):
                    above.append((node, flow))
                    node, flow, outcome = child, child._start(), None
                elif child.children:
                    outcome = yield from node._tick_composite(child)
                else:
                    outcome = node._tick_leaf(child)
                    if outcome is not SKIPPED:
                        yield child
                continue
            if not above:
                return
            node, flow = above.pop()

    def iterate(self, direct_descendants: bool = False) -> Iterator[Behaviour]:
        """All nodes below this one, children before their parents, and this one, without recursion."""
        if direct_descendants:
            yield from self.children
            yield self
            return
        found: list[Behaviour] = []
        to_do: list[Behaviour] = [self]
        while to_do:
            behaviour = to_do.pop()
            found.append(behaviour)
            to_do.extend(behaviour.children)
        found.reverse()
        yield from found

    def tip(self) -> Behaviour | None:
        """The deepest node of the last tick, along the children ticked last; None if this one is idle."""
        if self.status is IDLE:
            return None
        behaviour: Behaviour = self
        while isinstance(behaviour, Node):
            child = behaviour.current_child
            if child is None or child.status is IDLE:
                return behaviour
            behaviour = child
        return behaviour.tip()

    def stop(self, new_status: Status = IDLE) -> None:
        """Halt what is running here and below, and reset everything below; py_trees calls this."""
        if self.status is RUNNING:
            self._halt_running(self)
        for behaviour in self.iterate():
            if isinstance(behaviour, Node):
                behaviour.reset()
                behaviour.current_child = None
                behaviour.status = IDLE
            else:
                self.halt_child(behaviour)
        self.terminate(new_status)
        self.status = new_status

    def tick_now(self, child: Behaviour) -> None:
        """Tick a child outside a tick, while the node is halted; visitors do not see it."""
        if isinstance(child, Node):
            for _ in child.tick():
                pass
        elif child.children:
            for _ in self._tick_composite(child):
                pass
        else:
            self._tick_leaf(child)

    def halt_child(self, child: Behaviour) -> None:
        """Halt the child if it is running; it is idle afterwards in any case."""
        if child.status is RUNNING:
            self._halt_running(child)
        child.status = IDLE

    def halt_children(self) -> None:
        """Halt the children that are running; all are idle afterwards."""
        for child in self.children:
            if child.status is not IDLE:
                self.halt_child(child)

    def _fail(self, behaviour: Behaviour, error: Exception) -> Status:
        return fail(behaviour, error, self.tick_context.on_raise)

    def _halt_running(self, top: Behaviour) -> None:
        """Halt a behaviour that is running: its children first, in order, as BehaviorTree.CPP does."""
        halting = [(top, iter(_children_of(top)))]
        while halting:
            behaviour, children = halting[-1]
            child = next(children, None)
            if child is None:
                halting.pop()
                self._halt_alone(behaviour)
            elif child.status is RUNNING:
                halting.append((child, iter(_children_of(child))))
            else:
                child.status = IDLE

    def _halt_alone(self, behaviour: Behaviour) -> None:
        try:
            _halt(behaviour)
        except Exception as error:
            self._fail(behaviour, error)
            behaviour.status = IDLE

    def _start(self) -> Flow:
        conditions = self.bt_conditions
        return self.flow() if conditions is None else self._conditioned(conditions)

    def _conditioned(self, conditions: Conditions) -> Flow:
        outcome = conditions.before(self.status)
        if outcome is None:
            outcome = yield from self.flow()
        elif outcome is SKIPPED and self.status is RUNNING:
            self._halt_running(self)
        conditions.after(outcome)
        return outcome

    def _tick_leaf(self, leaf: Behaviour) -> Outcome:
        try:
            if "bt_conditions" in leaf.__dict__:
                return _tick_conditioned(leaf, leaf.__dict__["bt_conditions"])
            return _TICK_FUNCTIONS[type(leaf)](leaf)
        except Exception as error:
            return self._fail(leaf, error)

    def _tick_composite(self, composite: Behaviour) -> Flow:
        """Tick a composite or decorator of py_trees in its own way."""
        conditions = conditions_of(composite)
        try:
            if conditions is not None:
                return _tick_conditioned(composite, conditions)
            yield from composite.tick()
            return composite.status
        except Exception as error:
            return self._fail(composite, error)


def _children_of(behaviour: Behaviour) -> list[Behaviour]:
    """The children to be halted before a behaviour; composites of py_trees halt theirs themselves."""
    return behaviour.children if isinstance(behaviour, Node) else []


def _halt(behaviour: Behaviour) -> None:
    """Halt one behaviour; its children have been halted before."""
    if isinstance(behaviour, Node):
        behaviour.reset()
        behaviour.current_child = None
        behaviour.terminate(IDLE)
    else:
        behaviour.stop(IDLE)
    behaviour.status = IDLE
    conditions = conditions_of(behaviour)
    if conditions is not None:
        conditions.halted()


def _tick_action(leaf: Behaviour) -> Outcome:
    """Call ``initialise``, ``update`` and ``terminate`` as py_trees does, without its debug strings.

    As in BehaviorTree.CPP, an action that has ended does not start again before its parent has made it idle.
    """
    status = leaf.status
    if status is IDLE:
        leaf.initialise()
    elif status is not RUNNING:
        return status
    return _tick_condition(leaf)


def _tick_condition(leaf: Behaviour) -> Outcome:
    """Tick a leaf without ``initialise``: a condition, which is checked again also when it has ended."""
    status = leaf.update()
    if status is SUCCESS or status is FAILURE:
        leaf.terminate(status)
    elif status is not RUNNING:
        raise _not_a_status(status)
    leaf.status = status
    return status


def _tick_plain_condition(leaf: Behaviour) -> Outcome:
    """Tick a condition that defines ``update`` alone: as above, without calls that do nothing."""
    status = leaf.status = leaf.update()
    if status is SUCCESS or status is FAILURE or status is RUNNING:
        return status
    raise _not_a_status(status)


def _tick_with_py_trees(behaviour: Behaviour) -> Outcome:
    behaviour.tick_once()
    return behaviour.status


def _tick_conditioned(behaviour: Behaviour, conditions: Conditions) -> Outcome:
    outcome = conditions.before(behaviour.status)
    if outcome is None:
        outcome = _TICK_FUNCTIONS[type(behaviour)](behaviour)
    elif outcome is not SKIPPED:
        behaviour.status = outcome
    elif behaviour.status is RUNNING:
        _halt(behaviour)
    conditions.after(outcome)
    return outcome


def _not_a_status(status: object) -> TypeError:
    return TypeError(f"update() must return SUCCESS, FAILURE or RUNNING, not {status!r}")


def _tick_function(kind: type[Behaviour]) -> Callable[[Behaviour], Outcome]:
    if kind.tick not in (Behaviour.tick, Leaf.tick) or not _inherits(kind, "tick_once", "stop"):
        return _tick_with_py_trees
    if not _inherits(kind, "initialise"):
        return _tick_action
    return _tick_plain_condition if _inherits(kind, "terminate") else _tick_condition


def _inherits(kind: type[Behaviour], *methods: str) -> bool:
    """Whether a class inherits these methods from py_trees' base class."""
    return all(getattr(kind, method) is getattr(Behaviour, method) for method in methods)


class _TickFunctions(dict[type[Behaviour], Callable[[Behaviour], Outcome]]):
    """The function that ticks behaviours of a class, looked up once for each class."""

    def __missing__(self, kind: type[Behaviour]) -> Callable[[Behaviour], Outcome]:
        self[kind] = _tick_function(kind)
        return self[kind]


_TICK_FUNCTIONS = _TickFunctions()
