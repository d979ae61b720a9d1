"""How large the trees in XML files may be: files come from outside, and reading one must end."""

from __future__ import annotations

MAX_BYTES = 4_000_000
"""Bytes of one file."""

MAX_FILES = 10_000
"""Files of a project: those that are given or in its folder, and those that they include."""

MAX_ENTRIES = 200_000
"""Files of any kind and folders that are looked at in search of a project's files."""

MAX_TOTAL_BYTES = 100_000_000
"""Bytes of all files of a project."""

MAX_DEPTH = 200
"""Levels of nodes, subtrees counted in: building and checking a tree recurses."""

MAX_NODES = 20_000
"""Nodes of a tree, its subtrees counted in as often as they are used."""

MAX_OUTLINE_NODES = 10_000
"""Nodes of a tree that is shown; more cannot be looked at."""

MAX_PROBLEMS = 100
"""Problems that are reported at once."""
