"""The port for query languages: what ``KnowledgeBase.query`` asks of one."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Any, Protocol

from rosa_core.errors import QueryError
from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_core.plugins import MissingPluginError, Plugin

TYPEQL = Plugin("rosa_typeql.plugin", "prepare_query", "a TypeQL query")
"""The query language of :meth:`rosa_core.KnowledgeBase.query`: a :class:`QueryLanguage`."""


class PreparedQuery(Protocol):
    """A query that has been read and checked."""

    def snapshot(self, state: RuntimeState, history: History) -> Any:
        """Copy what the query looks at. Called while writes are locked out; must not change anything.

        Args:
            state: the model (``state.model``), the inference network (``state.reasoner``) and the run-time facts.
            history: what has ended or been measured, as far as memory is kept for it.

        Returns:
            whatever :meth:`rows` needs; later writes must not change it.
        """
        ...

    def rows(self, snapshot: Any) -> list[dict[str, Any]]:
        """The answer, from what :meth:`snapshot` returned. Called when others may write again.

        Raises:
            QueryError: if it would take too long, or a value is not what the query needs.
        """
        ...


class QueryLanguage(Protocol):
    """Reads queries."""

    def __call__(self, text: str) -> PreparedQuery:
        """Read and check a query.

        Raises:
            QueryError: if it cannot be read, writes, or asks for what is not known; with line and hint.
        """
        ...


def answer(
    text: str, state: RuntimeState, history: History, lock: AbstractContextManager[object]
) -> list[dict[str, Any]]:
    """The rows that a query finds; writes are locked out only while the snapshot is taken.

    Args:
        text: the query, in TypeQL.
        state: what is known now.
        history: what was known before.
        lock: held by whoever writes.

    Returns:
        a plain dictionary for each row.

    Raises:
        QueryError: if the query cannot be answered, or its language is not installed.
    """
    try:
        prepare: QueryLanguage = TYPEQL.load()
    except MissingPluginError as error:
        raise QueryError(error.problems) from None
    query = prepare(text)
    with lock:
        snapshot = query.snapshot(state, history)
    return query.rows(snapshot)
