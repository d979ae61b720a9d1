"""What the tests of plans need."""

from __future__ import annotations

import pytest

from task_layer.pddl import GroundTask, parse_task
from tests.task_layer.pddl.kit import SUAVE_DOMAIN, suave_problem


@pytest.fixture(scope="session")
def suave_task() -> GroundTask:
    """The extended SUAVE mission as its files have it."""
    return parse_task(SUAVE_DOMAIN, suave_problem())
