"""A whole knowledge model: all elements of a robot, read-only, known to hold together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Any

from rosa_core.errors import KnowledgeModelError, Problem
from rosa_core.model.elements import (
    Action,
    Annotation,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)

if TYPE_CHECKING:
    import networkx as nx


@dataclass(frozen=True, slots=True)
class Flaw:
    """Something wrong within a model, at a path such as ``("action", "fly", "requires", "float")``."""

    path: tuple[str, ...]
    what: str
    hint: str | None = None


class FlawedModelError(KnowledgeModelError):
    """A model whose elements do not hold together; a loader knows in which file and line each ``flaw`` stands."""

    def __init__(self, flaws: list[Flaw]) -> None:
        self.flaws = tuple(flaws)
        super().__init__([Problem(flaw.what, hint=flaw.hint) for flaw in flaws])


@dataclass(frozen=True)
class KnowledgeModel:
    """What a robot can do, with what, and under which constraints (ROSA paper, section 5.1, tables 2 and 3).

    Elements keep their order of declaration, which breaks ties of priority. Load one from files with :meth:`load`,
    or build it from elements. ``annotations`` are remarks of the files; models that differ only in them are equal.

    Raises:
        KnowledgeModelError: if names dangle or are double, or an element does not hold together; lists every flaw.
    """

    measures: tuple[Measure, ...] = ()
    actions: tuple[Action, ...] = ()
    functions: tuple[Function, ...] = ()
    components: tuple[Component, ...] = ()
    requirements: tuple[FunctionalRequirement, ...] = ()
    function_designs: tuple[FunctionDesign, ...] = ()
    component_configurations: tuple[ComponentConfiguration, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    estimations: tuple[Estimation, ...] = ()
    annotations: tuple[Annotation, ...] = field(default=(), compare=False)

    def __post_init__(self) -> None:
        from rosa_core.model.validation import find_flaws

        if flaws := find_flaws(self):
            raise FlawedModelError(flaws)

    @classmethod
    def of_checked(cls, sections: Mapping[str, tuple[Any, ...]]) -> KnowledgeModel:
        """A model of elements that are known to hold together, made without checking them once more.

        Args:
            sections: the value of every field, by its name.
        """
        model = object.__new__(cls)
        for name, elements in sections.items():
            object.__setattr__(model, name, elements)
        return model

    @classmethod
    def load(cls, *paths: str | PathLike[str]) -> KnowledgeModel:
        """Read a model from YAML (``.yaml``, ``.yml``) and TypeQL (``.tql``) files; later files extend earlier ones.

        Raises:
            KnowledgeModelError: with file, line and hint for everything that is wrong.
        """
        from rosa_core.formats.loader import load_model

        return load_model(paths)

    @cached_property
    def names(self) -> dict[ElementKind, tuple[str, ...]]:
        """The names of each kind of element, in order of declaration (constraints have none)."""
        return {
            ElementKind.MEASURE: tuple(e.name for e in self.measures),
            ElementKind.ACTION: tuple(e.name for e in self.actions),
            ElementKind.FUNCTION: tuple(e.name for e in self.functions),
            ElementKind.COMPONENT: tuple(e.name for e in self.components),
            ElementKind.FUNCTION_DESIGN: tuple(e.name for e in self.function_designs),
            ElementKind.COMPONENT_CONFIGURATION: tuple(e.name for e in self.component_configurations),
        }

    def graph(self) -> nx.DiGraph[ElementRef]:
        """The dependency graph: an edge from what is depended on to what depends on it.

        Nodes are :class:`ElementRef`; a constraint is the node ``ElementRef(CONSTRAINT, "measure op value on X")``.
        For analysis and drawing; the reasoner has a form of its own.
        """
        import networkx as nx

        graph: nx.DiGraph[ElementRef] = nx.DiGraph()
        for kind, names in self.names.items():
            graph.add_nodes_from(ElementRef(kind, name) for name in names)
        for requirement in self.requirements:
            action = ElementRef(ElementKind.ACTION, requirement.action)
            for function in requirement.functions:
                graph.add_edge(ElementRef(ElementKind.FUNCTION, function), action)
        for design in self.function_designs:
            ref = ElementRef(ElementKind.FUNCTION_DESIGN, design.name)
            graph.add_edge(ref, ElementRef(ElementKind.FUNCTION, design.function))
            for component in design.components:
                graph.add_edge(ElementRef(ElementKind.COMPONENT, component), ref)
        for configuration in self.component_configurations:
            ref = ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration.name)
            graph.add_edge(ref, ElementRef(ElementKind.COMPONENT, configuration.component))
        for constraint in self.constraints:
            ref = ElementRef(ElementKind.CONSTRAINT, f"{constraint} on {constraint.constrained}")
            graph.add_edge(ElementRef(ElementKind.MEASURE, constraint.measure), ref)
            graph.add_edge(ref, constraint.constrained)
        return graph
