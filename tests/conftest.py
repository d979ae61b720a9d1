"""What several test files need."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock

MODELS = Path(str(files("suave.models")))
SUAVE = MODELS / "suave.yaml"
SUAVE_EXTENDED = MODELS / "suave_extended.yaml"


@pytest.fixture(scope="session")
def extended_model() -> KnowledgeModel:
    """The model of the extended SUAVE mission."""
    return KnowledgeModel.load(SUAVE, SUAVE_EXTENDED)


@pytest.fixture
def clock() -> SimulationClock:
    """Simulated time, from 0."""
    return SimulationClock()


@pytest.fixture
def kb(extended_model: KnowledgeModel, clock: SimulationClock) -> KnowledgeBase:
    """A knowledge base of the extended SUAVE mission, on simulated time; a subscriber that raises fails the test."""

    def fail(error: BaseException, _subscriber: object, _event: object) -> None:
        raise error

    return KnowledgeBase(extended_model, clock=clock, on_subscriber_error=fail)
