"""What if: questions within ``kb.supposing(situation)`` are answered as if it were so, and nothing of it stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, Situation, Status, UnknownElementError
from rosa_core.kb import Event
from rosa_core.mape import ConfigurationPlanner


@pytest.fixture
def kb(extended_model: KnowledgeModel) -> KnowledgeBase:
    return KnowledgeBase(extended_model)


def test_inside_it_is_so_and_afterwards_it_never_was(kb: KnowledgeBase) -> None:
    heard: list[Event] = []
    kb.subscribe(heard.append)
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    before = kb.revision
    with kb.supposing(Situation({"battery_level": 0.1}, failed_components=("c_thruster_1",))):
        assert not kb.is_action_feasible("search_pipeline")
        assert kb.status("component", "c_thruster_1") is Status.FAILURE
        assert "recharge" in kb.selectable_actions()
    assert kb.is_action_feasible("search_pipeline")
    assert kb.measurement("battery_level") is None
    assert kb.revision == before
    assert heard == []
    assert kb.history("measurements") == ()


def test_what_is_known_already_holds_inside_as_well_and_comes_back(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery_level", 0.1)
    kb.set_component_failure("c_thruster_1")
    with kb.supposing(Situation({"battery_level": 0.9})):
        assert kb.is_action_feasible("search_pipeline")
        assert kb.status("component", "c_thruster_1") is Status.FAILURE
    assert not kb.is_action_feasible("search_pipeline")


def test_one_may_suppose_within_a_supposition_and_within_a_transaction(kb: KnowledgeBase) -> None:
    with kb.transaction():
        kb.add_measurement("battery_level", 0.8)
        with kb.supposing(Situation({"battery_level": 0.1})):
            with kb.supposing(Situation({"battery_level": 0.7})):
                assert kb.is_action_feasible("search_pipeline")
            assert not kb.is_action_feasible("search_pipeline")
        assert kb.is_action_feasible("search_pipeline")
    measured = kb.measurement("battery_level")
    assert measured is not None
    assert measured.value == 0.8


def test_what_the_block_writes_is_taken_back_too(kb: KnowledgeBase) -> None:
    with kb.supposing(Situation()):
        kb.request_action("search_pipeline")
        assert kb.required_actions() != []
    assert kb.required_actions() == []


def test_an_error_inside_comes_out_and_nothing_stays(kb: KnowledgeBase) -> None:
    with pytest.raises(ZeroDivisionError), kb.supposing(Situation({"battery_level": 0.1})):
        raise ZeroDivisionError
    with pytest.raises(UnknownElementError), kb.supposing(Situation({"batery": 0.1})):
        pass
    assert kb.measurement("battery_level") is None
    assert kb.is_action_feasible("search_pipeline")


def test_a_journal_holds_nothing_of_it(tmp_path: Path, extended_model: KnowledgeModel) -> None:
    journal = tmp_path / "kb.journal"
    with KnowledgeBase(extended_model, journal=journal) as kb, kb.supposing(Situation({"battery_level": 0.1})):
        assert not kb.is_action_feasible("search_pipeline")
    with KnowledgeBase(extended_model, journal=journal) as again:
        assert again.measurement("battery_level") is None
