"""What a robot is modelled by, as plain data: elements, models of them, and records of what happens at run time.

The elements are those of tables 2 and 3 of the ROSA paper, the records those of table 4.
"""

from rosa_core.model.changes import Element, Elements
from rosa_core.model.effort import Effort, count_effort
from rosa_core.model.elements import (
    Action,
    Annotation,
    Component,
    ComponentConfiguration,
    ComponentParameter,
    ComponentType,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
    MeasureKind,
    ParameterType,
    ParameterValue,
)
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction, StatusChange
from rosa_core.model.status import Result, Status
from rosa_core.model.utility import Limit, Utility

__all__ = [
    "Action",
    "Annotation",
    "Component",
    "ComponentConfiguration",
    "ComponentParameter",
    "ComponentType",
    "Constraint",
    "ConstraintOperator",
    "Effort",
    "Element",
    "ElementKind",
    "ElementRef",
    "Elements",
    "Estimation",
    "EstimationType",
    "Function",
    "FunctionDesign",
    "FunctionalRequirement",
    "KnowledgeModel",
    "Limit",
    "Measure",
    "MeasureKind",
    "Measurement",
    "ParameterType",
    "ParameterValue",
    "ReconfigurationPlan",
    "RequiredAction",
    "Result",
    "Status",
    "StatusChange",
    "Utility",
    "count_effort",
]
