"""Elements of a model that nothing in it uses: most likely a name was misspelt, or a relation forgotten."""

from __future__ import annotations

from collections.abc import Iterator

from rosa_core.model.elements import ElementKind, ElementRef
from rosa_core.model.knowledge_model import KnowledgeModel


def unused_elements(model: KnowledgeModel) -> Iterator[ElementRef]:
    """The measures that no constraint or estimation is about, and the components and configurations of no design.

    A component of no function design is never started, and its configurations are never chosen.

    >>> from rosa_core.model import Component, Measure
    >>> model = KnowledgeModel((Measure("light"),), components=(Component("arm"),))
    >>> [str(element) for element in unused_elements(model)]
    ["measure 'light'", "component 'arm'"]

    Args:
        model: a whole model; of one that extends another only the two together.

    Yields:
        each element, in the order of the kinds and of declaration.
    """
    measured = {constraint.measure for constraint in model.constraints} | {e.measure for e in model.estimations}
    needed = {component for design in model.function_designs for component in design.components}
    yield from (ElementRef(ElementKind.MEASURE, m.name) for m in model.measures if m.name not in measured)
    yield from (ElementRef(ElementKind.COMPONENT, c.name) for c in model.components if c.name not in needed)
    for configuration in model.component_configurations:
        if configuration.component not in needed:
            yield ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration.name)
