"""What is never selected and what flaps: held to what the real planner selects, in every situation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from hypothesis import given, settings

from rosa_core import ElementKind, KnowledgeBase, KnowledgeBaseError, KnowledgeModel, SimulationClock, Situation
from rosa_core.mape import AdaptationLoop
from rosa_core.model.elements import Action, FunctionalRequirement
from rosa_verification.choices import Choices
from rosa_verification.cut_sets import CutSets
from rosa_verification.structure import Structure
from tests.rosa_core.inference.random_knowledge import models
from tests.rosa_core.sample_models import PretendedRobot, knowledge_model
from tests.rosa_verification.situations import situations_of, values_of
from tests.rosa_verification.test_cut_sets import NO_CHECKS, assume_small


def choices_of(model: KnowledgeModel) -> Choices:
    structure = Structure(model)
    return Choices(structure, CutSets(structure))


def with_an_action_for_each_function(model: KnowledgeModel) -> tuple[KnowledgeModel, list[str]]:
    """A model whose functions can be required one by one, by actions that nothing constrains."""
    functions = sorted({f for requirement in model.requirements for f in requirement.functions})
    actions = [f"only {function}" for function in functions]
    requirements = tuple(FunctionalRequirement(a, (f,)) for a, f in zip(actions, functions, strict=True))
    more = replace(
        model,
        actions=(*model.actions, *map(Action, actions)),
        requirements=(*model.requirements, *requirements),
    )
    return more, actions


def selected(kb: KnowledgeBase) -> Iterator[tuple[ElementKind, str]]:
    for function in kb.model.names[ElementKind.FUNCTION]:
        if (design := kb.selected_function_design(function)) is not None:
            yield ElementKind.FUNCTION_DESIGN, design
    for component in kb.model.names[ElementKind.COMPONENT]:
        if (configuration := kb.selected_component_configuration(component)) is not None:
            yield ElementKind.COMPONENT_CONFIGURATION, configuration


@pytest.mark.slow
@settings(max_examples=25, deadline=None, suppress_health_check=NO_CHECKS)
@given(models())
def test_what_is_never_selected_is_what_the_planner_selects_in_no_situation(model: KnowledgeModel) -> None:
    assume_small(model)
    tried, actions = with_an_action_for_each_function(model)
    ever: set[tuple[ElementKind, str]] = set()
    for situation in situations_of(model):
        kb = KnowledgeBase(tried, clock=SimulationClock())
        kb.suppose(situation)
        with AdaptationLoop(kb, PretendedRobot()):
            for action in actions:
                if kb.is_action_feasible(action):
                    kb.request_action(action)
                    ever.update(selected(kb))
                    kb.cancel_action(action)
    never = {(one.element.kind, one.element.name) for one in choices_of(model).never_selected()}
    kinds = (ElementKind.FUNCTION_DESIGN, ElementKind.COMPONENT_CONFIGURATION)
    assert {one for one in never if one[0] in kinds} == {(k, n) for k in kinds for n in model.names[k]} - ever


@pytest.mark.slow
@settings(max_examples=25, deadline=None, suppress_health_check=NO_CHECKS)
@given(models())
def test_what_flaps_is_what_the_planner_changes_for_ever_between_neighbouring_values(model: KnowledgeModel) -> None:
    assume_small(model)
    tried, actions = with_an_action_for_each_function(model)
    changing: set[tuple[str, str, frozenset[str]]] = set()
    for situation in situations_of(model):
        for measure, values in values_of(model).items():
            value = situation.measurements.get(measure)
            if value is None or value == values[-1]:
                continue
            for action in actions:
                changing |= changes(tried, situation, measure, values[values.index(value) + 1], action)
    found = {(one.measure, one.element.name, frozenset((one.low, one.high))) for one in choices_of(model).flapping()}
    assert found == changing


def changes(
    model: KnowledgeModel, situation: Situation, measure: str, other: float, action: str
) -> set[tuple[str, str, frozenset[str]]]:
    """What changes each time that a measure goes back and forth between its value and another."""
    kb = KnowledgeBase(model, clock=SimulationClock())
    kb.suppose(situation)
    value = situation.measurements[measure]
    try:
        kb.request_action(action)
    except KnowledgeBaseError:
        return set()
    with AdaptationLoop(kb, PretendedRobot()):
        kb.replan()
        for now in (other, value, other, value):
            kb.add_measurement(measure, now)
        if not kb.is_action_feasible(action):
            return set()
        before = {**_designs(kb), **_configurations(kb)}
        kb.add_measurement(measure, other)
        if not kb.is_action_feasible(action):
            return set()
        after = {**_designs(kb), **_configurations(kb)}
    changed = {name for name in before.keys() & after.keys() if before[name] != after[name]}
    if any(name.startswith("f") for name in changed):
        # Another design configures its components anew: that is the design's flapping, not another one.
        changed = {name for name in changed if name.startswith("f")}
    return {(measure, name, frozenset((before[name], after[name]))) for name in changed}


def _designs(kb: KnowledgeBase) -> dict[str, str]:
    found = {name: kb.selected_function_design(name) for name in kb.model.names[ElementKind.FUNCTION]}
    return {name: design for name, design in found.items() if design is not None}


def _configurations(kb: KnowledgeBase) -> dict[str, str]:
    found = {name: kb.selected_component_configuration(name) for name in kb.model.names[ElementKind.COMPONENT]}
    return {name: configuration for name, configuration in found.items() if configuration is not None}


IMPROVED = """
measures: {light: {}}
actions: {drive: {requires: [see]}}
functions: {see: {always_improve: true}}
components: {camera: {}}
function_designs: {by camera: {function: see, components: [camera]}}
component_configurations:
  sharp: {component: camera, priority: 1, constraints: [{measure: light, value: 1}]}
  plain: {component: camera, priority: 2}
"""


@pytest.mark.parametrize(("text", "flaps"), [(IMPROVED, True), (IMPROVED.replace("true", "false"), False)])
def test_a_function_that_always_improves_configures_its_components_anew(text: str, flaps: bool) -> None:
    model = knowledge_model(text)
    changing = {("light", "camera", frozenset(("sharp", "plain")))} if flaps else set()
    found = {(one.measure, one.element.name, frozenset((one.low, one.high))) for one in choices_of(model).flapping()}
    assert found == changing
    assert changes(model, Situation({"light": 0.0}), "light", 1.0, "drive") == changing
