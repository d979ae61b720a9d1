"""What can be chosen for an action, as the knowledge base knows it now."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from operator import attrgetter

from rosa_core.choice import Alternatives, ConfigurationOption, DesignOption, unmet_limits
from rosa_core.inference.network import ActionNode, ComponentNode, EstimationLink, Node
from rosa_core.inference.rules import is_selectable
from rosa_core.model.utility import Utility

EstimationsOf = Mapping[Node, Sequence[EstimationLink]]
"""The estimations of each causer, in order of declaration."""


def alternatives_of(action: ActionNode, estimations_of: EstimationsOf) -> Alternatives:
    """The feasible designs of the action's functions, the feasible configurations of their components, and what is
    estimated of these.

    Args:
        action: the node of the action.
        estimations_of: the links of the estimations by causer.

    Returns:
        designs by function, also for functions that have no feasible one; configurations by component, for components
        that have a feasible one; and the estimations in order of declaration.
    """
    functions: dict[str, tuple[DesignOption, ...]] = {}
    used: dict[ComponentNode, None] = {}
    causers: dict[Node, None] = {}
    for function in action.members:
        designs = [design for design in function.options if is_selectable(design.status)]
        functions[function.name] = tuple(
            DesignOption(d.name, tuple(member.name for member in d.members), d.element.priority) for d in designs
        )
        for design in designs:
            causers[design] = None
            used.update(dict.fromkeys(design.members))
    components: dict[str, tuple[ConfigurationOption, ...]] = {}
    for component in sorted(used, key=lambda node: node.order):
        causers[component] = None
        options = [option for option in component.options if is_selectable(option.status)]
        if options:
            components[component.name] = tuple(ConfigurationOption(o.name, o.element.priority) for o in options)
            causers.update(dict.fromkeys(options))
    links = [link for causer in causers for link in estimations_of.get(causer, ())]
    links.sort(key=attrgetter("order"))
    return Alternatives(functions, components, tuple(link.element for link in links))


def decision_notes(utility: Utility | None, node: Node, estimations_of: EstimationsOf) -> tuple[str, ...]:
    """What is to be said about how an action's configuration is chosen: that the utility's limits cannot be met.

    Args:
        utility: that decides, if one does.
        node: what is explained; there is something to say only of actions.
        estimations_of: the links of the estimations by causer.

    Returns:
        no note, or one.
    """
    if utility is None or not isinstance(node, ActionNode):
        return ()
    unmet = unmet_limits(alternatives_of(node, estimations_of), utility)
    return () if unmet is None else (f"{unmet}; so priorities decide",)
