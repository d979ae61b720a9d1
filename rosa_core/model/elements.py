"""The elements of a knowledge model (ROSA paper, section 5.1, tables 2 and 3), as frozen facts.

What a roboticist writes down at design time is here. What is created at run time (measurements, required actions,
reconfiguration plans, statuses) is in :mod:`rosa_core.model.records`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class ElementKind(StrEnum):
    """The kinds of element that have a name or a status of their own."""

    MEASURE = "measure"
    ACTION = "action"
    FUNCTION = "function"
    COMPONENT = "component"
    FUNCTION_DESIGN = "function_design"
    COMPONENT_CONFIGURATION = "component_configuration"
    CONSTRAINT = "constraint"


class MeasureKind(StrEnum):
    """What a measure is a function of: the system (quality), the environment, or unsaid."""

    MEASURE = "measure"
    QUALITY = "quality"
    ENVIRONMENTAL = "environmental"


class ComponentType(StrEnum):
    """Whether a component is a node, and of which kind. Only nodes can be started and stopped by the executor."""

    COMPONENT = "component"
    ROS_NODE = "ros_node"
    LIFECYCLE_NODE = "lifecycle_node"

    @property
    def is_node(self) -> bool:
        """Whether there is something to activate and deactivate; a thruster, say, is not a node."""
        return self is not ComponentType.COMPONENT


class ParameterType(StrEnum):
    """The types that a component parameter can have (those of ROS 2 parameters)."""

    BOOLEAN = "boolean"
    BOOLEAN_ARRAY = "boolean_array"
    DOUBLE = "double"
    DOUBLE_ARRAY = "double_array"
    LONG = "long"
    LONG_ARRAY = "long_array"
    STRING = "string"
    STRING_ARRAY = "string_array"


class ConstraintOperator(StrEnum):
    """How a measurement is compared with the value of a constraint: ``measurement OPERATOR value``."""

    LESS = "<"
    LESS_OR_EQUAL = "<="
    GREATER = ">"
    GREATER_OR_EQUAL = ">="


class EstimationType(StrEnum):
    """What an estimated impact does to a measure: adds to it, subtracts from it, or replaces it."""

    POSITIVE = "positive"
    NEGATIVE = "negative"
    ABSOLUTE = "absolute"


Scalar = bool | int | float | str
ParameterValue = Scalar | tuple[Scalar, ...]


@dataclass(frozen=True, slots=True, order=True)
class ElementRef:
    """An element by kind and name: names are unique only within a kind.

    >>> print(ElementRef(ElementKind.FUNCTION_DESIGN, "by autopilot"))
    function design 'by autopilot'

    Args:
        kind: of the element.
        name: of the element.
    """

    kind: ElementKind
    name: str

    def __str__(self) -> str:
        return f"{self.kind.value.replace('_', ' ')} '{self.name}'"


@dataclass(frozen=True, slots=True)
class Measure:
    """Something that can be measured, such as a battery level or the visibility of the water.

    Args:
        name: unique among measures. The unit is whatever its measurements and constraints are given in.
        kind: whether the system or the environment determines it.
    """

    name: str
    kind: MeasureKind = MeasureKind.MEASURE


@dataclass(frozen=True, slots=True)
class Action:
    """Something the robot can do. Which functions it needs is said by :class:`FunctionalRequirement`.

    Args:
        name: unique among actions.
    """

    name: str


@dataclass(frozen=True, slots=True)
class Function:
    """Something the system can do for an action.

    Args:
        name: unique among functions.
        always_improve: whether a better design is taken up as soon as there is one, also when the function is solved.
    """

    name: str
    always_improve: bool = False


@dataclass(frozen=True, slots=True)
class Component:
    """A hardware or software part.

    Args:
        name: unique among components.
        type: whether it is a node, which can be started and stopped.
        package: the package of what a node runs.
        executable: what a node runs.
        always_improve: whether a better configuration is taken up as soon as there is one.
    """

    name: str
    type: ComponentType = ComponentType.COMPONENT
    package: str | None = None
    executable: str | None = None
    always_improve: bool = False


@dataclass(frozen=True, slots=True)
class ComponentParameter:
    """One parameter of a component with one value. The same (component, key, value) is the same entity.

    Args:
        component: the name of the component.
        key: the name of the parameter.
        value: in the unit that the component expects; a tuple for the array types.
        type: of the value.
    """

    component: str
    key: str
    value: ParameterValue
    type: ParameterType


@dataclass(frozen=True, slots=True)
class FunctionalRequirement:
    """Functions that an action requires.

    Args:
        action: its name.
        functions: their names.
    """

    action: str
    functions: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FunctionDesign:
    """A set of components that solves a function.

    Args:
        name: unique among function designs.
        function: the name of the function.
        components: names, at least one.
        priority: the lowest number is preferred, None comes last.
    """

    name: str
    function: str
    components: tuple[str, ...]
    priority: float | None = None


@dataclass(frozen=True, slots=True)
class ComponentConfiguration:
    """Parameters that a component can run with.

    Args:
        name: unique among component configurations.
        component: the name of the component.
        parameters: all of this component, each key once.
        priority: the lowest number is preferred, None comes last.
    """

    name: str
    component: str
    parameters: tuple[ComponentParameter, ...] = ()
    priority: float | None = None


def shown_number(number: float) -> str:
    """A number in as few digits as say exactly which it is.

    >>> shown_number(0.25), shown_number(2.0), shown_number(0.1 + 0.2)
    ('0.25', '2', '0.30000000000000004')
    """
    short = f"{number:g}"
    return short if float(short) == number else repr(number)


@dataclass(frozen=True, slots=True)
class Constraint:
    """``measure operator value`` must hold for the constrained element; without a value it is never evaluated.

    >>> print(Constraint("battery", ElementRef(ElementKind.ACTION, "fly"), value=0.2))
    battery >= 0.2

    Args:
        measure: the name of the measure.
        constrained: an action, component, function design or component configuration.
        operator: how a measurement is compared with the value.
        value: in the measure's unit.
    """

    measure: str
    constrained: ElementRef
    operator: ConstraintOperator = ConstraintOperator.GREATER_OR_EQUAL
    value: float | None = None

    def __str__(self) -> str:
        return f"{self.measure} {self.operator} {'?' if self.value is None else shown_number(self.value)}"


@dataclass(frozen=True, slots=True)
class Estimation:
    """The impact on a measure that selecting the causer is expected to have.

    Args:
        causer: a component, function design or component configuration.
        measure: the name of the measure.
        value: in the measure's unit.
        type: whether it is added, subtracted, or replaces the sum.
    """

    causer: ElementRef
    measure: str
    value: float
    type: EstimationType = EstimationType.POSITIVE


@dataclass(frozen=True, slots=True)
class Annotation:
    """Something that a file states of an element and that the rules make nothing of, such as a description.

    Args:
        element: of which it is stated.
        attribute: spelled as in TypeQL files.
        value: of the attribute.
    """

    element: ElementRef
    attribute: str
    value: Scalar


CONSTRAINABLE = frozenset(
    {
        ElementKind.ACTION,
        ElementKind.COMPONENT,
        ElementKind.FUNCTION_DESIGN,
        ElementKind.COMPONENT_CONFIGURATION,
    }
)
ESTIMABLE = CONSTRAINABLE - {ElementKind.ACTION}
