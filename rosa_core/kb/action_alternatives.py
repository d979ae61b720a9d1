"""What can be chosen for an action, as the knowledge base knows it now."""

from __future__ import annotations

from rosa_core.choice import Alternatives, ConfigurationOption, DesignOption, unmet_limits
from rosa_core.inference.network import ActionNode, ComponentNode, Node
from rosa_core.inference.rules import is_selectable
from rosa_core.model.elements import ElementKind, ElementRef, Estimation
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.utility import Utility


def alternatives_of(action: ActionNode, model: KnowledgeModel) -> Alternatives:
    """The feasible designs of the action's functions, the feasible configurations of their components, and what is
    estimated of these."""
    functions: dict[str, tuple[DesignOption, ...]] = {}
    used: dict[ComponentNode, None] = {}
    causers: dict[ElementRef, None] = {}
    for function in action.members:
        designs = [design for design in function.options if is_selectable(design.status)]
        functions[function.name] = tuple(
            DesignOption(d.name, tuple(member.name for member in d.members), d.element.priority) for d in designs
        )
        for design in designs:
            causers[ElementRef(ElementKind.FUNCTION_DESIGN, design.name)] = None
            used.update(dict.fromkeys(design.members))
    components: dict[str, tuple[ConfigurationOption, ...]] = {}
    for component in sorted(used, key=lambda node: node.order):
        causers[ElementRef(ElementKind.COMPONENT, component.name)] = None
        options = [option for option in component.options if is_selectable(option.status)]
        if options:
            components[component.name] = tuple(ConfigurationOption(o.name, o.element.priority) for o in options)
            causers.update({ElementRef(ElementKind.COMPONENT_CONFIGURATION, o.name): None for o in options})
    return Alternatives(functions, components, _estimations(causers, model))


def _estimations(causers: dict[ElementRef, None], model: KnowledgeModel) -> tuple[Estimation, ...]:
    known = model.estimations_of
    found = sorted((placed for causer in causers for placed in known.get(causer, ())), key=lambda placed: placed[0])
    return tuple(estimation for _, estimation in found)


def decision_notes(utility: Utility | None, node: Node, model: KnowledgeModel) -> tuple[str, ...]:
    """What is to be said about how an action's configuration is chosen: that the utility's limits cannot be met."""
    if utility is None or not isinstance(node, ActionNode):
        return ()
    unmet = unmet_limits(alternatives_of(node, model), utility)
    return () if unmet is None else (f"{unmet}; so priorities decide",)
