"""Models as plain data: they grow and shrink into new models, and have one canonical text each."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeModel, KnowledgeModelError
from rosa_core.model import (
    Action,
    Component,
    Constraint,
    ElementKind,
    ElementRef,
    Elements,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
    count_effort,
)
from rosa_core.model.canonical import fingerprint, model_from_text, model_to_text
from rosa_core.model.changes import difference, elements_of, find_elements, with_elements, without_elements
from tests.rosa_core.inference.random_knowledge import models

TORCH = Elements.of(
    [
        Component("torch"),
        Function("light"),
        FunctionDesign("by torch", "light", ("torch",)),
        Action("shine"),
        FunctionalRequirement("shine", ("light",)),
        Measure("darkness"),
        Constraint("darkness", ElementRef(ElementKind.ACTION, "shine"), value=0.5),
    ]
)


@given(models())
@settings(max_examples=50, deadline=None)
def test_what_is_added_and_removed_again_leaves_the_same_model(model: KnowledgeModel) -> None:
    grown = with_elements(model, TORCH)
    assert count_effort(grown).total == count_effort(model).total + len(list(TORCH))
    assert without_elements(grown, TORCH) == model


@given(models(), st.data())
@settings(max_examples=50, deadline=None)
def test_an_element_is_removed_exactly_if_no_other_refers_to_it(model: KnowledgeModel, data: st.DataObject) -> None:
    element = data.draw(st.sampled_from(list(elements_of(model))))
    name, kind = getattr(element, "name", None), type(element).__name__
    others = [other for other in elements_of(model) if other is not element]
    mentions = [
        other
        for other in others
        for field in fields(other)
        if name is not None and field.name != "name" and _mentions(kind, name, getattr(other, field.name), field.name)
    ]
    found = find_elements(model, [element])
    if mentions:
        with pytest.raises(KnowledgeModelError, match="still referred to"):
            without_elements(model, found)
    else:
        left = list(elements_of(without_elements(model, found)))
        assert left == [other for other in others if other != element]


FIELDS = {
    "Measure": ("measure",),
    "Action": ("action",),
    "Function": ("function", "functions"),
    "Component": ("component", "components"),
}


def _mentions(kind: str, name: str, value: object, field: str) -> bool:
    """Whether a field of another element names an element: by its own look at the fields, not by the model's."""
    if isinstance(value, ElementRef):
        return value.name == name and value.kind.value.replace("_", "") == kind.lower()
    return field in FIELDS.get(kind, ()) and (value == name or (isinstance(value, tuple) and name in value))


@given(models())
@settings(max_examples=50, deadline=None)
def test_the_canonical_text_gives_the_model_back(model: KnowledgeModel) -> None:
    assert model_from_text(model_to_text(model)) == model


@given(models(), models())
@settings(max_examples=50, deadline=None)
def test_equal_models_and_only_they_have_the_same_fingerprint(one: KnowledgeModel, other: KnowledgeModel) -> None:
    assert fingerprint(one) == fingerprint(replace(one))
    assert (fingerprint(one) == fingerprint(other)) == (one == other)


@pytest.mark.parametrize(
    ("elements", "what"),
    [
        ({"actions": (Action("fly"), Action("fly"))}, "action 'fly' is declared twice"),
        ({"actions": (Action(""),)}, "an action has an empty name"),
        (
            {"requirements": (FunctionalRequirement("fly", ("float",)),), "functions": (Function("float"),)},
            "a functional requirement names the unknown action 'fly' (declare it as an action or name one of those",
        ),
        (
            {"actions": (Action("fly"),), "requirements": (FunctionalRequirement("fly", ("fly",)),)},
            "action 'fly' names the unknown function 'fly' ('fly' is an action, not a function)",
        ),
    ],
)
def test_a_model_that_does_not_hold_together_says_why(elements: dict[str, tuple[object, ...]], what: str) -> None:
    with pytest.raises(KnowledgeModelError) as refusal:
        KnowledgeModel(**elements)  # type: ignore[arg-type]
    assert what in str(refusal.value)


def test_the_difference_of_two_models_is_said_in_words() -> None:
    small = KnowledgeModel(actions=(Action("fly"),))
    large = KnowledgeModel(actions=(Action("fly"), Action("land")), measures=(Measure("height"),))
    words = difference(small, large, ("the first", "the second"))
    assert words == "only the second has measure 'height', action 'land'"
    swapped = replace(large, actions=large.actions[::-1])
    assert difference(large, swapped, ("the first", "the second")) == "they declare the same in another order"
