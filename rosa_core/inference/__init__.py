"""What follows from the facts: the status rules, the network along which changes travel, explanations and remedies.

Read :mod:`~rosa_core.inference.rules` first: the rules are the specification (ROSA paper, section 5.2).
"""

from rosa_core.inference.explanation import Explanation, explain
from rosa_core.inference.reasoner import Reasoner
from rosa_core.inference.remedies import Remedy, find_remedy

__all__ = ["Explanation", "Reasoner", "Remedy", "explain", "find_remedy"]
