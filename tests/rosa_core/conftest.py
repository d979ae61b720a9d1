"""What the tests of rosa_core share."""

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from tests.rosa_core.sample_models import DRONE, PretendedRobot, knowledge_model


@pytest.fixture
def drone() -> KnowledgeModel:
    return knowledge_model(DRONE)


@pytest.fixture
def kb(drone: KnowledgeModel, clock: SimulationClock) -> KnowledgeBase:
    """The drone's knowledge, at time 0; an error in a subscriber fails the test."""

    def fail(error: BaseException, *_: object) -> None:
        raise error

    return KnowledgeBase(drone, clock, on_subscriber_error=fail)


@pytest.fixture
def robot() -> PretendedRobot:
    return PretendedRobot()
