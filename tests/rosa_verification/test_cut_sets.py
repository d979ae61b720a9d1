"""Minimal cut sets and path sets: all of them, and only they, whatever the model."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, assume, given, settings

from rosa_core import ElementKind, KnowledgeModel
from rosa_core.model.elements import Constraint, ConstraintOperator, ElementRef
from rosa_verification.causes import Region, cause_text
from rosa_verification.cut_sets import CutSets, PathSets
from rosa_verification.structure import Structure
from tests.rosa_core.inference.random_knowledge import models
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_verification.situations import all_regions, candidates, least, tried, values_of

NO_CHECKS = [HealthCheck.too_slow, HealthCheck.filter_too_much]


def assume_small(model: KnowledgeModel) -> None:
    situations = 2 ** len(model.components)
    for values in values_of(model).values():
        situations *= len(values) + 1
    assume(situations <= 700)


def texts(sets: tuple[tuple[str | Region, ...], ...]) -> list[str]:
    return [", ".join(map(cause_text, one)) for one in sets]


def action(name: str) -> ElementRef:
    return ElementRef(ElementKind.ACTION, name)


@settings(max_examples=40, deadline=None, suppress_health_check=NO_CHECKS)
@given(models())
def test_the_cut_sets_are_those_found_by_trying_every_situation(model: KnowledgeModel) -> None:
    assume_small(model)
    oracle = tried(model)
    cutting: dict[ElementRef, list[frozenset[str | Region]]] = {element: [] for element in oracle.unfeasible}
    masks: dict[str | Region, int] = {c: oracle.failed(c) for c in model.names[ElementKind.COMPONENT]}
    regions = all_regions(model)
    masks.update({region: oracle.within(region) for several in regions.values() for region in several})
    for causes in candidates(model, 3, regions):
        mask = oracle.everything
        for cause in causes:
            mask &= masks[cause]
        for element, unfeasible in oracle.unfeasible.items():
            if not mask & ~unfeasible:
                cutting[element].append(causes)
    cut_sets = CutSets(Structure(model))
    for element, sets in cutting.items():
        found = cut_sets.of(element)
        assert found.order == 3
        assert set(map(frozenset, found.sets)) == least(sets), element


@settings(max_examples=40, deadline=None, suppress_health_check=NO_CHECKS)
@given(models())
def test_the_path_sets_are_those_found_by_trying_every_situation(model: KnowledgeModel) -> None:
    assume_small(model)
    oracle = tried(model, unmeasured=False)
    making: dict[ElementRef, list[frozenset[str | Region]]] = {element: [] for element in oracle.unfeasible}
    components = model.names[ElementKind.COMPONENT]
    masks: dict[str | Region, int] = {c: oracle.everything & ~oracle.failed(c) for c in components}
    regions = {
        measure: [region for region in several if not region.is_whole]
        for measure, several in all_regions(model).items()
    }
    masks.update({region: oracle.within(region) for several in regions.values() for region in several})
    for causes in candidates(model, len(components) + len(regions), regions):
        if any(isinstance(cause, str) for cause in causes) and len(causes) > 4:
            continue  # too many to try: that the path sets together are all that is possible is checked below
        mask = oracle.everything
        for cause in causes:
            mask &= masks[cause]
        for element, unfeasible in oracle.unfeasible.items():
            if not mask & unfeasible:
                making[element].append(causes)
    path_sets = PathSets(Structure(model))
    for element, sets in making.items():
        found = path_sets.of(element)
        assert found is not None
        assert {frozenset(one) for one in found if len(one) <= 4} == least(sets), element
        possible = 0
        for one in found:
            mask = oracle.everything
            for cause in one:
                mask &= masks[cause]
            possible |= mask
        assert possible == oracle.everything & ~oracle.unfeasible[element], element


MODEL = """
measures: {light: {}}
actions: {drive: {requires: [see]}}
functions: {see: {}}
components: {camera: {}, lamp: {}, lidar: {}}
function_designs:
  by day: {function: see, components: [camera], constraints: [{measure: light, operator: ">", value: 0.5}]}
  by night: {function: see, components: [camera, lamp], constraints: [{measure: light, operator: "<=", value: 0.5}]}
  by lidar: {function: see, components: [lidar]}
"""


def test_regions_that_only_together_hold_every_value_are_one_cause() -> None:
    cut_sets = CutSets(Structure(knowledge_model(MODEL)))
    assert texts(cut_sets.of(action("drive")).sets) == [
        "camera failed, lidar failed",
        "lamp failed, lidar failed, light <= 0.5",
    ]


def test_a_measure_cannot_be_in_two_regions_at_once() -> None:
    model = knowledge_model(
        MODEL.replace(", lidar: {}}", "}").replace("  by lidar: {function: see, components: [lidar]}\n", "")
    )
    assert texts(CutSets(Structure(model)).of(action("drive")).sets) == ["camera failed", "lamp failed, light <= 0.5"]


def test_what_is_never_feasible_is_cut_by_nothing_and_what_always_is_by_no_set() -> None:
    model = knowledge_model("actions: {fly: {requires: [lift]}, wait: {}}\nfunctions: {lift: {}}\n")
    cut_sets, path_sets = CutSets(Structure(model)), PathSets(Structure(model))
    assert (cut_sets.of(action("fly")).sets, path_sets.of(action("fly"))) == (((),), ())
    assert (cut_sets.of(action("wait")).sets, path_sets.of(action("wait"))) == ((), ((),))


def test_of_more_sets_than_the_limit_only_those_of_lower_order_are_listed() -> None:
    names = [f"c{n}" for n in range(10)]
    parts = ", ".join(names)
    model = knowledge_model(
        f"actions: {{a: {{requires: [f, g]}}}}\nfunctions: {{f: {{}}, g: {{}}}}\n"
        f"components: {{{', '.join(f'{n}: {{}}' for n in (*names, 'x', 'y', 'z'))}}}\n"
        "function_designs:\n"
        f"  one: {{function: f, components: [{parts}]}}\n"
        "  two: {function: f, components: [x, y]}\n"
        "  three: {function: g, components: [z]}\n"
    )
    found = CutSets(Structure(model), limit=15).of(action("a"))
    assert (texts(found.sets), found.order) == (["z failed"], 1)
    assert len(CutSets(Structure(model), limit=21).of(action("a")).sets) == 21


@pytest.mark.parametrize("operator", ConstraintOperator)
@pytest.mark.parametrize("limit", [0.0, 1e308, -1e308, 5e-324])
def test_a_region_holds_what_violates_the_constraint(operator: ConstraintOperator, limit: float) -> None:
    from rosa_core import KnowledgeBase, Status
    from rosa_core.model.elements import Action, Measure
    from rosa_verification.structure import violated_region

    constraint = Constraint("m", action("a"), operator, limit)
    region = violated_region(constraint)
    assert region is not None
    model = KnowledgeModel(measures=(Measure("m"),), actions=(Action("a"),), constraints=(constraint,))
    kb = KnowledgeBase(model)
    kb.add_measurement("m", region.some_value())
    assert kb.status(ElementKind.ACTION, "a") is Status.UNFEASIBLE
    kb.add_measurement("m", limit)
    assert (kb.status(ElementKind.ACTION, "a") is Status.UNFEASIBLE) == region.contains(
        Region("m", (limit, 0), (limit, 1))
    )
