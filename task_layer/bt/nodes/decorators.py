"""The decorators of BehaviorTree.CPP v4, as py_trees decorators."""

from __future__ import annotations

import math

from py_trees import decorators
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.engine.tick_context import TickContext
from task_layer.bt.ports.parameter import Parameter, value_of

_ENDED = (SUCCESS, FAILURE)


class Decorator(Node, decorators.Decorator):
    """A node with one child. A child that has ended is idle again at once.

    Args:
        name: the node's name in the tree.
        child: what it ticks.
    """

    def __init__(self, name: str, child: Behaviour) -> None:
        decorators.Decorator.__init__(self, name, child)


class _StatusMap(Decorator):
    """Gives its parent something else than its child gave it."""

    _success = SUCCESS
    _failure = FAILURE
    _skipped: Outcome = SKIPPED

    def flow(self) -> Flow:
        self.status = RUNNING
        child = self.decorated
        outcome = yield child
        if outcome is SUCCESS:
            self.halt_child(child)
            return self._success
        if outcome is FAILURE:
            self.halt_child(child)
            return self._failure
        return self._skipped if outcome is SKIPPED else outcome


class Inverter(_StatusMap):
    """SUCCESS becomes FAILURE, and FAILURE SUCCESS."""

    _success = FAILURE
    _failure = SUCCESS


class ForceSuccess(_StatusMap):
    """FAILURE becomes SUCCESS."""

    _failure = SUCCESS


class ForceFailure(_StatusMap):
    """SUCCESS becomes FAILURE."""

    _success = FAILURE


class SubTree(Decorator):
    """The root of a tree that has its own blackboard (see :mod:`task_layer.bt.ports.blackboard`)."""

    def flow(self) -> Flow:
        """Pass on what the tree below comes to; it keeps its own status when that is skipped."""
        if self.status is IDLE:
            self.status = RUNNING
        outcome = yield self.decorated
        if outcome in _ENDED:
            self.halt_child(self.decorated)
        return outcome


class KeepRunningUntilFailure(_StatusMap):
    """SUCCESS becomes RUNNING, and the child starts anew at the next tick. So does a child that is skipped."""

    _success = RUNNING
    _skipped = RUNNING


class _Repeating(Decorator):
    """Ticks its child again when it comes to ``_again``, up to a number of times."""

    _again: Status
    _parameter: str
    _reads_again = False  # whether the child may change the number while it is repeated in one tick

    def __init__(self, name: str, child: Behaviour, limit: Parameter[int]) -> None:
        super().__init__(name, child)
        self._limit = limit
        self._done = 0
        if not callable(limit):
            self._limit_now()

    def flow(self) -> Flow:
        child = self.decorated
        limit = self._limit_now()
        self.status = RUNNING
        while limit == -1 or self._done < limit:
            was_idle = child.status is IDLE
            outcome = yield child
            if outcome is RUNNING:
                return outcome
            self.halt_child(child)
            if outcome is SKIPPED:
                return outcome
            if outcome is not self._again:
                self._done = 0
                return outcome
            self._done += 1
            if self._reads_again:
                limit = self._limit_now()
            if was_idle and (limit == -1 or self._done < limit):
                self.tick_context.wake()
                return RUNNING
        self._done = 0
        return self._again

    def reset(self) -> None:
        """Count from the start."""
        self._done = 0

    def _limit_now(self) -> int:
        limit = value_of(self._limit)
        if limit < -1:
            raise ValueError(f"{self._parameter} of '{self.name}' must be a number, or -1 for ever, not {limit}")
        return limit


class RetryUntilSuccessful(_Repeating):
    """Tries its child again when it fails.

    After an attempt that failed on its first tick it yields (RUNNING) and asks to be ticked again at once; a child
    that was running before it failed is tried again in the same tick.

    Args:
        name: the node's name in the tree.
        child: what it tries.
        num_attempts: how often, at most; -1 for ever.

    Raises:
        ValueError: if ``num_attempts`` is less than -1.
    """

    _again = FAILURE
    _parameter = "num_attempts"
    _reads_again = True

    def __init__(self, name: str, child: Behaviour, num_attempts: Parameter[int]) -> None:
        super().__init__(name, child, num_attempts)

    @property
    def num_attempts(self) -> Parameter[int]:
        """How often, at most."""
        return self._limit


class Repeat(_Repeating):
    """Does its child again when it has succeeded; yields as :class:`RetryUntilSuccessful` does.

    Args:
        name: the node's name in the tree.
        child: what it repeats.
        num_cycles: how often; -1 for ever.

    Raises:
        ValueError: if ``num_cycles`` is less than -1.
    """

    _again = SUCCESS
    _parameter = "num_cycles"

    def __init__(self, name: str, child: Behaviour, num_cycles: Parameter[int]) -> None:
        super().__init__(name, child, num_cycles)

    @property
    def num_cycles(self) -> Parameter[int]:
        """How often."""
        return self._limit


class Timeout(Decorator):
    """Halts its child when it takes too long, and fails.

    Args:
        name: the node's name in the tree.
        child: what must end in time.
        msec: how long it may take, in ms of the tree's clock; 0 for as long as it likes.
    """

    def __init__(self, name: str, child: Behaviour, msec: Parameter[int]) -> None:
        super().__init__(name, child)
        self.msec = msec
        self._deadline: float | None = None

    def flow(self) -> Flow:
        """Tick the child unless its time is over."""
        tick_context, child = self.tick_context, self.decorated
        if self._deadline is None:
            self.status = RUNNING
            self._deadline = _later(tick_context, value_of(self.msec)) if value_of(self.msec) > 0 else math.inf
        if tick_context.clock.now() >= self._deadline:
            if child.status is RUNNING:
                self.halt_child(child)
                self._deadline = None
                self.feedback_message = f"{child.name} took too long"
                return FAILURE
            self._deadline = math.inf  # nothing ran when the time was over
        outcome = yield child
        if outcome in _ENDED:
            self._deadline = None
            self.halt_child(child)
        return outcome

    def reset(self) -> None:
        """Take the time anew."""
        self._deadline = None


class Delay(Decorator):
    """Waits before it ticks its child, at least until the next tick.

    Args:
        name: the node's name in the tree.
        child: what is ticked then.
        delay_msec: how long to wait, in ms of the tree's clock.
    """

    def __init__(self, name: str, child: Behaviour, delay_msec: Parameter[int]) -> None:
        super().__init__(name, child)
        self.delay_msec = delay_msec
        self._until: float | None = None

    def flow(self) -> Flow:
        """Wait, then tick the child until it has ended."""
        if self._until is None:
            self.status = RUNNING
            self._until = _later(self.tick_context, value_of(self.delay_msec))
            return RUNNING
        if self.tick_context.clock.now() < self._until:
            return RUNNING
        outcome = yield self.decorated
        if outcome in _ENDED:
            self._until = None
            self.halt_child(self.decorated)
        return outcome

    def reset(self) -> None:
        """Wait anew."""
        self._until = None


class RunOnce(Decorator):
    """Does its child once. Afterwards it is skipped, or comes to the same again.

    Args:
        name: the node's name in the tree.
        child: what is done once.
        then_skip: whether it is skipped afterwards.
    """

    def __init__(self, name: str, child: Behaviour, then_skip: Parameter[bool] = True) -> None:
        super().__init__(name, child)
        self.then_skip = then_skip
        self._came_to: Status | None = None

    def flow(self) -> Flow:
        """Tick the child unless it has ended before."""
        if self._came_to is not None:
            return SKIPPED if value_of(self.then_skip) else self._came_to
        self.status = RUNNING
        outcome = yield self.decorated
        if outcome is SUCCESS or outcome is FAILURE:
            self._came_to = outcome
            self.halt_child(self.decorated)
        return outcome


def _later(tick_context: TickContext, msec: float) -> float:
    """The time ``msec`` from now, in s; a tick is asked for then."""
    time = tick_context.clock.now() + msec / 1000.0
    tick_context.wake_at(time)
    return time
