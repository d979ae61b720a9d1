"""The nodes of the inference network: what each element's status depends on, in a form that can be followed fast.

One node per element. A node keeps, for each group of elements that it depends on, how many of them have which status
(:class:`StatusCounts`), so that evaluating it costs the same however many there are. :mod:`rosa_core.inference.wiring`
ties nodes together.

``order`` is the place of an element in the order of declaration. It grows with every element that is added and may have
gaps, so that it stays when others are removed.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from typing import ClassVar

from rosa_core.inference.rules import (
    action_status,
    component_configuration_status,
    component_status,
    constraint_status,
    function_design_status,
    function_status,
)
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_core.model.status import Status

StatusCounts = dict[Status, int]
"""How many elements of a group have each status; statuses that do not occur are absent."""


class Node:
    """An element with a status.

    Args:
        name: of the element.
        order: its place in the order of declaration, over all kinds; greater for what was added later.

    Attributes:
        dirty: whether the status is to be inferred again.
        dependents: the groups of other nodes in which this one is counted.
        constraints: how many constraints on it have each status.
    """

    __slots__ = ("constraints", "dependents", "dirty", "name", "order", "status")
    kind: ClassVar[ElementKind]
    level: ClassVar[int]
    """Evaluation order: a node depends only on nodes of lower levels."""
    is_adapted: ClassVar[bool] = False
    """Whether planning chooses designs or configurations for it."""

    def __init__(self, name: str, order: int) -> None:
        self.name = name
        self.order = order
        self.status = Status.NOT_EVALUATED
        self.dirty = False
        self.dependents: list[tuple[Node, StatusCounts]] = []
        self.constraints: StatusCounts = {}

    def evaluate(self) -> Status:
        """The status that the rules give, from what is known of the nodes that this one depends on."""
        raise TypeError(f"{type(self).__name__} has no rule")

    def join(self, dependent: Node, group: StatusCounts) -> None:
        """Count this node's status in a group of ``dependent`` from now on.

        Args:
            dependent: the node whose status depends on this one's.
            group: one of its counts of statuses.
        """
        self.dependents.append((dependent, group))
        group[self.status] = group.get(self.status, 0) + 1

    def leave(self, dependent: Node, group: StatusCounts) -> None:
        """Count this node's status there no longer.

        Args:
            dependent: the node whose group it is.
            group: the very object that was joined.

        Raises:
            LookupError: if this node is not counted there.
        """
        for index, (_, joined) in enumerate(self.dependents):
            if joined is group:
                del self.dependents[index]
                uncount(group, self.status)
                return
        raise LookupError(f"'{self.name}' is not counted by '{dependent.name}'")


def uncount(group: StatusCounts, status: Status) -> None:
    """One element less of the group has this status.

    Args:
        group: changed in place; a status that no element has is left out.
        status: of the element that leaves.

    Raises:
        KeyError: if no element of the group has it.

    Example:
        >>> group = {Status.FEASIBLE: 2, Status.SOLVED: 1}
        >>> uncount(group, Status.SOLVED)
        >>> group
        {<Status.FEASIBLE: 'feasible'>: 2}
    """
    left = group[status] - 1
    if left:
        group[status] = left
    else:
        del group[status]


class MeasureNode:
    """A measure with its latest value, and its constraints in order of their limits.

    Args:
        element: the measure.
        order: as of :class:`Node`.

    Attributes:
        value: in the measure's unit; None before the first measurement.
        time: of that measurement, in seconds.
        limits: the limits of ``constraints``, ascending.
        references: how many constraints and estimations name it.
    """

    __slots__ = ("constraints", "element", "limits", "name", "order", "references", "time", "value")
    kind = ElementKind.MEASURE

    def __init__(self, element: Measure, order: int) -> None:
        self.element = element
        self.name = element.name
        self.order = order
        self.value: float | None = None
        self.time: float | None = None
        self.constraints: list[ConstraintNode] = []
        self.limits: list[float] = []
        self.references = 0

    def add_constraint(self, node: ConstraintNode) -> None:
        """Take up a constraint on this measure; one without a value can never change."""
        self.references += 1
        limit = node.constraint.value
        if limit is not None:
            place = bisect_right(self.limits, limit)
            self.limits.insert(place, limit)
            self.constraints.insert(place, node)

    def remove_constraint(self, node: ConstraintNode) -> None:
        """Give a constraint on this measure up."""
        self.references -= 1
        if node.constraint.value is not None:
            place = self.constraints.index(node, bisect_left(self.limits, node.constraint.value))
            del self.limits[place], self.constraints[place]

    def between(self, old: float | None, new: float | None) -> list[ConstraintNode]:
        """The constraints that can change when the value goes from old to new: limits outside are passed by neither.

        Args:
            old: the value before, in the measure's unit; None if there was none.
            new: the value now, or None.

        Returns:
            those with a limit from the lower value to the higher, both included; all if one value is None.
        """
        if old is None or new is None:
            return self.constraints
        low, high = (old, new) if old <= new else (new, old)
        return self.constraints[bisect_left(self.limits, low) : bisect_right(self.limits, high)]


class ConstraintNode(Node):
    """A constraint; its name is for people, it is not a key.

    Args:
        constraint: the constraint.
        measure: of the constraint; it need not have been measured.
        target: what the constraint is on.
        order: as of :class:`Node`.
    """

    __slots__ = ("constraint", "measure", "target")
    kind = ElementKind.CONSTRAINT
    level = 0

    def __init__(self, constraint: Constraint, measure: MeasureNode, target: Node, order: int) -> None:
        super().__init__(f"{constraint} on {constraint.constrained}", order)
        self.constraint = constraint
        self.measure = measure
        self.target = target

    @property
    def element(self) -> Constraint:
        """The constraint."""
        return self.constraint

    def evaluate(self) -> Status:
        return constraint_status(self.constraint.operator, self.constraint.value, self.measure.value)


class ConfigurationNode(Node):
    """A component configuration.

    Args:
        element: the configuration.
        component: which it configures.
        order: as of :class:`Node`.

    Attributes:
        selected: whether the component is to run with it.
        applied: whether the component has run with it since it was selected.
    """

    __slots__ = ("applied", "component", "element", "selected")
    kind = ElementKind.COMPONENT_CONFIGURATION
    level = 1

    def __init__(self, element: ComponentConfiguration, component: ComponentNode, order: int) -> None:
        super().__init__(element.name, order)
        self.element = element
        self.component = component
        self.selected = False
        self.applied = False

    def evaluate(self) -> Status:
        return component_configuration_status(self.constraints)


class ComponentNode(Node):
    """A component.

    Args:
        element: the component.
        order: as of :class:`Node`.

    Attributes:
        failed_since: in seconds; None while no failure is known.
        required_by: how many selected designs it is in.
    """

    __slots__ = (
        "active",
        "configurations",
        "designs",
        "element",
        "failed_since",
        "options",
        "required_by",
        "selected_configurations",
    )
    kind = ElementKind.COMPONENT
    level = 2
    is_adapted = True

    def __init__(self, element: Component, order: int) -> None:
        super().__init__(element.name, order)
        self.element = element
        self.options: list[ConfigurationNode] = []
        self.designs: list[DesignNode] = []
        self.configurations: StatusCounts = {}
        self.selected_configurations: StatusCounts = {}
        self.failed_since: float | None = None
        self.active = False
        self.required_by = 0

    def evaluate(self) -> Status:
        return component_status(
            failed=self.failed_since is not None,
            required=self.required_by > 0,
            active=self.active,
            constraints=self.constraints,
            configurations=self.configurations,
            selected_configurations=self.selected_configurations,
        )


class DesignNode(Node):
    """A function design.

    Args:
        element: the design.
        function: which it solves.
        members: its components, in the order of the design.
        order: as of :class:`Node`.
    """

    __slots__ = ("components", "element", "function", "members", "selected")
    kind = ElementKind.FUNCTION_DESIGN
    level = 3

    def __init__(
        self, element: FunctionDesign, function: FunctionNode, members: list[ComponentNode], order: int
    ) -> None:
        super().__init__(element.name, order)
        self.element = element
        self.function = function
        self.members = members
        self.components: StatusCounts = {}
        self.selected = False

    def evaluate(self) -> Status:
        return function_design_status(selected=self.selected, constraints=self.constraints, components=self.components)


class FunctionNode(Node):
    """A function.

    Args:
        element: the function.
        order: as of :class:`Node`.

    Attributes:
        required_by: how many required actions require it.
    """

    __slots__ = ("designs", "element", "options", "required_by", "requirements", "selected_designs")
    kind = ElementKind.FUNCTION
    level = 4
    is_adapted = True

    def __init__(self, element: Function, order: int) -> None:
        super().__init__(element.name, order)
        self.element = element
        self.requirements: list[RequirementLink] = []
        self.options: list[DesignNode] = []
        self.designs: StatusCounts = {}
        self.selected_designs: StatusCounts = {}
        self.required_by = 0

    def evaluate(self) -> Status:
        return function_status(
            required=self.required_by > 0, designs=self.designs, selected_designs=self.selected_designs
        )


class ActionNode(Node):
    """An action.

    Args:
        element: the action.
        order: as of :class:`Node`.

    Attributes:
        members: the functions that it requires, each once.
        required: whether it is to be performed.
    """

    __slots__ = ("element", "functions", "members", "required", "requirements")
    kind = ElementKind.ACTION
    level = 5

    def __init__(self, element: Action, order: int) -> None:
        super().__init__(element.name, order)
        self.element = element
        self.requirements: list[RequirementLink] = []
        self.members: list[FunctionNode] = []
        self.functions: StatusCounts = {}
        self.required = False

    def evaluate(self) -> Status:
        return action_status(required=self.required, constraints=self.constraints, functions=self.functions)


class RequirementLink:
    """A functional requirement: which functions are counted by which action.

    Args:
        element: the requirement.
        action: which requires.
        functions: those required.
        order: as of :class:`Node`.
    """

    __slots__ = ("action", "element", "functions", "order")

    def __init__(
        self, element: FunctionalRequirement, action: ActionNode, functions: list[FunctionNode], order: int
    ) -> None:
        self.element = element
        self.action = action
        self.functions = functions
        self.order = order


class EstimationLink:
    """An estimation; no status follows from it.

    Args:
        element: the estimation.
        causer: the design, component or configuration that it is estimated of.
        measure: which it changes.
        order: as of :class:`Node`; absolute estimations that were declared later count before earlier ones.
    """

    __slots__ = ("causer", "element", "measure", "order")

    def __init__(self, element: Estimation, causer: Node, measure: MeasureNode, order: int) -> None:
        self.element = element
        self.causer = causer
        self.measure = measure
        self.order = order


NamedNode = MeasureNode | ActionNode | FunctionNode | ComponentNode | DesignNode | ConfigurationNode
"""The node of an element that has a name."""
Part = NamedNode | ConstraintNode | RequirementLink | EstimationLink
"""What an element of a model, be it a relation, is in the network."""

LEVELS = 6
