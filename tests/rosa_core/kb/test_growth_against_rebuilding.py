"""However a knowledge base has grown and shrunk, it is as if it had been made of its model and facts just now."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, KnowledgeBaseError, KnowledgeModel, KnowledgeModelError, SimulationClock
from rosa_core.errors import Problem
from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    ConstraintNode,
    DesignNode,
    FunctionNode,
    MeasureNode,
    Node,
)
from rosa_core.inference.reasoner import Reasoner
from rosa_core.kb.reconfiguration import declared_order
from rosa_core.kb.restoring import apply
from rosa_core.kb.transaction import Transaction
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.changes import KIND_OF, Element, elements_of, ref, referring_to
from rosa_core.model.elements import (
    CONSTRAINABLE,
    ESTIMABLE,
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from tests.rosa_core.inference.random_knowledge import (
    LIMITS,
    NOW,
    AbortedError,
    Write,
    models,
    single_writes,
    write_to_kb,
)
from tests.rosa_core.kb.whole_model import with_elements, without_elements
from tests.rosa_core.sample_models import KINDS, snapshot


@dataclass(frozen=True)
class Growth:
    """Elements are added, or removed: these, and those at some places of the model, with all that refers to them."""

    added: tuple[Element, ...] = ()
    removed: tuple[Element | ElementRef, ...] = ()
    places: tuple[int, ...] = ()

    def __call__(self, kb: KnowledgeBase) -> None:
        """Do it; whether it is refused, and for which reasons, is as if the whole model were checked."""
        elements = list(elements_of(kb.model))
        removed = [*self.removed, *(elements[place % len(elements)] for place in self.places if elements)]
        if self.places:
            for element in removed:  # it grows meanwhile
                if type(element) in KIND_OF:
                    removed += [e for e in referring_to(kb.model, ref(element)) if e not in removed]  # type: ignore[arg-type]
        model, expected, refused = kb.model, NO_PROBLEMS, NO_PROBLEMS
        try:
            model = with_elements(model, self.added) if self.added else without_elements(model, removed)
        except KnowledgeModelError as error:
            expected = frozenset(error.problems)
        try:
            kb.add_elements(*self.added) if self.added else kb.remove_elements(*removed)
        except KnowledgeModelError as error:
            refused = frozenset(error.problems)
        assert refused == expected or (not self.added and refused and all(map(_is_in_use, refused)))
        assert kb.model == (model if not refused else kb.model)


NO_PROBLEMS: frozenset[Problem] = frozenset()


def _is_in_use(problem: Problem) -> bool:
    return any(word in problem.what for word in ("is required now", "is active", "decides on"))


@st.composite
def scenarios(draw: Callable[..., Any]) -> tuple[KnowledgeModel, list[Any]]:
    """A model, and writes and growth in any order, alone or in transactions of which some break off."""
    model = draw(models())
    few = st.lists(_elements(model), min_size=1, max_size=4).map(tuple)
    adding = st.builds(Growth, few)
    removing = st.builds(Growth, places=st.lists(st.integers(0, 99), min_size=1, max_size=2).map(tuple))
    refused = st.builds(Growth, removed=few)
    step = adding | removing | removing | refused | single_writes(model) | single_writes(model) | st.just("plan")
    requests = [Write("request_action", (action,)) for action in model.names[ElementKind.ACTION]]
    transaction = st.tuples(st.lists(step | removing, min_size=1, max_size=5), st.booleans())
    return model, [*requests, "plan", *draw(st.lists(step | transaction, min_size=2, max_size=12))]


def _elements(model: KnowledgeModel) -> st.SearchStrategy[Element]:
    """Elements that may be new, be there already, or name what is not there."""
    new = ("new0", "new1")

    def name(kind: ElementKind) -> st.SearchStrategy[str]:
        return st.sampled_from((*model.names[kind], *new))

    def refs(kinds: frozenset[ElementKind]) -> st.SearchStrategy[ElementRef]:
        return st.sampled_from(sorted(kinds)).flatmap(lambda kind: name(kind).map(lambda n: ElementRef(kind, n)))

    def several(kind: ElementKind) -> st.SearchStrategy[tuple[str, ...]]:
        return st.lists(name(kind), min_size=1, max_size=2, unique=True).map(tuple)

    measure, component, function = name(ElementKind.MEASURE), name(ElementKind.COMPONENT), name(ElementKind.FUNCTION)
    design = name(ElementKind.FUNCTION_DESIGN)
    fresh, priority = st.sampled_from(new), st.none() | st.sampled_from((1.0, 2.0))
    return st.one_of(
        st.builds(Measure, fresh),
        st.builds(Action, fresh),
        st.builds(Function, fresh, st.booleans()),
        st.builds(Component, fresh, always_improve=st.booleans()),
        st.builds(FunctionalRequirement, name(ElementKind.ACTION), several(ElementKind.FUNCTION)),
        st.builds(FunctionDesign, fresh, function, several(ElementKind.COMPONENT), priority),
        st.builds(FunctionDesign, design, function, several(ElementKind.COMPONENT), priority),
        st.builds(ComponentConfiguration, name(ElementKind.COMPONENT_CONFIGURATION), component, st.just(()), priority),
        st.builds(Constraint, measure, refs(CONSTRAINABLE), value=st.sampled_from((*LIMITS, None))),
        st.builds(Estimation, refs(ESTIMABLE), measure, st.sampled_from((1.0, 2.0)), st.sampled_from(EstimationType)),
    )


def do(kb: KnowledgeBase, step: Any) -> None:
    """One step, be it a transaction."""
    if isinstance(step, tuple):
        parts, breaks_off = step
        with suppress(AbortedError), kb.transaction():
            for part in parts:
                do(kb, part)
            if breaks_off:
                raise AbortedError
    elif isinstance(step, Write):
        write_to_kb(kb, step)
    elif step == "plan":
        ConfigurationPlanner(kb).plan()
    else:
        step(kb)


def anew(kb: KnowledgeBase) -> KnowledgeBase:
    """The same made from nothing: of the model as a whole, and its facts."""
    other = KnowledgeBase(with_elements(KnowledgeModel(), elements_of(kb.model)), SimulationClock(NOW))
    for fact in kb._state.facts():
        apply(other._state, Transaction(), fact)
    other._state.reasoner.infer()
    other._state.reasoner.changes.clear()
    return other


def _named(nodes: Any) -> list[Any]:
    return [getattr(node, "name", None) or node.element for node in nodes]


def structure(reasoner: Reasoner) -> dict[str, Any]:
    """Everything that a reasoner holds, in its order."""
    network = reasoner.network
    kinds: tuple[tuple[type, tuple[str, ...]], ...] = (
        (Node, ("status", "constraints", "dirty")),
        (ConstraintNode, ("constraint",)),
        (ConfigurationNode, ("element", "selected", "applied")),
        (
            ComponentNode,
            ("element", "active", "failed_since", "required_by", "configurations", "selected_configurations"),
        ),
        (DesignNode, ("element", "selected", "components")),
        (FunctionNode, ("element", "required_by", "designs", "selected_designs")),
        (ActionNode, ("element", "required", "functions")),
        (MeasureNode, ("element", "value", "time", "limits", "references")),
    )
    lists = ("options", "members", "requirements")
    found: dict[str, Any] = {"model": network.elements()}
    for node in (*network.measures.values(), *reasoner.nodes()):
        about: dict[str, Any] = {a: getattr(node, a) for kind, names in kinds if isinstance(node, kind) for a in names}
        about |= {name: _named(getattr(node, name)) for name in lists if hasattr(node, name)}
        if isinstance(node, ComponentNode):
            about["designs"] = _named(node.designs)
        if isinstance(node, MeasureNode):
            about["constraints"] = sorted(map(str, _named(node.constraints)))
        else:
            about["constraints on"] = _named(network.constraints_on.get(node, ()))
            about["estimations"] = _named(network.estimations_of.get(node, ()))
            about["counted by"] = sorted((d.kind, d.name) for d, _ in node.dependents)
        found[f"{node.kind} {node.name}"] = about
    for name in ("required_actions", "selected_designs", "selected_configurations", "active_components"):
        found[name] = _named(declared_order(getattr(reasoner, name)))
    for name in ("adaptable_functions", "adaptable_components"):
        found[name] = _named(declared_order(getattr(reasoner, name)))
    return found


thorough = settings(
    max_examples=100, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


@thorough
@given(scenarios())
def test_after_any_growth_all_is_as_if_made_of_the_final_model(scenario: tuple[KnowledgeModel, list[Any]]) -> None:
    model, steps = scenario
    kb = KnowledgeBase(model, SimulationClock(NOW))
    for step in steps:
        before, inside = (snapshot(kb), structure(kb._state.reasoner)), kb.model
        do(kb, step)
        if isinstance(step, tuple) and step[1]:
            assert (snapshot(kb), structure(kb._state.reasoner)) == before
            assert kb.model is inside
        assert structure(kb._state.reasoner) == structure(anew(kb)._state.reasoner)


@thorough
@given(scenarios())
def test_after_any_growth_answers_and_choices_are_those_of_the_final_model(
    scenario: tuple[KnowledgeModel, list[Any]],
) -> None:
    model, steps = scenario
    kb = KnowledgeBase(model, SimulationClock(NOW))
    for step in steps:
        do(kb, step)
    other = anew(kb)
    for _ in range(2):
        seen, expected = snapshot(kb), snapshot(other)
        for remembered in ("history", "revision"):
            del seen[remembered], expected[remembered]
        assert seen == expected
        for kb_ in (kb, other):
            with suppress(KnowledgeBaseError):
                for action in kb_.selectable_actions():
                    kb_.request_action(action)
            ConfigurationPlanner(kb_).plan()
    assert {kind: kb.statuses(kind) for kind in KINDS} == {kind: other.statuses(kind) for kind in KINDS}
