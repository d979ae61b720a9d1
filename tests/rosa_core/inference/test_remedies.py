"""What would have to change to make an element feasible again."""

from __future__ import annotations

from hypothesis import given, settings

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock, Status
from rosa_core.inference.remedies import AllOf, AnyOf, Impossible, MeasureWithin, Recovery, Remedy, all_of
from rosa_core.inference.rules import is_selectable
from tests.rosa_core.inference.random_knowledge import NOW, Write, scenarios, write_to_kb
from tests.rosa_core.sample_models import KINDS, knowledge_model


def remedies(kb: KnowledgeBase, kind: str, name: str) -> tuple[str, ...]:
    return kb.explain(kind, name).remedies


def test_what_is_feasible_needs_nothing(kb: KnowledgeBase) -> None:
    for kind in KINDS:
        for name in kb.statuses(kind):
            assert remedies(kb, kind, name) == ()


def test_a_violated_constraint_must_be_satisfied(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.24)
    assert remedies(kb, "action", "deliver") == ("battery must be >= 0.25 (is 0.24)",)


def test_a_value_just_beyond_the_limit_does_not_read_as_the_limit(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.2499999999)
    assert remedies(kb, "action", "deliver") == ("battery must be >= 0.25 (is 0.2499999999)",)


def test_a_failed_component_must_recover_and_one_is_enough_where_there_are_several(kb: KnowledgeBase) -> None:
    kb.set_component_failure("camera")
    assert remedies(kb, "component", "camera") == ("component camera must recover",)
    kb.set_component_failure("lidar")
    assert remedies(kb, "function", "see") == ("one of the components camera, lidar must recover",)


def test_of_several_limits_the_easiest_is_enough(kb: KnowledgeBase) -> None:
    """Sharp takes light >= 50, grainy >= 5."""
    kb.add_measurement("light", 1)
    assert remedies(kb, "component", "camera") == ("light must be >= 5 (is 1)",)


def test_everything_that_must_change_is_listed_and_shared_things_once(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.1)
    kb.add_measurement("wind", 9)
    kb.add_measurement("light", 1)
    for component in ("rotors", "camera", "lidar"):
        kb.set_component_failure(component)
    assert remedies(kb, "action", "deliver") == (
        "battery must be >= 0.25 (is 0.1)",
        "component rotors must recover",
        "either light must be >= 5 (is 1) and component camera must recover, or component lidar must recover",
    )


def test_what_is_needed_anyway_settles_a_choice() -> None:
    kb = KnowledgeBase(
        knowledge_model(
            """
            actions: {go: {requires: [move, see]}}
            functions: {move: , see: }
            components: {a: , b: }
            function_designs:
              move: {function: move, components: [a]}
              see by a: {function: see, components: [a]}
              see by b: {function: see, components: [b]}
            """
        )
    )
    kb.set_component_failure("a")
    kb.set_component_failure("b")
    assert remedies(kb, "action", "go") == ("component a must recover",)


def test_a_measure_must_stay_within_the_other_limits_on_the_element() -> None:
    kb = KnowledgeBase(
        knowledge_model(
            """
            measures: {depth: }
            actions:
              dive: {constraints: [{measure: depth, value: 5}, {measure: depth, operator: "<", value: 8}]}
              both: {constraints: [{measure: depth, value: 5}, {measure: depth, operator: "<", value: 5}]}
            """
        )
    )
    kb.add_measurement("depth", 3)
    assert remedies(kb, "action", "dive") == ("depth must be >= 5 and < 8 (is 3)",)
    assert remedies(kb, "action", "both") == ("constraints contradict each other: depth must be >= 5 and < 5 (is 3)",)


def test_a_function_without_a_design_needs_another_model() -> None:
    kb = KnowledgeBase(knowledge_model("actions: {go: {requires: [move]}}\nfunctions: {move: }"))
    assert remedies(kb, "action", "go") == ("no design solves function move: the model needs one",)


def test_many_alternatives_are_counted() -> None:
    designs = "\n".join(f"  by c{n}: {{function: move, components: [c{n}]}}" for n in range(8))
    components = ", ".join(f"c{n}: " for n in range(8))
    model = f"functions: {{move: }}\ncomponents: {{{components}}}\nfunction_designs:\n{designs}"
    kb = KnowledgeBase(knowledge_model(model))
    for number in range(8):
        kb.set_component_failure(f"c{number}")
    (remedy,) = remedies(kb, "function", "move")
    assert remedy.startswith("either component c0 must recover, or component c1 must recover, ")
    assert remedy.endswith(", or one of 3 more")


def first_way(remedy: Remedy) -> list[MeasureWithin | Recovery] | None:
    """The leaves to bring about, taking the first of all alternatives; None where nothing helps."""
    if isinstance(remedy, Impossible):
        return None
    if isinstance(remedy, AnyOf):
        return first_way(remedy.parts[0])
    if isinstance(remedy, AllOf):
        ways = [first_way(part) for part in remedy.parts]
        return None if None in ways else [leaf for way in ways for leaf in way or []]
    return [remedy]


def has_choices(remedy: Remedy) -> bool:
    parts = remedy.parts if isinstance(remedy, AllOf) else ()
    return isinstance(remedy, AnyOf) or any(has_choices(part) for part in parts)


def together(way: list[MeasureWithin | Recovery]) -> list[MeasureWithin | Recovery]:
    """What a choice asks of a measure, and what is certain anyway, as one."""
    merged = all_of(way)
    leaves = merged.parts if isinstance(merged, AllOf) else (merged,)
    return [leaf for leaf in leaves if isinstance(leaf, MeasureWithin | Recovery)]


def bring_about(kb: KnowledgeBase, leaf: MeasureWithin | Recovery) -> None:
    if isinstance(leaf, Recovery):
        kb.clear_component_failure(leaf.component)
        return
    low, high = leaf.least, leaf.most
    if low is not None and high is not None:
        value = (low.value + high.value) / 2
    elif low is not None:
        value = low.value + (0.0 if low.reached else 0.1)
    else:
        assert high is not None
        value = high.value - (0.0 if high.reached else 0.1)
    kb.add_measurement(leaf.measure, value, 99.0)


@settings(max_examples=200, deadline=None)
@given(scenarios())
def test_a_remedy_that_comes_about_makes_the_element_feasible(scenario: tuple[KnowledgeModel, list[Write]]) -> None:
    """Unless it violates a constraint that was satisfied: a measure that one element needs high, another needs low."""
    model, written = scenario
    for kind, names in ((kind, names) for kind, names in model.names.items() if kind in KINDS):
        for name in names:
            kb = KnowledgeBase(model, SimulationClock(NOW))
            for write in written:
                write_to_kb(kb, write)
            explanation = kb.explain(kind, name)
            assert (explanation.remedy is None) == is_selectable(explanation.status)
            way = None if explanation.remedy is None else first_way(explanation.remedy)
            if not way or isinstance(all_of(way), Impossible):  # the first ways of two choices may exclude each other
                continue
            before = {constraint for constraint, status in kb.constraints() if status is Status.VIOLATED}
            if not has_choices(explanation.remedy):
                measures = [leaf.measure for leaf in way if isinstance(leaf, MeasureWithin)]
                assert len(measures) == len(set(measures)), "said once"
            for leaf in together(way):
                bring_about(kb, leaf)
            after = {constraint for constraint, status in kb.constraints() if status is Status.VIOLATED}
            if after <= before:
                assert is_selectable(kb.status(kind, name)), (explanation, explanation.remedies)
