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
    """A node with one child, which is made idle as soon as it has ended.

    Args:
        name: the node's name in the tree.
        child: the child.
    """

    def __init__(self, name: str, child: Behaviour) -> None:
        decorators.Decorator.__init__(self, name, child)


class _StatusMap(Decorator):
    """Maps the outcome of its child to another."""

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
    """Maps SUCCESS to FAILURE, and FAILURE to SUCCESS.

    Args:
        name: the node's name in the tree.
        child: the child.
    """

    _success = FAILURE
    _failure = SUCCESS


class ForceSuccess(_StatusMap):
    """Maps FAILURE to SUCCESS.

    Args:
        name: the node's name in the tree.
        child: the child.
    """

    _failure = SUCCESS


class ForceFailure(_StatusMap):
    """Maps SUCCESS to FAILURE.

    Args:
        name: the node's name in the tree.
        child: the child.
    """

    _success = FAILURE


class SubTree(Decorator):
    """The root of a tree that has its own blackboard (see :mod:`task_layer.bt.ports.blackboard`).

    Args:
        name: the node's name in the tree.
        child: the root of that tree.
    """

    def flow(self) -> Flow:
        """Pass on the outcome of the tree below; the status stays when that tree is skipped."""
        if self.status is IDLE:
            self.status = RUNNING
        outcome = yield self.decorated
        if outcome in _ENDED:
            self.halt_child(self.decorated)
        return outcome


class KeepRunningUntilFailure(_StatusMap):
    """Maps SUCCESS and SKIPPED to RUNNING; the child starts again at the next tick.

    Args:
        name: the node's name in the tree.
        child: the child.
    """

    _success = RUNNING
    _skipped = RUNNING


class _Repeating(Decorator):
    """Ticks its child again after the outcome ``_repeat_on``, up to a number of times."""

    _repeat_on: Status
    _parameter: str
    _rereads_limit = False  # whether a change of the number counts within a tick

    def __init__(self, name: str, child: Behaviour, limit: Parameter[int]) -> None:
        super().__init__(name, child)
        self._limit = limit
        self._count = 0
        self._child_begun = -1
        if not callable(limit):
            self._current_limit()

    def flow(self) -> Flow:
        child = self.decorated
        limit = self._current_limit()
        self.status = RUNNING
        while limit == -1 or self._count < limit:
            was_idle = child.status is IDLE
            if was_idle:
                self._child_begun = self.tick_context.tick_number()
            outcome = yield child
            if outcome is RUNNING:
                return outcome
            self.halt_child(child)
            if outcome is SKIPPED:
                return outcome
            if outcome is not self._repeat_on:
                self._count = 0
                return outcome
            self._count += 1
            self.steps_done = 0 if limit == -1 else self._count
            if self._rereads_limit:
                limit = self._current_limit()
            began_now = was_idle or self._child_begun == self.tick_context.tick_number()
            if began_now and (limit == -1 or self._count < limit):
                self.tick_context.wake()
                return RUNNING
        self._count = 0
        return self._repeat_on

    def reset(self) -> None:
        """Count from zero."""
        self._count = 0

    def _current_limit(self) -> int:
        limit = value_of(self._limit)
        if limit < -1:
            raise ValueError(f"{self._parameter} of '{self.name}' must be a number, or -1 for ever, not {limit}")
        return limit


class RetryUntilSuccessful(_Repeating):
    """Ticks its child again when it fails: SUCCESS when it succeeds, FAILURE after the last attempt.

    After an attempt that failed on its first tick it returns RUNNING and asks for the next tick at once; a child that
    was running before it failed is tried again in the same tick.

    Args:
        name: the node's name in the tree.
        child: the child.
        num_attempts: the largest number of attempts; -1 for no limit.

    Raises:
        ValueError: if ``num_attempts`` is less than -1.
    """

    _repeat_on = FAILURE
    _parameter = "num_attempts"
    _rereads_limit = True

    def __init__(self, name: str, child: Behaviour, num_attempts: Parameter[int]) -> None:
        super().__init__(name, child, num_attempts)

    @property
    def num_attempts(self) -> Parameter[int]:
        """The largest number of attempts."""
        return self._limit


class Repeat(_Repeating):
    """Ticks its child again when it succeeds: FAILURE when it fails, SUCCESS after the last cycle.

    Between cycles it returns RUNNING as :class:`RetryUntilSuccessful` does between attempts.

    Args:
        name: the node's name in the tree.
        child: the child.
        num_cycles: the number of cycles; -1 for no limit.

    Raises:
        ValueError: if ``num_cycles`` is less than -1.
    """

    _repeat_on = SUCCESS
    _parameter = "num_cycles"

    def __init__(self, name: str, child: Behaviour, num_cycles: Parameter[int]) -> None:
        super().__init__(name, child, num_cycles)

    @property
    def num_cycles(self) -> Parameter[int]:
        """The number of cycles."""
        return self._limit


class Timeout(Decorator):
    """Halts its child when it takes too long, and fails.

    Args:
        name: the node's name in the tree.
        child: the child.
        msec: how long the child may take, in ms of the tree's clock; 0 for no limit.
    """

    def __init__(self, name: str, child: Behaviour, msec: Parameter[int]) -> None:
        super().__init__(name, child)
        self.msec = msec
        self._deadline: float | None = None

    def flow(self) -> Flow:
        """Tick the child, or halt it if its time is over."""
        tick_context, child = self.tick_context, self.decorated
        if self._deadline is None:
            self.status = RUNNING
            msec = value_of(self.msec)
            self._deadline = math.inf if msec == 0 else _later(tick_context, msec)
        if tick_context.clock.now() >= self._deadline:
            if child.status is RUNNING:
                self.halt_child(child)
                self._deadline = None
                self.feedback_message = f"{child.name} took too long"
                return FAILURE
            self._deadline = math.inf  # the child was not running at the deadline
        outcome = yield child
        if outcome in _ENDED:
            self._deadline = None
            self.halt_child(child)
        return outcome

    def reset(self) -> None:
        """Discard the deadline."""
        self._deadline = None


class Delay(Decorator):
    """Waits before it ticks its child, at least until the next tick.

    Args:
        name: the node's name in the tree.
        child: the child.
        delay_msec: how long to wait before the child's first tick, in ms of the tree's clock.
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
        """Discard the time to wait for."""
        self._until = None


class RunOnce(Decorator):
    """Ticks its child until it has ended once. Afterwards it is skipped, or repeats the child's outcome.

    Args:
        name: the node's name in the tree.
        child: the child.
        then_skip: whether it is skipped afterwards.
    """

    def __init__(self, name: str, child: Behaviour, then_skip: Parameter[bool] = True) -> None:
        super().__init__(name, child)
        self.then_skip = then_skip
        self._outcome: Status | None = None

    def flow(self) -> Flow:
        """Tick the child unless it has ended before."""
        if self._outcome is not None:
            return SKIPPED if value_of(self.then_skip) else self._outcome
        self.status = RUNNING
        outcome = yield self.decorated
        if outcome is SUCCESS or outcome is FAILURE:
            self._outcome = outcome
            self.halt_child(self.decorated)
        return outcome


def _later(tick_context: TickContext, msec: float) -> float:
    """The time ``msec`` from now, in s; asks for a tick then.

    Raises:
        ValueError: if the time is negative.
    """
    if msec < 0:
        raise ValueError(f"{msec:g} ms: a time cannot be negative")
    time = tick_context.clock.now() + msec / 1000.0
    tick_context.wake_at(time)
    return time
