"""Synthetic knowledge models of a given size, for measuring."""

from __future__ import annotations

from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_core.model.knowledge_model import KnowledgeModel

_ELEMENTS_PER_ACTION = 20


def many_small_robots(elements: int) -> KnowledgeModel:
    """About ``elements`` elements in groups that do not touch: a change in one has a small cone.

    Each group: an action, two functions with two designs each, four components with two configurations each, a
    measure, and two constraints on configurations of the first component.
    """
    parts: dict[str, list[object]] = {
        name: []
        for name in (
            "measures",
            "actions",
            "functions",
            "components",
            "requirements",
            "function_designs",
            "component_configurations",
            "constraints",
        )
    }
    for i in range(max(1, elements // _ELEMENTS_PER_ACTION)):
        parts["measures"].append(Measure(f"m{i}"))
        parts["actions"].append(Action(f"a{i}"))
        functions = [f"f{i}.{n}" for n in range(2)]
        parts["functions"] += [Function(name, always_improve=True) for name in functions]
        parts["requirements"].append(FunctionalRequirement(f"a{i}", tuple(functions)))
        for n in range(4):
            parts["components"].append(Component(f"c{i}.{n}"))
            parts["function_designs"].append(FunctionDesign(f"d{i}.{n}", functions[n // 2], (f"c{i}.{n}",), n % 2))
            for k in range(2):
                parts["component_configurations"].append(ComponentConfiguration(f"k{i}.{n}.{k}", f"c{i}.{n}", (), k))
        for k in range(2):
            ref = ElementRef(ElementKind.COMPONENT_CONFIGURATION, f"k{i}.0.{k}")
            parts["constraints"].append(Constraint(f"m{i}", ref, ConstraintOperator.GREATER_OR_EQUAL, 1.0 + k))
    return KnowledgeModel(**{name: tuple(items) for name, items in parts.items()})  # type: ignore[arg-type]


def one_measure_for_all(configurations: int) -> KnowledgeModel:
    """One measure constrains this many configurations, each of a component in a design of a function of an action."""
    count = range(configurations)
    return KnowledgeModel(
        measures=(Measure("m"),),
        actions=tuple(Action(f"a{i}") for i in count),
        functions=tuple(Function(f"f{i}") for i in count),
        components=tuple(Component(f"c{i}") for i in count),
        requirements=tuple(FunctionalRequirement(f"a{i}", (f"f{i}",)) for i in count),
        function_designs=tuple(FunctionDesign(f"d{i}", f"f{i}", (f"c{i}",)) for i in count),
        component_configurations=tuple(ComponentConfiguration(f"k{i}", f"c{i}") for i in count),
        constraints=tuple(
            Constraint("m", ElementRef(ElementKind.COMPONENT_CONFIGURATION, f"k{i}"), value=1.0) for i in count
        ),
    )
