"""Requests for actions, put to the knowledge base as one net change, and their answers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from enum import Enum

from rosa_core import KnowledgeBase, RequestRefusedError, Result
from rosa_core.kb import Utility

Accepted = Callable[[], bool]
"""Starts what was requested; says whether that calls for another look in the same tick, as when it is done already."""
Refused = Callable[[str], None]
"""Takes the reason of a refusal."""


class _State(Enum):
    COLLECTED = "not written yet"
    REQUIRED = "accepted by the knowledge base"
    ENDED = "refused, withdrawn, cancelled or finished"


def _nothing_to_start() -> bool:
    return False


@dataclass(slots=True, eq=False)
class ActionRequest:
    """One request for an action, from when it is made until it is cancelled or finished.

    Attributes:
        action: the action's name in the knowledge base.
        preference: the measure whose estimations are to decide between configurations.
        utility: weights and limits on estimated measures, instead of a preference.
        accepted: called once the knowledge base has the request: starts what carries the action out.
        refused: called instead with the reason, if it refuses.
    """

    action: str
    preference: str | None
    utility: Utility | None
    accepted: Accepted
    refused: Refused
    _state: _State = _State.COLLECTED


class ActionRequests:
    """What the task layer wants performed.

    Outside :meth:`together` each request goes to the knowledge base at once. Inside, they are collected and written
    in one transaction at the end: a tick that starts one action before it stops another is one change, and the
    adaptation loop never sees both or neither. What was requested starts when that is done, so that it finds its
    request accepted and, with synchronous dispatch, the architecture reconfigured as far as that takes no time.
    A request that is withdrawn before it is written leaves no trace; an action that several perform is required
    until the last of them ends.

    Args:
        kb: the knowledge base.
    """

    def __init__(self, kb: KnowledgeBase) -> None:
        self.kb = kb
        self.committing = False
        """True while collected requests are being written and what follows from them is dispatched."""
        self.answered = False
        """True if answers of the latest :meth:`together` call for another look in the same tick."""
        self._together = _Together(self)
        self._collecting = 0
        self._requests: list[ActionRequest] = []
        self._ends: list[tuple[str, Result]] = []
        self._held: Counter[str] = Counter()

    def request(
        self,
        action: str,
        *,
        preference: str | None = None,
        utility: Utility | None = None,
        accepted: Accepted = _nothing_to_start,
        refused: Refused,
    ) -> ActionRequest:
        """The action is to be performed; exactly one of ``accepted`` and ``refused`` is called, unless it is withdrawn.

        An action that is unfeasible now is refused at once.

        Args:
            action: the action's name.
            preference: the measure whose estimations are to decide between configurations.
            utility: weights and limits on estimated measures, instead of a preference.
            accepted: starts what carries the action out; returns whether that calls for another look in this tick.
            refused: takes the reason.

        Returns:
            the request, with which it is cancelled or finished.

        Raises:
            UnknownElementError: if there is no such action or measure.
            InvalidValueError: if both a preference and a utility are given.
        """
        request = ActionRequest(action, preference, utility, accepted, refused)
        if not self.kb.is_action_feasible(action):
            request._state = _State.ENDED
            refused(self.kb.why("action", action))
        elif self._collecting:
            self._requests.append(request)
        else:
            self._answer(request, self._write(request))
        return request

    def cancel(self, request: ActionRequest) -> None:
        """The action is no longer to be performed."""
        self._end(request, Result.ABANDONED)

    def finish(self, request: ActionRequest, result: Result) -> None:
        """The action was completed or has failed.

        Args:
            request: that was accepted; what has ended already is left as it is.
            result: ``completed`` or ``failed``.
        """
        self._end(request, result)

    def together(self) -> AbstractContextManager[None]:
        """Everything asked for in this block is one change, made at its end; also if the block raises.

        Requests are answered after that, in the order in which they were made. They are not if the block raises:
        nothing is started then. Of blocks within one another the outermost counts.
        """
        return self._together

    def _end(self, request: ActionRequest, result: Result) -> None:
        before, request._state = request._state, _State.ENDED
        if before is _State.REQUIRED:
            self._held[request.action] -= 1
            if self._held[request.action]:
                return
            if self._collecting:
                self._ends.append((request.action, result))
            else:
                self.kb.finish_action(request.action, result)

    def _commit(self) -> list[tuple[ActionRequest, str | None]]:
        """Write what was collected: first what ends, since the same action may be requested again in this tick."""
        requests = [request for request in self._requests if request._state is _State.COLLECTED]
        ends = self._ends
        self._requests, self._ends = [], []
        if not requests and not ends:
            return []
        self.committing = True
        try:
            with self.kb.transaction():
                for action, result in ends:
                    self.kb.finish_action(action, result)
                return [(request, self._write(request)) for request in requests]
        finally:
            self.committing = False

    def _write(self, request: ActionRequest) -> str | None:
        """Put a request to the knowledge base; why it refuses, if it does."""
        try:
            self.kb.request_action(request.action, request.preference, request.utility)
        except RequestRefusedError as error:
            request._state = _State.ENDED
            return str(error)
        request._state = _State.REQUIRED
        self._held[request.action] += 1
        return None

    def _answer(self, request: ActionRequest, refusal: str | None) -> bool:
        """Report to whoever made a request what has become of it; whether there is something to look at now."""
        if refusal is None:
            # Another one's start may have ended it in the meantime.
            return request._state is _State.REQUIRED and request.accepted()
        request.refused(refusal)
        return True


class _Together(AbstractContextManager[None]):
    """The block of :meth:`ActionRequests.together`: a class, since a generator would cost as much as a quiet tick."""

    def __init__(self, requests: ActionRequests) -> None:
        self._requests = requests

    def __enter__(self) -> None:
        requests = self._requests
        if not requests._collecting:
            requests.answered = False
        requests._collecting += 1

    def __exit__(self, kind: type[BaseException] | None, error: object, traceback: object) -> None:
        requests = self._requests
        requests._collecting -= 1
        if requests._collecting or not (requests._requests or requests._ends):
            return
        answers = requests._commit()
        if kind is None:
            for request, reason in answers:
                requests.answered |= requests._answer(request, reason)
