"""What TypeQL plugs into the knowledge base: the reader of ``.tql`` files and the language of queries.

:mod:`rosa_core.plugins` names this module and its two functions.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_typeql.model_format import read_typeql
from rosa_typeql.query import PreparedQuery
from rosa_typeql.run_time_view import snapshot
from rosa_typeql.things import FactTables

__all__ = ["prepare_query", "read_typeql"]


class _TypeQLQuery:
    """A TypeQL query, answered from a snapshot of the facts of the types that it names."""

    def __init__(self, text: str) -> None:
        self._prepared = PreparedQuery(text)

    @property
    def types(self) -> Collection[str]:
        """The exact types of the facts that it looks at."""
        return self._prepared.types

    def snapshot(self, state: RuntimeState, history: History) -> FactTables:
        """Copy the facts of these types."""
        return snapshot(state.model, state, history, self.types)

    def rows(self, snapshot: FactTables) -> list[dict[str, Any]]:
        """The answer."""
        return self._prepared.rows(snapshot)


def prepare_query(text: str) -> _TypeQLQuery:
    """Read and check a read query in TypeQL 2.x.

    Raises:
        QueryError: if it cannot be read, writes, or asks for what is not known; with line and hint.
    """
    return _TypeQLQuery(text)
