"""Requests for actions, put to the knowledge base as one net change."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rosa_core import KnowledgeBase, RequestRefusedError, Result
from rosa_core.kb import Utility

Refusal = Callable[[str], None]


class ActionRequests:
    """What the task layer wants performed.

    Outside :meth:`together` each request goes to the knowledge base at once. Inside, they are collected and written
    in one transaction at the end: a tick that starts one action before it stops another is one change, and the
    adaptation loop never sees both or neither.
    """

    def __init__(self, kb: KnowledgeBase) -> None:
        self.kb = kb
        self.committing = False
        """True while collected requests are being written and what follows from them is dispatched."""
        self._collected: list[Callable[[], object]] | None = None

    def request(
        self, action: str, *, preference: str | None = None, utility: Utility | None = None, refused: Refusal
    ) -> None:
        """The action is to be performed; ``refused`` is called with the reason if the knowledge base refuses.

        Raises:
            UnknownElementError: if there is no such action or measure.
            InvalidValueError: if both a preference and a utility are given.
        """

        def request() -> None:
            try:
                self.kb.request_action(action, preference, utility)
            except RequestRefusedError as error:
                refused(str(error))

        self._put(request)

    def cancel(self, action: str) -> None:
        """The action is no longer to be performed."""
        self._put(lambda: self.kb.cancel_action(action))

    def finish(self, action: str, result: Result) -> None:
        """The action was completed or has failed."""
        self._put(lambda: self.kb.finish_action(action, result))

    @contextmanager
    def together(self) -> Iterator[None]:
        """Everything asked for in this block is one change, made at its end; also if the block raises."""
        if self._collected is not None:
            yield
            return
        self._collected = []
        try:
            yield
        finally:
            collected, self._collected = self._collected, None
            self._commit(collected)

    def _put(self, write: Callable[[], object]) -> None:
        if self._collected is None:
            write()
        else:
            self._collected.append(write)

    def _commit(self, collected: list[Callable[[], object]]) -> None:
        if not collected:
            return
        self.committing = True
        try:
            with self.kb.transaction():
                for write in collected:
                    write()
        finally:
            self.committing = False
