"""Every status can say why: which rule, from which facts, down to the measurement and its time."""

from __future__ import annotations

import pytest
from hypothesis import given, settings

from rosa_core import (
    InvalidValueError,
    KnowledgeBase,
    KnowledgeModel,
    SimulationClock,
    Situation,
    Status,
    UnknownElementError,
)
from rosa_core.inference.rules import is_selectable
from rosa_core.kb import Explanation
from rosa_core.model import ElementKind
from tests.rosa_core.inference.random_knowledge import NOW, Write, scenarios, write_to_kb
from tests.rosa_core.sample_models import DRONE, KINDS, knowledge_model

RUNNING = Situation(
    required_actions=("deliver",),
    selected_designs=("fly fast", "see by camera"),
    selected_configurations=("sharp",),
    active_components=("rotors", "autopilot", "camera"),
)
DARK = "light 10 (measured at 3.0 s) violates >= 50"
PITCH_DARK = [DARK.replace("10", "1"), "light 1 (measured at 3.0 s) violates >= 5"]


def chain(explanation: Explanation) -> list[str]:
    """The first branch from an explanation down to its ground, one line each."""
    line = f"{explanation.name}, {explanation.status}: {explanation.reason}"
    if explanation.kind is ElementKind.CONSTRAINT:
        line = explanation.reason
    return [line, *(chain(explanation.because[0]) if explanation.because else [])]


def grounds(explanation: Explanation) -> list[str]:
    """The reasons at the ends of all branches."""
    if not explanation.because:
        return [explanation.reason]
    return [ground for cause in explanation.because for ground in grounds(cause)]


def test_a_violated_constraint_is_followed_up_to_the_action(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.125, time=3)
    assert chain(kb.explain("action", "deliver")) == [
        "deliver, unfeasible: a constraint on it is violated",
        "battery 0.125 (measured at 3.0 s) violates >= 0.25",
    ]


def test_a_failure_is_followed_up_to_the_action(kb: KnowledgeBase) -> None:
    kb.set_component_failure("rotors", time=4.5)
    explanation = kb.explain("action", "hover")
    assert chain(explanation) == [
        "hover, unfeasible: a function of it is unfeasible",
        "fly, unfeasible: all its designs are unfeasible",
        "fly fast, unfeasible: a component of it cannot be used",
        "rotors, failure: a failure was reported at 4.5 s",
    ]
    assert explanation.summary == "hover is unfeasible: rotors: a failure was reported at 4.5 s"


def test_configurations_that_are_all_unfeasible_are_followed_up_to_the_design(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 1, time=3)
    explanation = kb.explain("function_design", "see by camera")
    assert chain(explanation)[:3] == [
        "see by camera, unfeasible: a component of it cannot be used",
        "camera, unfeasible: all its configurations are unfeasible",
        "sharp, unfeasible: a constraint on it is violated",
    ]
    assert grounds(explanation) == PITCH_DARK


def test_a_violated_constraint_on_a_component_is_its_reason() -> None:
    model = knowledge_model(
        """
        measures: {heat: }
        components: {motor: {constraints: [{measure: heat, operator: "<=", value: 80}]}}
        """
    )
    kb = KnowledgeBase(model)
    kb.add_measurement("heat", 81, time=7)
    assert chain(kb.explain("component", "motor")) == [
        "motor, unfeasible: a constraint on it is violated",
        "heat 81 (measured at 7.0 s) violates <= 80",
    ]


def test_a_violated_constraint_on_a_design_is_its_reason(kb: KnowledgeBase) -> None:
    kb.add_measurement("wind", 8, time=1)
    assert chain(kb.explain("function_design", "fly fast")) == [
        "fly fast, unfeasible: a constraint on it is violated",
        "wind 8 (measured at 1.0 s) violates < 8",
    ]


def test_a_wrongly_configured_component_is_followed_up_to_the_action(kb: KnowledgeBase) -> None:
    kb.suppose(RUNNING)
    kb.add_measurement("light", 10, time=3)
    assert chain(kb.explain("action", "deliver")) == [
        "deliver, implicit configuration error: a function of it is wrongly configured",
        "see, implicit configuration error: its selected design is in error",
        "see by camera, implicit configuration error: a component of it is wrongly configured",
        "camera, configuration error: its selected configuration is unfeasible",
        "sharp, unfeasible: a constraint on it is violated",
        DARK,
    ]


def test_an_unfeasible_selected_design_is_followed_up_to_the_action(kb: KnowledgeBase) -> None:
    kb.suppose(RUNNING)
    kb.set_component_failure("camera", time=2)
    assert chain(kb.explain("action", "deliver")) == [
        "deliver, implicit configuration error: a function of it is wrongly configured",
        "see, configuration error: its selected design is unfeasible",
        "see by camera, unfeasible: a component of it cannot be used",
        "camera, failure: a failure was reported at 2.0 s",
    ]


def test_a_component_that_does_not_run_is_followed_up_to_the_action(kb: KnowledgeBase) -> None:
    kb.suppose(RUNNING)
    kb.set_component_active("autopilot", False)
    assert chain(kb.explain("action", "deliver")) == [
        "deliver, unsolved: it is required, and a function of it is not solved yet",
        "fly, unsolved: its selected design is not solved yet",
        "fly fast, unsolved: it is selected, and a component of it is not ready",
        "autopilot, unsolved: it is required and not active",
    ]


def test_a_component_without_selected_configuration_says_so(kb: KnowledgeBase) -> None:
    kb.suppose(Situation(selected_designs=("see by camera",), active_components=("camera",)))
    assert chain(kb.explain("component", "camera")) == ["camera, unsolved: no configuration is selected"]


def test_a_function_without_selected_design_says_so(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    assert chain(kb.explain("function", "fly")) == ["fly, unsolved: no design is selected"]


def test_a_function_without_designs_says_so() -> None:
    kb = KnowledgeBase(knowledge_model("{actions: {swim: {requires: [float]}}, functions: {float: }}"))
    assert chain(kb.explain("action", "swim")) == [
        "swim, unfeasible: a function of it is unfeasible",
        "float, unfeasible: no design solves it",
    ]


def test_what_is_solved_is_explained_by_what_solves_it(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 70, time=3)
    kb.suppose(RUNNING)
    assert chain(kb.explain("function", "see")) == [
        "see, solved: its selected design is solved",
        "see by camera, solved: it is selected, and all its components are solved",
        "camera, solved: it is required and active",
        "sharp, feasible: no constraint on it is violated",
        "light 70 (measured at 3.0 s) satisfies >= 50",
    ]
    assert kb.explain("action", "deliver").reason == "it is required, and all its functions are solved"


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_feasible_has_a_reason_too(kb: KnowledgeBase, kind: str) -> None:
    for name in kb.statuses(kind):
        explanation = kb.explain(kind, name)
        assert (explanation.kind, explanation.name, explanation.status) == (kind, name, Status.FEASIBLE)
        assert len(explanation.reason) > 10


def test_a_constraint_that_is_not_evaluated_says_what_is_missing(kb: KnowledgeBase) -> None:
    assert grounds(kb.explain("action", "deliver")) == ["battery has not been measured, so >= 0.25 is not evaluated"]
    model = knowledge_model("{measures: {heat: }, actions: {cook: {constraints: [{measure: heat}]}}}")
    kb = KnowledgeBase(model)
    kb.add_measurement("heat", 1)
    assert grounds(kb.explain("action", "cook")) == ["the constraint on heat has no value, so it is not evaluated"]


def test_an_explanation_follows_the_latest_measurement(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.125, time=3)
    kb.add_measurement("battery", 0.125, time=9)
    assert grounds(kb.explain("action", "deliver")) == ["battery 0.125 (measured at 9.0 s) violates >= 0.25"]


@pytest.mark.parametrize("value", [0.2499999999, 0.25 - 2**-54])
def test_a_value_just_beyond_the_limit_does_not_read_as_the_limit(kb: KnowledgeBase, value: float) -> None:
    kb.add_measurement("battery", value, time=3)
    (ground,) = grounds(kb.explain("action", "deliver"))
    assert float(ground.split()[1]) < 0.25


def test_an_explanation_prints_as_a_tree(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 1, time=3)
    assert str(kb.explain("component", "camera")).splitlines() == [
        "component 'camera' is unfeasible: all its configurations are unfeasible",
        "├─ component configuration 'sharp' is unfeasible: a constraint on it is violated",
        f"│  └─ {PITCH_DARK[0]}",
        "└─ component configuration 'grainy' is unfeasible: a constraint on it is violated",
        f"   └─ {PITCH_DARK[1]}",
    ]


def test_a_summary_names_the_first_three_facts_once_and_counts_the_rest(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.125, time=3)
    kb.add_measurement("light", 1, time=3)
    for component in ("lidar", "rotors"):
        kb.set_component_failure(component, time=1)
    assert kb.explain("action", "deliver").summary == (
        "deliver is unfeasible: battery 0.125 (measured at 3.0 s) violates >= 0.25; "
        "rotors: a failure was reported at 1.0 s; light 1 (measured at 3.0 s) violates >= 50; and 2 more"
    )


def test_a_measure_has_no_status_to_explain(kb: KnowledgeBase) -> None:
    with pytest.raises(InvalidValueError):
        kb.explain("measure", "light")


@settings(max_examples=100, deadline=None)
@given(scenarios())
def test_what_cannot_be_used_is_always_explained_by_raw_facts(scenario: tuple[KnowledgeModel, list[Write]]) -> None:
    model, written = scenario
    kb = KnowledgeBase(model, SimulationClock(NOW))
    for write in written:
        write_to_kb(kb, write)
    for kind in KINDS:
        for name, status in kb.statuses(kind).items():
            explanation = kb.explain(kind, name)
            assert explanation.status is status
            if not is_selectable(status):
                for ground in grounds(explanation):
                    assert "violates" in ground or "a failure was reported" in ground or ground == "no design solves it"


def test_why_is_the_summary_of_the_explanation() -> None:
    kb = KnowledgeBase(knowledge_model(DRONE), clock=SimulationClock())
    kb.add_measurement("battery", 0.2, time=3.0)
    assert kb.why("action", "deliver") == kb.explain("action", "deliver").summary
    with pytest.raises(UnknownElementError):
        kb.why("action", "dance")
