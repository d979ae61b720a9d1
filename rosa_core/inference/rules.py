"""The status rules (ROSA paper, section 5.2, figure 3): one pure function per kind of element.

In each function the first line that applies wins. The arguments that collect statuses of other elements hold *which*
statuses occur among them, so anything that can be searched for a status will do: a set, a list, a dict of counts.

======================== ============================= ==============================================================
element                  status                        when
======================== ============================= ==============================================================
constraint               not evaluated                 no measurement yet, or the constraint has no value
..                       satisfied / violated          the latest measurement does / does not satisfy it
component configuration  unfeasible                    a constraint on it is violated
..                       feasible                      otherwise
component                failure                       a failure was reported and not cleared
..                       unfeasible                    all its configurations are unfeasible, or a constraint violated
..                       configuration error           required, and its selected configuration is unfeasible
..                       unsolved                      required, and inactive or without a selected configuration
..                       solved                        required
..                       feasible                      otherwise
function design          unfeasible                    a constraint violated, or a component in failure or unfeasible
..                       implicit configuration error  selected, and a component in configuration error
..                       unsolved                      selected, and a component not solved
..                       solved                        selected
..                       feasible                      otherwise
function                 unfeasible                    it has no design, or all its designs are unfeasible
..                       configuration error           required, and its selected design is unfeasible
..                       implicit configuration error  required, and its selected design likewise
..                       unsolved                      required, and no design is selected or the selected one unsolved
..                       solved                        required
..                       feasible                      otherwise
action                   unfeasible                    a constraint violated, or a function unfeasible
..                       implicit configuration error  required, and a function in (implicit) configuration error
..                       unsolved                      required, and a function unsolved
..                       solved                        required
..                       feasible                      otherwise
======================== ============================= ==============================================================

A constraint that is not evaluated is not violated. An action is required while it has a required-action without a
result; a function while some required action requires it; a component while it is in a selected function design.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Collection, Mapping

from rosa_core.model.elements import ConstraintOperator
from rosa_core.model.status import Status

Statuses = Collection[Status]

_HOLDS: Mapping[ConstraintOperator, Callable[[float, float], bool]] = {
    ConstraintOperator.LESS: operator.lt,
    ConstraintOperator.LESS_OR_EQUAL: operator.le,
    ConstraintOperator.GREATER: operator.gt,
    ConstraintOperator.GREATER_OR_EQUAL: operator.ge,
}


def _all_unfeasible(statuses: Statuses) -> bool:
    """Some, and no other status than unfeasible among them."""
    return Status.UNFEASIBLE in statuses and all(status is Status.UNFEASIBLE for status in statuses)


def constraint_status(compare: ConstraintOperator, limit: float | None, measurement: float | None) -> Status:
    """Figure 3a.

    >>> constraint_status(ConstraintOperator.GREATER_OR_EQUAL, 0.25, 0.2)
    <Status.VIOLATED: 'violated'>

    Args:
        compare: how the measurement is to compare with the limit.
        limit: the value of the constraint, in the measure's unit; None if it has none.
        measurement: the latest one of the constraint's measure, in its unit; None before the first.
    """
    if measurement is None or limit is None:
        return Status.NOT_EVALUATED
    return Status.SATISFIED if _HOLDS[compare](measurement, limit) else Status.VIOLATED


def component_configuration_status(constraints: Statuses) -> Status:
    """Figure 3b."""
    return Status.UNFEASIBLE if Status.VIOLATED in constraints else Status.FEASIBLE


def component_status(
    *,
    failed: bool,
    required: bool,
    active: bool,
    constraints: Statuses,
    configurations: Statuses,
    selected_configurations: Statuses,
) -> Status:
    """Figure 3c.

    Args:
        failed: a failure was reported and not cleared.
        required: it is in a selected design.
        active: it runs.
        constraints: statuses of the constraints on it.
        configurations: statuses of all its configurations.
        selected_configurations: statuses of those that are selected (one at most, as planning goes).
    """
    if failed:
        return Status.FAILURE
    if Status.VIOLATED in constraints or _all_unfeasible(configurations):
        return Status.UNFEASIBLE
    if not required:
        return Status.FEASIBLE
    if Status.UNFEASIBLE in selected_configurations:
        return Status.CONFIGURATION_ERROR
    if not active or (configurations and not selected_configurations):
        return Status.UNSOLVED
    return Status.SOLVED


def function_design_status(*, selected: bool, constraints: Statuses, components: Statuses) -> Status:
    """Figure 3d.

    Args:
        selected: it is the design to solve its function.
        constraints: statuses of the constraints on it.
        components: statuses of its components.

    Example:
        >>> function_design_status(selected=True, constraints=(), components={Status.SOLVED, Status.UNSOLVED})
        <Status.UNSOLVED: 'unsolved'>
    """
    if Status.VIOLATED in constraints or Status.FAILURE in components or Status.UNFEASIBLE in components:
        return Status.UNFEASIBLE
    if not selected:
        return Status.FEASIBLE
    if Status.CONFIGURATION_ERROR in components:
        return Status.IMPLICIT_CONFIGURATION_ERROR
    if any(status is not Status.SOLVED for status in components):
        return Status.UNSOLVED
    return Status.SOLVED


def function_status(*, required: bool, designs: Statuses, selected_designs: Statuses) -> Status:
    """Figure 3e.

    >>> function_status(required=True, designs={Status.FEASIBLE, Status.UNFEASIBLE}, selected_designs=())
    <Status.UNSOLVED: 'unsolved'>

    Args:
        required: some required action requires it.
        designs: statuses of all its designs.
        selected_designs: statuses of those that are selected.
    """
    if not designs or _all_unfeasible(designs):
        return Status.UNFEASIBLE
    if not required:
        return Status.FEASIBLE
    if Status.UNFEASIBLE in selected_designs:
        return Status.CONFIGURATION_ERROR
    if Status.IMPLICIT_CONFIGURATION_ERROR in selected_designs:
        return Status.IMPLICIT_CONFIGURATION_ERROR
    if not selected_designs or Status.UNSOLVED in selected_designs:
        return Status.UNSOLVED
    return Status.SOLVED


def action_status(*, required: bool, constraints: Statuses, functions: Statuses) -> Status:
    """Figure 3f.

    Args:
        required: it is to be performed.
        constraints: statuses of the constraints on it.
        functions: statuses of the functions that it requires.

    Example:
        >>> action_status(required=False, constraints={Status.VIOLATED}, functions={Status.FEASIBLE})
        <Status.UNFEASIBLE: 'unfeasible'>
    """
    if Status.VIOLATED in constraints or Status.UNFEASIBLE in functions:
        return Status.UNFEASIBLE
    if not required:
        return Status.FEASIBLE
    if Status.CONFIGURATION_ERROR in functions or Status.IMPLICIT_CONFIGURATION_ERROR in functions:
        return Status.IMPLICIT_CONFIGURATION_ERROR
    if Status.UNSOLVED in functions:
        return Status.UNSOLVED
    return Status.SOLVED


def is_selectable(status: Status) -> bool:
    """Whether the element may be chosen: neither unfeasible nor failed."""
    return status is not Status.UNFEASIBLE and status is not Status.FAILURE


def is_adaptable(status: Status, always_improve: bool) -> bool:
    """Whether a function or component is to be (re)configured (ROSA paper, section 6.2.3).

    Args:
        status: its present one.
        always_improve: whether a solved one is to take up what is better.
    """
    return (
        status is Status.UNSOLVED
        or status is Status.CONFIGURATION_ERROR
        or (always_improve and status is Status.SOLVED)
    )
