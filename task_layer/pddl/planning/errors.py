"""What can go wrong in planning, apart from bad input."""

from __future__ import annotations

from rosa_core import RosaError


class PlannerFailedError(RosaError):
    """The planner crashed, ran out of time, or answered with what is no plan: it is not known whether there is one."""
