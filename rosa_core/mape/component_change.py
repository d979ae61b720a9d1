"""One change to one component: asked for, tried again, and over when the component is as it was wanted."""

from __future__ import annotations

import logging
from collections.abc import Callable
from concurrent.futures import Future

from rosa_core.clock import Clock
from rosa_core.mape.managed_system import Answer, ComponentState

logger = logging.getLogger(__name__)

_STOPPED = (ComponentState.INACTIVE, ComponentState.ABSENT)


class ComponentChange:
    """A call to a managed system that may take time, and how it ends.

    If the component's state can be asked, the state decides, not the answer: the call is made only if the component is
    not yet as wanted, and the change is done when it is, whatever the call has answered. Nothing is asked of a
    component whose state is unknown, nor again while an answer is outstanding: it would queue up and take effect later.

    Args:
        component: whose change it is, for the log.
        call: makes the change, or begins it.
        clock: by which the limit counts.
        limit: how long one attempt may take, in s.
        attempts: how often it is tried.
        wanted: whether the component is to be active at the end; None if that is not what changes.
        state: what the component does now; None if that cannot be asked.
        wake: called, in any thread, when an outstanding answer has come.
    """

    def __init__(
        self,
        component: str,
        call: Callable[[], Answer],
        *,
        clock: Clock,
        limit: float,
        attempts: int,
        wanted: bool | None = None,
        state: Callable[[], ComponentState] | None = None,
        wake: Callable[[], object] = lambda: None,
    ) -> None:
        self._component = component
        self._call = call
        self._clock = clock
        self._limit = limit
        self._attempts_left = attempts
        self._attempt = 0
        self._wanted = wanted
        self._state = state
        self._wake = wake
        self._answer: Future[bool | None] | None = None
        self._asked = False
        self.deadline: float | None = None
        """When the present attempt is over, in s; None before the first."""
        self.succeeded: bool | None = None
        """Whether the component is as wanted; None: not known yet."""

    def advance(self) -> bool:
        """Go on as far as that is possible without waiting.

        Returns:
            whether it is over; else look again when the state changes, an answer comes, or the deadline is over.
        """
        while self.succeeded is None:
            if self.deadline is None:
                self.deadline = self._clock.now() + self._limit
            reason = self._look()
            if self.succeeded is not None:
                break
            if reason is None and self._clock.now() < self.deadline:
                return False
            self._end_attempt(reason or self._overdue())
        return True

    def _look(self) -> str | None:
        """Ask, if it is time to, and see what has come of it: the reason if the attempt has failed, None for now."""
        if self._asked:
            reason = self._outcome()
        elif self._is_as_wanted():
            self.succeeded = True
            return None
        elif self._cannot_be_asked():
            return None
        else:
            self._asked = True
            reason = self._ask()
        if self._wanted is not None and self._state is not None:
            return self._judge_by_state(self._state(), reason)
        if reason is None and self._is_answered() and self._known() is not ComponentState.UNKNOWN:
            self.succeeded = True
        return reason

    def _judge_by_state(self, state: ComponentState, reason: str | None) -> str | None:
        if self._is_as_wanted():
            self.succeeded = True
            return None
        if state is ComponentState.UNKNOWN or not self._is_answered():
            return None
        return f"it is {state.value}" if reason is None else reason

    def _ask(self) -> str | None:
        try:
            answer = self._call()
        except Exception as error:
            return f"{type(error).__name__}: {error}"
        if isinstance(answer, Future):
            self._answer = answer
            answer.add_done_callback(lambda _: self._wake())
            return self._outcome()
        return "it was refused" if answer is False else None

    def _outcome(self) -> str | None:
        """Why the outstanding call has failed, if it has."""
        if self._answer is None or not self._answer.done():
            return None
        if self._answer.cancelled():
            return "it was cancelled"
        error = self._answer.exception()
        if error is not None:
            return f"{type(error).__name__}: {error}"
        return "it was refused" if self._answer.result() is False else None

    def _is_answered(self) -> bool:
        return self._answer is None or self._answer.done()

    def _is_as_wanted(self) -> bool:
        if self._wanted is None or self._state is None:
            return False
        return self._state() in (_STOPPED if not self._wanted else (ComponentState.ACTIVE,))

    def _known(self) -> ComponentState | None:
        return None if self._state is None else self._state()

    def _cannot_be_asked(self) -> bool:
        """It is changing already, or has not come yet."""
        known = self._known()
        absent = self._wanted is True and known is ComponentState.ABSENT
        return absent or (self._wanted is not None and known is ComponentState.UNKNOWN)

    def _overdue(self) -> str:
        known = self._known()
        state = "" if known is None else f", it is {known.value}"
        return f"not within {self._limit:g} s{state}"

    def _end_attempt(self, reason: str) -> None:
        self._attempt += 1
        self._attempts_left -= 1
        self.deadline = None
        if self._is_answered():
            self._asked, self._answer = False, None
        logger.warning("reconfiguring '%s' failed (attempt %d): %s", self._component, self._attempt, reason)
        if self._attempts_left == 0:
            self.succeeded = False
            if self._answer is not None:
                self._answer.cancel()
