"""What TypeQL plugs into the knowledge base: the reader of ``.tql`` files and the language of queries.

:mod:`rosa_core.plugins` names this module and the two functions.
"""

from rosa_typeql.models.reader import read_typeql
from rosa_typeql.queries.query import PreparedQuery as prepare_query  # noqa: N813

__all__ = ["prepare_query", "read_typeql"]
