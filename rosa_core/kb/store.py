"""How a run-time state is written: in transactions, by several threads, journalled and announced."""

from __future__ import annotations

import threading
from contextlib import AbstractContextManager
from types import TracebackType
from typing import TYPE_CHECKING

from rosa_core.clock import Clock
from rosa_core.errors import KnowledgeBaseClosedError, KnowledgeBaseError
from rosa_core.kb.dispatcher import Dispatcher
from rosa_core.kb.events import StatusesChanged
from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import BEGINNING, Savepoint, Transaction

if TYPE_CHECKING:
    from rosa_core.journal.journal import Journal


class Store:
    """Writes a state and keeps it whole: a write happens, is journalled and announced as a whole, or not at all.

    Args:
        state: what is written.
        clock: where the times of writes come from.
        dispatcher: who announces them.
        history: what keeps them in memory.
        journal: what makes them durable before they are announced, if anything does.
        revision: how many writes there have been before.
    """

    def __init__(
        self,
        state: RuntimeState,
        clock: Clock,
        dispatcher: Dispatcher,
        history: History,
        journal: Journal | None = None,
        revision: int = 0,
    ) -> None:
        self.lock = threading.RLock()
        """Held while anything is written, and by whoever reads several facts that belong together."""
        self.journal = journal
        self.revision = revision
        """How many writes have changed something."""
        self._state = state
        self._clock = clock
        self._dispatcher = dispatcher
        self._history = history
        self._open_transaction = Transaction()
        self._transaction_is_open = False
        self._closing = self._closed = False

    def close(self, timeout: float = 10.0) -> None:
        """Deliver what has been announced, and end: from now on writes are refused, and what is known can be read.

        Closing it again does nothing. Until everything is delivered, subscribers may still write: what they do about
        the last writes belongs to those.

        Args:
            timeout: how long to wait for subscribers (seconds); after that, what they have not received is dropped.

        Raises:
            KnowledgeBaseError: within a transaction.
        """
        with self.lock:
            if self._transaction_is_open:
                raise KnowledgeBaseError(
                    "the knowledge base cannot be closed within a transaction; close it after that"
                )
            if self._closed:
                return
            self._closing = True
        self._dispatcher.drain(timeout)
        with self.lock:
            if not self._closed and self.journal is not None:
                self.journal.close(self._state, self.revision, self._clock.now())
            self._closed = True
        self._dispatcher.close(timeout)

    def transaction(self) -> AbstractContextManager[Transaction]:
        """Several writes as one. Within another transaction, what the block did is taken back if it raises."""
        return _Scope(self, can_be_taken_back=True)

    def write(self) -> AbstractContextManager[Transaction]:
        """One write: inside the transaction that is open, or one of its own. Validate before changing anything."""
        return _Scope(self, can_be_taken_back=False)

    def _begin(self) -> Transaction:
        if self._closed or (self._closing and not self._dispatcher.is_delivering()):
            raise KnowledgeBaseClosedError("the knowledge base is closed: nothing is written to it any more")
        self._open_transaction = transaction = Transaction()
        self._transaction_is_open = True
        return transaction

    def _commit(self, transaction: Transaction) -> None:
        now = self._clock.now()
        events = list(transaction.events(self.revision + 1, now, self._state.reasoner))
        revision = self.revision + 1 if events else self.revision
        if self.journal is not None and transaction.facts:
            changes = next((event.changes for event in events if isinstance(event, StatusesChanged)), ())
            self.journal.append(revision, now, transaction.facts, changes)
        # From here on the write stands, whatever happens.
        transaction.undo.clear()
        self.revision = revision
        self._history.record(events)
        self._dispatcher.announce(events)
        if self.journal is not None:
            self.journal.keep_up(self._state, revision, now)


class _Scope:
    """A transaction, or a part of the one that is open.

    Args:
        store: what is written to.
        can_be_taken_back: by itself, when it is part of another and raises; that costs a savepoint.
    """

    # Not a generator with @contextmanager: every measurement goes through here.
    __slots__ = ("_can_be_taken_back", "_is_outermost", "_savepoint", "_store")

    def __init__(self, store: Store, *, can_be_taken_back: bool) -> None:
        self._store = store
        self._can_be_taken_back = can_be_taken_back
        self._savepoint: Savepoint | None = None
        self._is_outermost = False

    def __enter__(self) -> Transaction:
        store = self._store
        store.lock.acquire()
        try:
            if not store._transaction_is_open:
                transaction = store._begin()
                self._is_outermost = True
                self._savepoint = BEGINNING
                return transaction
            if self._can_be_taken_back:
                self._savepoint = store._open_transaction.savepoint()
            return store._open_transaction
        except BaseException:
            store.lock.release()
            raise

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        store = self._store
        try:
            self._end(store._open_transaction, succeeded=kind is None)
        finally:
            if self._is_outermost:
                store._transaction_is_open = False
            store.lock.release()
        if self._is_outermost and kind is None:
            store._dispatcher.deliver()

    def _end(self, transaction: Transaction, *, succeeded: bool) -> None:
        store = self._store
        try:
            if succeeded:
                store._state.reasoner.infer()
                if self._is_outermost:
                    store._commit(transaction)
        except BaseException:
            if self._is_outermost:
                store._state.roll_back(transaction, BEGINNING)
            raise
        if not succeeded and self._savepoint is not None:
            store._state.roll_back(transaction, self._savepoint)
