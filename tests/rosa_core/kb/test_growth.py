"""Knowledge that grows and shrinks while the robot runs."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import (
    KnowledgeBase,
    KnowledgeBaseError,
    KnowledgeChangeRefusedError,
    KnowledgeModelError,
    Result,
    SimulationClock,
    Status,
    UnknownElementError,
)
from rosa_core.kb import ConfigurationSelected, Event, KnowledgeChanged, ReconfigurationPlanEnded, StatusesChanged
from rosa_core.kb.growth import _key
from rosa_core.kb.restoring import apply
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import Transaction
from rosa_core.mape import AdaptationLoop, ConfigurationPlanner
from rosa_core.model.changes import referring_to
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from tests.rosa_core.journal.writes import STATUS_KINDS, WRITES, Write, picture, robot

ACTION, COMPONENT, DESIGN = ElementKind.ACTION, ElementKind.COMPONENT, ElementKind.FUNCTION_DESIGN


class ObedientSystem:
    """A managed system in which everything works."""

    def activate(self, component: str) -> None:
        pass

    def deactivate(self, component: str) -> None:
        pass

    def set_parameters(self, component: str, parameters: object) -> None:
        pass


@pytest.fixture
def kb() -> KnowledgeBase:
    return KnowledgeBase(robot(), SimulationClock())


def heard(kb: KnowledgeBase, *types: type[Event]) -> list[Any]:
    events: list[Any] = []
    kb.subscribe(events.append, types or None)
    return events


# -- adding --


def test_what_is_added_can_be_used_at_once(kb: KnowledgeBase) -> None:
    model = kb.model
    kb.add_measurement("battery", 0.9)
    events = heard(kb)
    kb.add_elements(
        Component("propeller"),
        Function("fly"),
        FunctionDesign("hover", "fly", ("motor", "propeller")),
        Action("take off"),
        FunctionalRequirement("take off", ("fly",)),
        Constraint("battery", ElementRef(ACTION, "take off"), value=0.95),
    )
    assert kb.status("action", "take off") is Status.UNFEASIBLE  # by a measurement from before
    assert [type(event) for event in events] == [KnowledgeChanged]
    assert Action("take off") in events[0].added
    kb.add_measurement("battery", 1.0)
    kb.request_action("take off")
    plan = ConfigurationPlanner(kb).plan()
    assert plan is not None
    assert plan.activate == ("motor", "propeller")
    assert kb.model is not model
    assert model == robot()


def test_statuses_of_what_was_there_follow(kb: KnowledgeBase) -> None:
    kb.set_component_failure("camera")
    assert kb.status("action", "explore") is Status.UNFEASIBLE
    changes = heard(kb, StatusesChanged)
    kb.add_elements(Component("lidar"), FunctionDesign("scan", "see", ("lidar",)))
    assert kb.status("action", "explore") is Status.FEASIBLE
    assert [(c.name, c.old, c.new) for c in changes[0].changes] == [
        ("see", Status.UNFEASIBLE, Status.FEASIBLE),
        ("explore", Status.UNFEASIBLE, Status.FEASIBLE),
    ]
    assert kb.history("statuses", "explore")[-1].change.new is Status.FEASIBLE  # type: ignore[union-attr]


def test_run_time_facts_of_everything_else_stay(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.9, 3.0)
    kb.set_component_failure("camera", 2.0)
    kb.request_action("charge")
    plan = ConfigurationPlanner(kb).plan()
    assert plan is not None
    kb.set_component_active("motor", True)
    before = picture(kb)
    kb.add_elements(Measure("humidity"))
    after = picture(kb)
    for what in ("facts", "required", "pending", "designs", "configurations", "active", "explanations", "statuses"):
        assert after[what] == before[what]
    assert kb.set_reconfiguration_result(plan, Result.COMPLETED)


def test_an_added_design_is_taken_up_by_the_adaptation_loop() -> None:
    kb = KnowledgeBase(robot(), SimulationClock())
    with AdaptationLoop(kb, ObedientSystem()):
        kb.set_component_failure("motor")
        kb.set_component_failure("camera")
        kb.add_elements(Action("survey"), FunctionalRequirement("survey", ("see",)))
        kb.add_elements(Component("lidar"), FunctionDesign("scan", "see", ("lidar",)))
        kb.request_action("survey")
        assert kb.selected_function_design("see") == "scan"
        kb.remove_elements(ElementRef(DESIGN, "scan"))
        assert kb.status("action", "survey") is Status.UNFEASIBLE
        kb.add_elements(Component("radar"), FunctionDesign("sweep", "see", ("radar",)))
        assert kb.selected_function_design("see") == "sweep"
        assert not kb.is_component_active("lidar") or kb.status("component", "lidar") is Status.FEASIBLE
        assert kb.status("action", "survey") is Status.SOLVED


@pytest.mark.parametrize(
    ("elements", "message"),
    [
        ([FunctionDesign("crawl", "mvoe", ("motor",))], r"unknown function 'mvoe' \(did you mean 'move'\?\)"),
        ([Component("motor")], "component 'motor' is declared twice"),
        ([FunctionDesign("crawl", "move", ())], "has no components"),
        ([Constraint("battery", ElementRef(ElementKind.FUNCTION, "move"), value=1.0)], "cannot be: only on"),
        ([Constraint("battery", ElementRef(ACTION, "wait"), value=float("nan"))], "has the value nan"),
        (["motor"], "is not an element of a model"),
        ([ElementRef(ACTION, "wait")], "is not an element of a model"),
    ],
)
def test_what_a_file_may_not_say_cannot_be_added(kb: KnowledgeBase, elements: list[Any], message: str) -> None:
    before = picture(kb)
    with pytest.raises(KnowledgeChangeRefusedError, match=message) as refused:
        kb.add_elements(*elements)
    assert isinstance(refused.value, KnowledgeBaseError)
    assert isinstance(refused.value, KnowledgeModelError)
    assert picture(kb) == before


def test_every_flaw_is_named(kb: KnowledgeBase) -> None:
    with pytest.raises(KnowledgeChangeRefusedError) as refused:
        kb.add_elements(FunctionDesign("a", "x", ("motor",)), FunctionDesign("b", "move", ("y",)))
    assert len(refused.value.problems) == 2


def test_nothing_is_no_change(kb: KnowledgeBase) -> None:
    events = heard(kb)
    kb.add_elements()
    kb.remove_elements()
    assert kb.revision == 0
    assert not events


# -- removing --


def test_what_is_referred_to_cannot_be_removed(kb: KnowledgeBase) -> None:
    before = picture(kb)
    message = (
        "component 'wheels' is still referred to by function design 'drive', "
        "component configuration 'fast', component configuration 'slow'"
    )
    with pytest.raises(KnowledgeChangeRefusedError, match=message):
        kb.remove_elements(Component("wheels"))
    with pytest.raises(KnowledgeChangeRefusedError, match=r"constraint battery >= 0\.25 on action 'explore'"):
        kb.remove_elements(ElementRef(ACTION, "explore"))
    assert picture(kb) == before


def test_it_can_be_removed_together_with_what_refers_to_it(kb: KnowledgeBase) -> None:
    camera = ElementRef(COMPONENT, "camera")
    events = heard(kb, KnowledgeChanged)
    kb.remove_elements(camera, *referring_to(kb.model, camera))
    assert kb.status("function", "see") is Status.UNFEASIBLE
    assert {type(element) for element in events[0].removed} == {Component, FunctionDesign, Constraint}
    with pytest.raises(UnknownElementError, match="there is no component 'camera'"):
        kb.set_component_failure("camera")


def test_what_is_not_there_cannot_be_removed(kb: KnowledgeBase) -> None:
    with pytest.raises(KnowledgeChangeRefusedError, match=r"there is no component 'whels' \(did you mean 'wheels'\?\)"):
        kb.remove_elements(ElementRef(COMPONENT, "whels"))
    with pytest.raises(KnowledgeChangeRefusedError, match="the model has no constraint light >= 7 on action 'wait'"):
        kb.remove_elements(Constraint("light", ElementRef(ACTION, "wait"), value=7.0))
    with pytest.raises(KnowledgeChangeRefusedError, match="the model has no estimation"):
        kb.remove_elements(Estimation(ElementRef(COMPONENT, "motor"), "light", 1.0))


def test_a_removed_constraint_no_longer_counts(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.1)
    assert not kb.is_action_feasible("explore")
    kb.remove_elements(*(c for c in kb.model.constraints if c.constrained.name == "explore"))
    assert kb.is_action_feasible("explore")


def test_a_required_action_cannot_be_removed(kb: KnowledgeBase) -> None:
    kb.add_elements(Action("rest"))
    kb.request_action("rest", preference="tick")
    with pytest.raises(
        KnowledgeChangeRefusedError, match=r"action 'rest' is required now \(cancel or finish it first\)"
    ):
        kb.remove_elements(Action("rest"))
    with pytest.raises(KnowledgeChangeRefusedError, match="decides on the configuration of the required action 'rest'"):
        kb.remove_elements(Measure("tick"))
    kb.cancel_action("rest")
    kb.remove_elements(Action("rest"), Measure("tick"))


def test_an_active_component_cannot_be_removed(kb: KnowledgeBase) -> None:
    kb.add_elements(Component("lamp"))
    kb.set_component_active("lamp", True)
    with pytest.raises(KnowledgeChangeRefusedError, match=r"component 'lamp' is active \(deactivate it first\)"):
        kb.remove_elements(Component("lamp"))
    kb.set_component_active("lamp", False)
    kb.remove_elements(Component("lamp"))


def test_removing_a_selected_design_unselects_it_and_abandons_the_plan_for_it(kb: KnowledgeBase) -> None:
    kb.request_action("charge")
    plan = ConfigurationPlanner(kb).plan()
    assert plan is not None
    assert kb.selected_function_design("move") == "drive"
    events = heard(kb)
    kb.remove_elements(
        ElementRef(DESIGN, "drive"),
        *(c for c in kb.model.component_configurations if c.component == "wheels"),
        *(c for c in kb.model.constraints if c.constrained.name == "fast"),
        *(e for e in kb.model.estimations if e.causer.name in ("fast", "slow")),
    )
    kinds = [type(event) for event in events]
    assert kinds == [KnowledgeChanged, ConfigurationSelected, StatusesChanged, ReconfigurationPlanEnded]
    assert events[1].unselected_function_designs == ("drive",)
    assert (events[3].plan, events[3].result) == (plan, Result.ABANDONED)
    assert kb.status("function", "move") is Status.UNSOLVED
    ConfigurationPlanner(kb).plan()
    assert kb.selected_function_design("move") == "walk"


# -- transactions --


def test_a_change_within_a_transaction_is_one_with_the_rest(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        kb.add_measurement("battery", 0.1)
        kb.add_elements(Component("lidar"), FunctionDesign("scan", "see", ("lidar",)))
        kb.set_component_failure("camera")
        assert kb.status("function_design", "scan") is Status.FEASIBLE
        assert not events
    assert len({event.revision for event in events}) == 1
    names = [change.name for change in events[-1].changes]
    assert names == sorted(set(names), key=names.index)


def test_a_transaction_that_breaks_off_takes_the_change_back(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.9)
    kb.request_action("charge")
    ConfigurationPlanner(kb).plan()
    before, model = picture(kb), kb.model

    def break_off() -> None:
        with kb.transaction():
            kb.add_measurement("battery", 0.1)
            kb.add_elements(Component("lidar"), FunctionDesign("scan", "see", ("lidar",)))
            kb.set_component_failure("lidar")
            kb.set_component_active("motor", True)
            kb.remove_elements(
                ElementRef(DESIGN, "walk"), *(c for c in kb.model.constraints if c.constrained.name == "walk")
            )
            kb.add_measurement("light", 0.5)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        break_off()
    assert picture(kb) == before
    assert kb.model is model
    kb.add_measurement("battery", 0.1)
    assert not kb.is_action_feasible("explore")


def test_a_removal_taken_back_within_a_transaction_does_not_hide_what_changed_before_it(kb: KnowledgeBase) -> None:
    explore = ElementRef(ACTION, "explore")
    events = heard(kb, StatusesChanged)
    with kb.transaction():
        kb.add_measurement("battery", 0.1)
        with suppress(ZeroDivisionError), kb.transaction():
            kb.remove_elements(explore, *referring_to(kb.model, explore))
            raise ZeroDivisionError
    assert (ACTION, "explore", Status.FEASIBLE, Status.UNFEASIBLE) in events[0].changes


def test_an_element_is_changed_by_removing_and_adding_it_in_one_transaction(kb: KnowledgeBase) -> None:
    kb.request_action("charge")
    ConfigurationPlanner(kb).plan()
    events = heard(kb)
    old = next(d for d in kb.model.function_designs if d.name == "drive")
    new = replace(old, priority=9.0)
    with kb.transaction():
        kb.remove_elements(old)
        kb.add_elements(new)
    assert (events[0].added, events[0].removed) == ((new,), (old,))
    changed = {c.name: (c.old, c.new) for event in events if isinstance(event, StatusesChanged) for c in event.changes}
    assert changed["drive"] == (Status.UNSOLVED, Status.FEASIBLE)  # net, over its absence
    ConfigurationPlanner(kb).plan()
    assert kb.selected_function_design("move") == "walk"


def test_what_is_added_and_removed_in_one_transaction_is_not_heard_of(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        kb.add_elements(Measure("humidity"))
        kb.remove_elements(Measure("humidity"))
    assert not events
    assert kb.model == robot()


@given(st.lists(st.builds(Write, st.integers(0, len(WRITES) - 1), st.integers(0, 49), st.integers(0, 49)), max_size=40))
@settings(max_examples=80, deadline=None)
def test_after_any_writes_statuses_and_events_are_those_of_the_model_and_the_facts(writes: list[Write]) -> None:
    kb = KnowledgeBase(robot(), SimulationClock())
    known = {kind: dict(kb.statuses(kind)) for kind in STATUS_KINDS}

    def follow(event: Event) -> None:
        """Know the statuses from events alone, asking only for those of new elements."""
        if isinstance(event, KnowledgeChanged):
            for kind in STATUS_KINDS:
                now = kb.statuses(kind)
                known[kind] = {name: known[kind].get(name, status) for name, status in now.items()}
        elif isinstance(event, StatusesChanged):
            for change in event.changes:
                if change.kind in known:
                    known[change.kind][change.name] = change.new

    kb.subscribe(follow)
    for write in writes:
        write(kb)
        assert known == {kind: kb.statuses(kind) for kind in STATUS_KINDS}
        afresh = RuntimeState(kb.model, kb.clock)
        for fact in kb._state.facts():
            apply(afresh, Transaction(), fact)
        afresh.reasoner.infer()
        assert {_key(n): n.status for n in afresh.reasoner.nodes()} == {
            _key(n): n.status for n in kb._state.reasoner.nodes()
        }
        assert list(afresh.facts()) == list(kb._state.facts())


# -- with a journal --


def test_a_journal_restores_the_grown_model(tmp_path: Path) -> None:
    path = tmp_path / "kb"
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        kb.add_elements(Component("lidar"), FunctionDesign("scan", "see", ("lidar",), 0.5))
        kb.add_elements(ComponentConfiguration("near", "lidar"))
        slow = ElementRef(ElementKind.COMPONENT_CONFIGURATION, "slow")
        kb.remove_elements(slow, *referring_to(kb.model, slow))
        kb.set_component_failure("lidar", 1.0)
        before = picture(kb)
    # It is opened with the model that it began with: what came later is in it.
    for _ in range(2):
        with KnowledgeBase(robot(), SimulationClock(), path) as kb:
            assert picture(kb) == before
            kb.add_elements(Measure("m"))
            kb.remove_elements(Measure("m"))
            before = picture(kb)
