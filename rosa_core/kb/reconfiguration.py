"""From a selected configuration to the reconfiguration plan that brings it about (ROSA paper, section 6.2.3)."""

from __future__ import annotations

from collections.abc import Iterable
from operator import attrgetter
from typing import TypeVar

from rosa_core.errors import InvalidValueError
from rosa_core.inference.network import ComponentNode, ConfigurationNode, DesignNode, Node
from rosa_core.inference.reasoner import Reasoner
from rosa_core.model.records import ReconfigurationPlan

_N = TypeVar("_N", bound=Node)


def declared_order(nodes: Iterable[_N]) -> list[_N]:
    """Nodes of one kind in order of declaration: sets have none that is the same in every run."""
    return sorted(nodes, key=attrgetter("order"))


def check_one_each(designs: list[DesignNode], configurations: list[ConfigurationNode]) -> None:
    """Make sure that there is at most one design of each function and one configuration of each component.

    Args:
        designs: those to be selected together.
        configurations: those to be selected together.

    Raises:
        InvalidValueError: if there are more.
    """
    functions: dict[str, str] = {}
    for design in designs:
        other = functions.setdefault(design.function.name, design.name)
        if other != design.name:
            raise InvalidValueError(
                f"'{other}' and '{design.name}' are both designs of '{design.function.name}'; select one"
            )
    components: dict[str, str] = {}
    for configuration in configurations:
        other = components.setdefault(configuration.component.name, configuration.name)
        if other != configuration.name:
            raise InvalidValueError(
                f"'{other}' and '{configuration.name}' both configure '{configuration.component.name}'; select one"
            )


def displaced_designs(reasoner: Reasoner, designs: list[DesignNode]) -> list[DesignNode]:
    """The selected designs that go when ``designs`` are selected: others of their functions, and those not required.

    Args:
        reasoner: knows what is selected and required now.
        designs: those about to be selected.

    Returns:
        in order of declaration.
    """
    functions = {design.function for design in designs}
    return [
        design
        for design in declared_order(reasoner.selected_designs)
        if design not in designs and (design.function in functions or design.function.required_by == 0)
    ]


def displaced_configurations(reasoner: Reasoner, configurations: list[ConfigurationNode]) -> list[ConfigurationNode]:
    """The selected configurations that go when ``configurations`` are selected.

    These are the others of their components, and those of components not required, which run with none.

    Args:
        reasoner: with the designs selected already, as they say which components are required.
        configurations: those about to be selected.

    Returns:
        in order of declaration.
    """
    components = {configuration.component for configuration in configurations}
    return [
        configuration
        for configuration in declared_order(reasoner.selected_configurations)
        if configuration not in configurations
        and (configuration.component in components or configuration.component.required_by == 0)
    ]


def make_plan(reasoner: Reasoner, plan_id: int, time: float) -> ReconfigurationPlan | None:
    """The difference between the selected configuration and how the robot runs now (ROSA paper, section 5).

    A component that both the old and the new design use keeps running. A configuration that was selected but never
    applied, because the plan for it failed or was abandoned, is in the next plan again.

    Args:
        reasoner: knows what is selected, required, active and applied.
        plan_id: its number.
        time: when it is made, in seconds.

    Returns:
        names in order of declaration; None when there is no difference.
    """
    wanted: set[ComponentNode] = set()
    for design in reasoner.selected_designs:
        if design.function.required_by > 0:
            wanted.update(design.members)
    activate = [c for c in wanted if not c.active]
    deactivate = [c for c in reasoner.active_components if c.designs and c not in wanted]
    adapt = [c for c in reasoner.selected_configurations if not c.applied]
    if not (activate or deactivate or adapt):
        return None
    return ReconfigurationPlan(
        plan_id,
        time,
        tuple(c.name for c in declared_order(activate)),
        tuple(c.name for c in declared_order(deactivate)),
        tuple(c.name for c in declared_order(adapt)),
    )


def same_work(one: ReconfigurationPlan, other: ReconfigurationPlan) -> bool:
    """Whether two plans do the same, whatever their numbers, times and results.

    Args:
        one: a plan.
        other: another.
    """
    return (one.activate, one.deactivate, one.parameter_adaptations) == (
        other.activate,
        other.deactivate,
        other.parameter_adaptations,
    )


def is_part_of(plan: ReconfigurationPlan, other: ReconfigurationPlan) -> bool:
    """Whether a plan does nothing that the other does not do.

    Args:
        plan: the one that may be the smaller.
        other: the one that may do more.
    """
    return (
        set(plan.activate) <= set(other.activate)
        and set(plan.deactivate) <= set(other.deactivate)
        and set(plan.parameter_adaptations) <= set(other.parameter_adaptations)
    )
