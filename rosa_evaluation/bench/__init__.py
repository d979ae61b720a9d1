"""How fast inference is, beside recomputing everything and beside an answer-set solver with the same rules."""
