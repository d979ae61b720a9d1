"""Growth as it is defined: a model with some elements more or less is a new model, checked as a whole."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields, replace

from rosa_core import KnowledgeModel, KnowledgeModelError
from rosa_core.errors import Problem, nearest
from rosa_core.model.changes import KIND_OF, Element, Elements, describe, elements_of, ref, references
from rosa_core.model.elements import ElementRef


def with_elements(model: KnowledgeModel, added: Iterable[Element]) -> KnowledgeModel:
    """The model with some elements more, declared after those that it has; it refuses what does not hold together."""
    more = Elements.of(added)
    return replace(
        model, **{field.name: getattr(model, field.name) + getattr(more, field.name) for field in fields(more)}
    )


def without_elements(model: KnowledgeModel, wanted: Iterable[Element | ElementRef]) -> KnowledgeModel:
    """The model without some of its elements, refused if there are none such, or others refer to them."""
    removed = _find(model, wanted)
    left = [element for element in elements_of(model) if element not in removed]
    missing = {ref(element) for element in removed if type(element) in KIND_OF}  # type: ignore[arg-type]
    referring: dict[ElementRef, list[str]] = {}
    for element in left:
        for target in references(element):
            if target in missing:
                referring.setdefault(target, []).append(describe(element))
    if referring:
        raise KnowledgeModelError(
            [
                Problem(
                    f"{target} is still referred to by {', '.join(by)}",
                    hint="remove that too, in the same call or before",
                )
                for target, by in referring.items()
            ]
        )
    sections = Elements.of(left)
    return replace(model, **{field.name: getattr(sections, field.name) for field in fields(sections)})


def _find(model: KnowledgeModel, wanted: Iterable[Element | ElementRef]) -> set[Element]:
    named = {ref(element): element for element in elements_of(model) if type(element) in KIND_OF}  # type: ignore[arg-type]
    found: set[Element] = set()
    problems: list[Problem] = []
    for item in wanted:
        if isinstance(item, ElementRef) or type(item) in KIND_OF:
            key = item if isinstance(item, ElementRef) else ref(item)  # type: ignore[arg-type]
            if key in named:
                found.add(named[key])
            else:
                problems.append(Problem(f"there is no {key}", hint=nearest(key.name, model.names.get(key.kind, ()))))
        elif item in {*model.requirements, *model.constraints, *model.estimations}:
            found.add(item)
        else:
            problems.append(Problem(f"the model has no {describe(item)}", hint="give it exactly as the model has it"))
    if problems:
        raise KnowledgeModelError(problems)
    return found
