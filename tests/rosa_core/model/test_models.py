"""Models as plain data: what refers to what, what does not hold together, and one canonical text each."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeModel, KnowledgeModelError
from rosa_core.model import (
    Action,
    ElementRef,
    Elements,
    Function,
    FunctionalRequirement,
    Measure,
)
from rosa_core.model.canonical import fingerprint, model_from_text, model_to_text
from rosa_core.model.changes import NamedElement, difference, elements_of, ref, referring_to
from tests.rosa_core.inference.random_knowledge import models


@given(models(), st.data())
@settings(max_examples=50, deadline=None)
def test_elements_are_sorted_by_kind_and_keep_their_order(model: KnowledgeModel, data: st.DataObject) -> None:
    kinds = list(dict.fromkeys(map(type, elements_of(model))))
    shuffled = data.draw(st.permutations(list(elements_of(model))))
    assert list(Elements.of(shuffled)) == sorted(shuffled, key=lambda element: kinds.index(type(element)))


@given(models(), st.data())
@settings(max_examples=50, deadline=None)
def test_what_refers_to_an_element_is_what_has_its_name_in_a_field(model: KnowledgeModel, data: st.DataObject) -> None:
    element = data.draw(st.sampled_from([e for e in elements_of(model) if isinstance(e, NamedElement)]))
    mentions = [
        other
        for other in elements_of(model)
        for field in fields(other)
        if field.name != "name"
        and _mentions(type(element).__name__, element.name, getattr(other, field.name), field.name)
    ]
    assert list(referring_to(model, ref(element))) == list(dict.fromkeys(mentions))


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
