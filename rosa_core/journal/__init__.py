"""A file in which every write to a knowledge base is durable, and from which its state is restored.

Here are the options; :mod:`rosa_core.journal.journal` writes a journal and :mod:`rosa_core.journal.tables` reads one.
These two are not imported here: SQLite takes its time to import, and most knowledge bases have no journal.
"""

from rosa_core.journal.options import JournalOptions, Retention

__all__ = ["JournalOptions", "Retention"]
