"""How the control nodes and decorators are ticked and halted: as in BehaviorTree.CPP v4, and as py_trees behaviours.

A node writes down what it does with its children as a coroutine (:meth:`Node.flow`): it yields the child to be
ticked, is sent the outcome, and returns its own. The node at the top of a tree runs the coroutines of all nodes below
it in one loop (:meth:`Node.tick`), which yields every node it has visited, as py_trees' visitors expect. One loop
instead of a generator inside a generator for each level, and no debug strings, is what makes our trees fast.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.conditions import Conditions, conditions_of
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.engine.tick_context import NO_RUNNER, TickContext

Flow = Generator[Behaviour, Outcome, Outcome]
"""Yields children, is sent what their ticks came to, returns what the node's own tick comes to."""


class Node(Behaviour):
    """A control node or decorator. Subclasses define :meth:`flow`, and :meth:`reset` if they keep anything."""

    bt_conditions: Conditions | None = None
    tick_context: TickContext = NO_RUNNER
    current_child: Behaviour | None = None

    def flow(self) -> Flow:
        """What the node does with its children, in one tick."""
        raise TypeError(f"{type(self).__name__} must define flow()")

    def reset(self) -> None:
        """The node is halted: the next tick begins anew."""

    def setup(self, **kwargs: Any) -> None:
        """Take what the runner offers: see :class:`~task_layer.bt.engine.tick_context.TickContext`."""
        self.tick_context = TickContext.of(kwargs)

    def update(self) -> Status:
        """Not used: a node's status comes of its :meth:`flow`."""
        return self.status

    def tick(self) -> Iterator[Behaviour]:
        """Tick once, and yield every node that is visited when it is left; py_trees calls this."""
        above: list[tuple[Node, Flow]] = []
        node: Node = self
        flow = self._begin()
        outcome: Any = None  # what starts a coroutine
        while True:
            try:
                child = flow.send(outcome)
            except StopIteration as end:
                outcome = end.value
                if outcome is not SKIPPED:
                    node.status = outcome
                    yield node
            except Exception as error:
                outcome = node.raised(node, error)
                yield node
            else:
                node.current_child = child
                if isinstance(child, Node):
                    above.append((node, flow))
                    node, flow, outcome = child, child._begin(), None
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
        """All nodes below this one, children before their parents, and this one; without recursion."""
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
        """The deepest node that the last tick came to, along the children ticked last; None if this one is idle."""
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
        """Halt whatever runs here and below, and let everything below begin anew; py_trees calls this."""
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

    def halt_child(self, child: Behaviour) -> None:
        """Halt the child if it runs; in any case it is idle afterwards."""
        if child.status is RUNNING:
            self._halt_running(child)
        child.status = IDLE

    def halt_children(self) -> None:
        """Halt all children that run; in any case they are idle afterwards."""
        for child in self.children:
            if child.status is not IDLE:
                self.halt_child(child)

    def raised(self, behaviour: Behaviour, error: Exception) -> Status:
        """A behaviour that raises has failed, and says why; the tree goes on."""
        self.tick_context.on_raise(behaviour, error)
        try:
            # A composite of py_trees halts what runs below it only for the sake of INVALID.
            behaviour.stop(IDLE if behaviour.children else FAILURE)
        except Exception as again:
            self.tick_context.on_raise(behaviour, again)
        behaviour.status = FAILURE
        behaviour.feedback_message = f"raised {type(error).__name__}: {error}"
        return FAILURE

    def _halt_running(self, top: Behaviour) -> None:
        """Halt a behaviour that runs: what is below it first, each child before the next, as BehaviorTree.CPP does."""
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
            self.raised(behaviour, error)
            behaviour.status = IDLE

    def _begin(self) -> Flow:
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
            return _HOW_TO_TICK[type(leaf)](leaf)
        except Exception as error:
            return self.raised(leaf, error)

    def _tick_composite(self, composite: Behaviour) -> Flow:
        """Tick a composite or decorator of py_trees its own way, whatever it has below it."""
        conditions = conditions_of(composite)
        try:
            if conditions is not None:
                return _tick_conditioned(composite, conditions)
            yield from composite.tick()
            return composite.status
        except Exception as error:
            return self.raised(composite, error)


def _children_of(behaviour: Behaviour) -> list[Behaviour]:
    """What must be halted before a behaviour; those of py_trees see to their children themselves."""
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


def _tick_leaf(leaf: Behaviour) -> Outcome:
    """Call ``initialise``, ``update`` and ``terminate`` as py_trees does, without its detours.

    As in BehaviorTree.CPP, an action that has ended is not started again until its parent has made it idle.
    """
    status = leaf.status
    if status is IDLE:
        leaf.initialise()
    elif status is not RUNNING:
        return status
    return _tick_unstarted_leaf(leaf)


def _tick_unstarted_leaf(leaf: Behaviour) -> Outcome:
    """A leaf that need not be started: a condition, which is asked again also when it has ended."""
    status = leaf.update()
    if status is SUCCESS or status is FAILURE:
        leaf.terminate(status)
    elif status is not RUNNING:
        raise _not_a_status(status)
    leaf.status = status
    return status


def _tick_stateless_leaf(leaf: Behaviour) -> Outcome:
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
        outcome = _HOW_TO_TICK[type(behaviour)](behaviour)
    elif outcome is not SKIPPED:
        behaviour.status = outcome
    elif behaviour.status is RUNNING:
        _halt(behaviour)
    conditions.after(outcome)
    return outcome


def _not_a_status(status: object) -> TypeError:
    return TypeError(f"update() must return SUCCESS, FAILURE or RUNNING, not {status!r}")


def _how_to_tick(kind: type[Behaviour]) -> Callable[[Behaviour], Outcome]:
    if not _as_behaviour(kind, "tick", "tick_once", "stop"):
        return _tick_with_py_trees
    if not _as_behaviour(kind, "initialise"):
        return _tick_leaf
    return _tick_stateless_leaf if _as_behaviour(kind, "terminate") else _tick_unstarted_leaf


def _as_behaviour(kind: type[Behaviour], *methods: str) -> bool:
    """Whether a class leaves these methods as py_trees' base class has them."""
    return all(getattr(kind, method) is getattr(Behaviour, method) for method in methods)


class _HowToTick(dict[type[Behaviour], Callable[[Behaviour], Outcome]]):
    """How the behaviours of a class are ticked, found out once for each."""

    def __missing__(self, kind: type[Behaviour]) -> Callable[[Behaviour], Outcome]:
        self[kind] = _how_to_tick(kind)
        return self[kind]


_HOW_TO_TICK = _HowToTick()
