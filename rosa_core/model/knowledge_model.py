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
from rosa_core.model.validation import Flaw, find_flaws
from rosa_core.plugins import Plugin

if TYPE_CHECKING:
    import networkx as nx


# Files are read above the model: what a model is does not depend on how one is written down.
_LOADER = Plugin("rosa_core.formats.loader", "load_model", "loading a model")


class FlawedModelError(KnowledgeModelError):
    """A model whose elements do not hold together; a loader knows in which file and line each ``flaw`` stands."""

    def __init__(self, flaws: list[Flaw]) -> None:
        self.flaws = tuple(flaws)
        super().__init__([Problem(flaw.what, hint=flaw.hint) for flaw in flaws])


@dataclass(frozen=True)
class KnowledgeModel:
    """What a robot can do, with what, and under which constraints (ROSA paper, section 5.1, tables 2 and 3).

    Elements keep their order of declaration, which breaks ties of priority. Load one from files with :meth:`load`,
    or build it from elements. Models that differ only in their annotations are equal.

    Args:
        measures, actions, functions, components, requirements, function_designs, component_configurations, constraints,
            estimations: the elements and relations, each kind in order of declaration.
        annotations: remarks of the files that the rules make nothing of.

    Raises:
        KnowledgeModelError: if names dangle or are double, or an element does not hold together; lists every flaw.

    Example:
        >>> from rosa_core import KnowledgeModel
        >>> from rosa_core.model import Action, Component, Function, FunctionalRequirement, FunctionDesign
        >>> model = KnowledgeModel(
        ...     actions=(Action("fly"),),
        ...     functions=(Function("stabilise"),),
        ...     components=(Component("autopilot"),),
        ...     requirements=(FunctionalRequirement("fly", ("stabilise",)),),
        ...     function_designs=(FunctionDesign("by autopilot", "stabilise", ("autopilot",)),),
        ... )
        >>> model.names["action"]
        ('fly',)
        >>> KnowledgeModel(requirements=(FunctionalRequirement("fly", ("stabilise",)),))
        Traceback (most recent call last):
        rosa_core.model.knowledge_model.FlawedModelError: a functional requirement names the unknown action 'fly' ...
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

        Args:
            paths: at least one file. Those in TypeQL need the package ``rosa_typeql``.

        Raises:
            KnowledgeModelError: with file, line and hint for everything that is wrong.
        """
        model: KnowledgeModel = _LOADER.load()(paths)
        return model

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
