"""How fast inference is, compared with recomputing everything and with an answer-set solver under the same rules."""
