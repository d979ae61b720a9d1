"""Whatever is written, the incremental reasoner says what a full recompute of everything would say."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings

from rosa_core import KnowledgeBase, KnowledgeBaseError, KnowledgeModel, SimulationClock, Situation, Status
from rosa_core.kb import Event, StatusesChanged
from rosa_core.model import ElementKind
from tests.rosa_core.inference.naive import Facts, NaiveKnowledgeBase
from tests.rosa_core.inference.random_knowledge import (
    NOW,
    AbortedError,
    Write,
    models,
    scenarios,
    single_writes,
    write_to_kb,
)
from tests.rosa_core.sample_models import KINDS, heard, snapshot

thorough = settings(
    max_examples=120, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


def write_to_oracle(oracle: NaiveKnowledgeBase, write: Write) -> type[Exception] | None:
    """The same for the oracle."""
    if write.what == "transaction":
        before = oracle.save()
        for part in write.parts:
            write_to_oracle(oracle, part)
        if write.rolled_back:
            oracle.facts = before
            return AbortedError
        return None
    arguments = (*write.arguments, NOW) if write.what == "suppose" else write.arguments
    try:
        getattr(oracle, write.what)(*arguments)
    except KnowledgeBaseError as error:
        return type(error)
    return None


def assert_same_answers(kb: KnowledgeBase, oracle: NaiveKnowledgeBase) -> None:
    assert {kind: kb.statuses(kind) for kind in KINDS} == oracle.statuses()
    assert [status for _, status in kb.constraints()] == oracle.constraints()
    assert kb.selectable_actions() == oracle.selectable_actions()
    assert kb.adaptable_functions() == oracle.adaptable_functions()
    assert kb.adaptable_components() == oracle.adaptable_components()
    half_of_designs = kb.model.names[ElementKind.FUNCTION_DESIGN][::2]
    assert kb.adaptable_components(half_of_designs) == oracle.adaptable_components(half_of_designs)
    assert_same_facts(kb, oracle.facts)


def assert_same_facts(kb: KnowledgeBase, facts: Facts) -> None:
    model = kb.model
    assert [required.action for required in kb.required_actions()] == facts.required
    assert {c.name for c in model.components if kb.is_component_active(c.name)} == facts.active
    for function in model.functions:
        own = [d.name for d in model.function_designs if d.function == function.name and d.name in facts.designs]
        assert kb.selected_function_design(function.name) == next(iter(own), None)
    plan = kb.pending_reconfiguration_plan()
    assert (plan and (plan.activate, plan.deactivate, plan.parameter_adaptations)) == facts.pending


def status_differences(before: dict[str, dict[str, Status]], after: dict[str, dict[str, Status]]) -> dict:
    return {
        (kind, name): (before[kind][name], after[kind][name])
        for kind in KINDS
        for name in before[kind]
        if before[kind][name] is not after[kind][name]
    }


def announced_differences(events: list[Event]) -> dict:
    return {
        (change.kind.value, change.name): (change.old, change.new)
        for event in events
        if isinstance(event, StatusesChanged)
        for change in event.changes
        if change.kind is not ElementKind.CONSTRAINT
    }


@thorough
@given(models())
def test_before_anything_is_written_all_answers_are_those_of_the_oracle(model: KnowledgeModel) -> None:
    assert_same_answers(KnowledgeBase(model, SimulationClock(NOW)), NaiveKnowledgeBase(model))


@thorough
@given(scenarios())
def test_after_every_write_all_answers_are_those_of_the_oracle(scenario: tuple[KnowledgeModel, list[Write]]) -> None:
    model, written = scenario
    kb, oracle = KnowledgeBase(model, SimulationClock(NOW)), NaiveKnowledgeBase(model)
    for write in written:
        assert write_to_kb(kb, write) == write_to_oracle(oracle, write)
        assert_same_answers(kb, oracle)


@thorough
@given(scenarios())
def test_the_announced_status_changes_are_what_has_changed_in_the_oracle(
    scenario: tuple[KnowledgeModel, list[Write]],
) -> None:
    model, written = scenario
    kb, oracle = KnowledgeBase(model, SimulationClock(NOW)), NaiveKnowledgeBase(model)
    events = heard(kb)
    for write in written:
        before = oracle.statuses()
        events.clear()
        write_to_kb(kb, write)
        write_to_oracle(oracle, write)
        assert announced_differences(events) == status_differences(before, oracle.statuses())


@thorough
@given(scenarios())
def test_a_write_that_is_refused_changes_nothing(scenario: tuple[KnowledgeModel, list[Write]]) -> None:
    model, written = scenario
    kb = KnowledgeBase(model, SimulationClock(NOW))
    events = heard(kb)
    for write in written:
        before, heard_before = snapshot(kb), len(events)
        if write_to_kb(kb, write) is not None:
            assert snapshot(kb) == before
            assert len(events) == heard_before


def without_plan_ids(seen: object) -> object:
    """Plans of two knowledge bases can be the same work under different numbers."""
    if isinstance(seen, dict):
        return {key: without_plan_ids(value) for key, value in seen.items()}
    if isinstance(seen, list | tuple):
        return [without_plan_ids(value) for value in seen]
    if hasattr(seen, "parameter_adaptations"):
        return (seen.start_time, seen.activate, seen.deactivate, seen.parameter_adaptations)
    if hasattr(seen, "plan"):
        return (without_plan_ids(seen.plan), seen.end_time, seen.result)
    return seen


@thorough
@given(scenarios())
def test_after_a_rolled_back_transaction_all_goes_on_as_if_it_had_never_been(
    scenario: tuple[KnowledgeModel, list[Write]],
) -> None:
    model, written = scenario
    with_it, without_it = (KnowledgeBase(model, SimulationClock(NOW)) for _ in range(2))
    for write in written:
        write_to_kb(with_it, write)
        if not write.rolled_back:
            write_to_kb(without_it, write)
        assert without_plan_ids(snapshot(with_it)) == without_plan_ids(snapshot(without_it))


REFUSED = [
    ("add_measurement", ("height", 1.0)),
    ("add_measurement", ("light", float("nan"))),
    ("add_measurement", ("light", 1.0, float("inf"))),
    ("set_component_failure", ("wings",)),
    ("set_component_failure", ("camera", float("nan"))),
    ("clear_component_failure", ("wings",)),
    ("request_action", ("swim",)),
    ("request_action", ("hover", "height")),
    ("request_action", ("deliver",)),
    ("cancel_action", ("swim",)),
    ("finish_action", ("swim",)),
    ("finish_action", ("hover", "done")),
    ("set_component_active", ("wings", True)),
    ("select_configuration", (["fly fast", "see by sonar"], [])),
    ("select_configuration", (["fly fast"], ["blurred"])),
    ("select_configuration", (["fly fast", "fly gently"], [])),
    ("select_configuration", ([], ["sharp", "grainy"])),
    ("suppose", (Situation(failed_components=("rotors",), measurements={"light": float("nan")}),)),
    ("suppose", (Situation(selected_designs=("fly fast",), active_components=("wings",)),)),
]


@pytest.mark.parametrize(("method", "arguments"), REFUSED)
def test_a_refused_write_of_each_kind_changes_nothing(kb: KnowledgeBase, method: str, arguments: tuple) -> None:
    kb.request_action("hover")
    kb.select_configuration(["fly gently", "see by camera"], ["sharp"])
    kb.add_measurement("battery", 0.1)
    before, events = snapshot(kb), heard(kb)

    with pytest.raises(KnowledgeBaseError):
        getattr(kb, method)(*arguments)

    assert snapshot(kb) == before
    assert events == []


@thorough
@given(models().flatmap(lambda model: single_writes(model).map(lambda write: (model, write))))
def test_a_transaction_of_one_write_is_the_same_as_the_write(given_write: tuple[KnowledgeModel, Write]) -> None:
    model, write = given_write
    alone, wrapped = (KnowledgeBase(model, SimulationClock(NOW)) for _ in range(2))
    write_to_kb(alone, write)
    write_to_kb(wrapped, Write("transaction", (), (write,)))
    assert snapshot(alone) == snapshot(wrapped)
