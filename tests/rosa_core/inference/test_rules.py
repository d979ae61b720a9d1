"""The status rules, line by line: each line of the table, that the first line wins, and every combination of inputs."""

from collections.abc import Collection, Iterator
from itertools import chain, combinations, product
from typing import Any

import pytest

from rosa_core.inference.rules import (
    action_status,
    component_configuration_status,
    component_status,
    constraint_status,
    function_design_status,
    function_status,
    is_adaptable,
    is_selectable,
)
from rosa_core.model.elements import ConstraintOperator
from rosa_core.model.status import Status

NOT_EVALUATED, SATISFIED, VIOLATED = Status.NOT_EVALUATED, Status.SATISFIED, Status.VIOLATED
FAILURE, UNFEASIBLE, FEASIBLE = Status.FAILURE, Status.UNFEASIBLE, Status.FEASIBLE
ERROR, IMPLICIT_ERROR = Status.CONFIGURATION_ERROR, Status.IMPLICIT_CONFIGURATION_ERROR
UNSOLVED, SOLVED = Status.UNSOLVED, Status.SOLVED

OF_CONSTRAINT = (NOT_EVALUATED, SATISFIED, VIOLATED)
OF_CONFIGURATION = (UNFEASIBLE, FEASIBLE)
OF_COMPONENT = (FAILURE, UNFEASIBLE, ERROR, UNSOLVED, SOLVED, FEASIBLE)
OF_DESIGN = (UNFEASIBLE, IMPLICIT_ERROR, UNSOLVED, SOLVED, FEASIBLE)
OF_FUNCTION = (UNFEASIBLE, ERROR, IMPLICIT_ERROR, UNSOLVED, SOLVED, FEASIBLE)
OF_ACTION = (UNFEASIBLE, IMPLICIT_ERROR, UNSOLVED, SOLVED, FEASIBLE)

Statuses = Collection[Status]


@pytest.mark.parametrize(
    ("compare", "limit", "measurement", "expected"),
    [
        ("<", 2.0, 1.0, SATISFIED),
        ("<", 2.0, 2.0, VIOLATED),
        ("<", 2.0, 3.0, VIOLATED),
        ("<=", 2.0, 1.0, SATISFIED),
        ("<=", 2.0, 2.0, SATISFIED),
        ("<=", 2.0, 3.0, VIOLATED),
        (">", 2.0, 1.0, VIOLATED),
        (">", 2.0, 2.0, VIOLATED),
        (">", 2.0, 3.0, SATISFIED),
        (">=", 2.0, 1.0, VIOLATED),
        (">=", 2.0, 2.0, SATISFIED),
        (">=", 2.0, 3.0, SATISFIED),
        (">=", 0.0, -0.0, SATISFIED),
        (">", 0.0, 0.0, VIOLATED),
    ],
)
def test_a_constraint_is_satisfied_or_violated_by_the_latest_measurement(
    compare: str, limit: float, measurement: float, expected: Status
) -> None:
    assert constraint_status(ConstraintOperator(compare), limit, measurement) is expected


@pytest.mark.parametrize("compare", ConstraintOperator)
@pytest.mark.parametrize(("limit", "measurement"), [(1.0, None), (0.0, None), (None, 1.0), (None, 0.0), (None, None)])
def test_a_constraint_without_value_or_measurement_is_not_evaluated(
    compare: ConstraintOperator, limit: float | None, measurement: float | None
) -> None:
    assert constraint_status(compare, limit, measurement) is NOT_EVALUATED


@pytest.mark.parametrize(
    ("constraints", "expected"),
    [
        ([VIOLATED], UNFEASIBLE),
        ([SATISFIED, VIOLATED, NOT_EVALUATED], UNFEASIBLE),
        ([NOT_EVALUATED], FEASIBLE),
        ([SATISFIED], FEASIBLE),
        ([], FEASIBLE),
    ],
)
def test_a_component_configuration_is_unfeasible_when_one_of_its_constraints_is_violated(
    constraints: Statuses, expected: Status
) -> None:
    assert component_configuration_status(constraints) is expected


IDLE: dict[str, Any] = {
    "failed": False,
    "required": False,
    "active": False,
    "constraints": [],
    "configurations": [],
    "selected_configurations": [],
}
RUNNING = {**IDLE, "required": True, "active": True}


@pytest.mark.parametrize(
    ("facts", "expected"),
    [
        pytest.param({**IDLE, "failed": True}, FAILURE, id="failure reported"),
        pytest.param({**IDLE, "configurations": [UNFEASIBLE, UNFEASIBLE]}, UNFEASIBLE, id="no configuration feasible"),
        pytest.param({**IDLE, "constraints": [SATISFIED, VIOLATED]}, UNFEASIBLE, id="constraint violated"),
        pytest.param(
            {**RUNNING, "configurations": [UNFEASIBLE, FEASIBLE], "selected_configurations": [UNFEASIBLE]},
            ERROR,
            id="selected configuration unfeasible",
        ),
        pytest.param({**RUNNING, "active": False}, UNSOLVED, id="not active"),
        pytest.param({**RUNNING, "configurations": [FEASIBLE]}, UNSOLVED, id="no configuration selected"),
        pytest.param(RUNNING, SOLVED, id="required, active, without configurations"),
        pytest.param(
            {**RUNNING, "configurations": [FEASIBLE, UNFEASIBLE], "selected_configurations": [FEASIBLE]},
            SOLVED,
            id="required, active, configured",
        ),
        pytest.param(IDLE, FEASIBLE, id="nothing against it"),
        pytest.param({**IDLE, "active": True}, FEASIBLE, id="active but not required"),
        pytest.param({**IDLE, "constraints": [NOT_EVALUATED]}, FEASIBLE, id="constraint not evaluated"),
        pytest.param({**IDLE, "configurations": [UNFEASIBLE, FEASIBLE]}, FEASIBLE, id="one configuration feasible"),
        # The first line that applies wins.
        pytest.param({**RUNNING, "failed": True, "constraints": [VIOLATED]}, FAILURE, id="failure before unfeasible"),
        pytest.param(
            {**RUNNING, "configurations": [UNFEASIBLE], "selected_configurations": [UNFEASIBLE]},
            UNFEASIBLE,
            id="unfeasible before configuration error",
        ),
        pytest.param(
            {
                **RUNNING,
                "active": False,
                "configurations": [UNFEASIBLE, FEASIBLE],
                "selected_configurations": [UNFEASIBLE],
            },
            ERROR,
            id="configuration error before unsolved",
        ),
    ],
)
def test_a_component_has_the_status_of_the_first_line_that_applies(facts: dict[str, Any], expected: Status) -> None:
    assert component_status(**facts) is expected


@pytest.mark.parametrize(
    ("selected", "constraints", "components", "expected"),
    [
        (False, [VIOLATED], [FEASIBLE], UNFEASIBLE),
        (False, [], [FEASIBLE, FAILURE], UNFEASIBLE),
        (False, [], [FEASIBLE, UNFEASIBLE], UNFEASIBLE),
        (True, [], [SOLVED, ERROR], IMPLICIT_ERROR),
        (True, [], [SOLVED, UNSOLVED], UNSOLVED),
        (True, [], [SOLVED, SOLVED], SOLVED),
        (False, [SATISFIED, NOT_EVALUATED], [FEASIBLE], FEASIBLE),
        (False, [], [SOLVED, UNSOLVED, ERROR], FEASIBLE),
        # The first line that applies wins.
        (True, [VIOLATED], [ERROR, UNSOLVED], UNFEASIBLE),
        (True, [], [ERROR, FAILURE], UNFEASIBLE),
        (True, [], [UNSOLVED, ERROR], IMPLICIT_ERROR),
    ],
)
def test_a_function_design_has_the_status_of_the_first_line_that_applies(
    selected: bool, constraints: Statuses, components: Statuses, expected: Status
) -> None:
    assert function_design_status(selected=selected, constraints=constraints, components=components) is expected


@pytest.mark.parametrize(
    ("required", "designs", "selected", "expected"),
    [
        (False, [], [], UNFEASIBLE),
        (False, [UNFEASIBLE, UNFEASIBLE], [], UNFEASIBLE),
        (True, [UNFEASIBLE, FEASIBLE], [UNFEASIBLE], ERROR),
        (True, [IMPLICIT_ERROR, FEASIBLE], [IMPLICIT_ERROR], IMPLICIT_ERROR),
        (True, [FEASIBLE, FEASIBLE], [], UNSOLVED),
        (True, [UNSOLVED, FEASIBLE], [UNSOLVED], UNSOLVED),
        (True, [SOLVED, UNFEASIBLE], [SOLVED], SOLVED),
        (False, [FEASIBLE, UNFEASIBLE], [], FEASIBLE),
        (False, [SOLVED], [SOLVED], FEASIBLE),
        # The first line that applies wins.
        (True, [UNFEASIBLE], [UNFEASIBLE], UNFEASIBLE),
        (True, [], [], UNFEASIBLE),
        (True, [UNFEASIBLE, IMPLICIT_ERROR], [UNFEASIBLE, IMPLICIT_ERROR], ERROR),
    ],
)
def test_a_function_has_the_status_of_the_first_line_that_applies(
    required: bool, designs: Statuses, selected: Statuses, expected: Status
) -> None:
    assert function_status(required=required, designs=designs, selected_designs=selected) is expected


@pytest.mark.parametrize(
    ("required", "constraints", "functions", "expected"),
    [
        (False, [VIOLATED], [FEASIBLE], UNFEASIBLE),
        (False, [], [FEASIBLE, UNFEASIBLE], UNFEASIBLE),
        (True, [], [SOLVED, ERROR], IMPLICIT_ERROR),
        (True, [], [SOLVED, IMPLICIT_ERROR], IMPLICIT_ERROR),
        (True, [], [SOLVED, UNSOLVED], UNSOLVED),
        (True, [SATISFIED], [SOLVED, SOLVED], SOLVED),
        (True, [], [], SOLVED),
        (False, [NOT_EVALUATED], [FEASIBLE], FEASIBLE),
        (False, [], [], FEASIBLE),
        # Its functions may be required by another action.
        (False, [], [UNSOLVED, ERROR], FEASIBLE),
        # The first line that applies wins.
        (True, [VIOLATED], [ERROR, UNSOLVED], UNFEASIBLE),
        (True, [], [UNSOLVED, ERROR], IMPLICIT_ERROR),
    ],
)
def test_an_action_has_the_status_of_the_first_line_that_applies(
    required: bool, constraints: Statuses, functions: Statuses, expected: Status
) -> None:
    assert action_status(required=required, constraints=constraints, functions=functions) is expected


# -- all combinations of inputs, against the table in another form: for each line, whether it applies --


def subsets(statuses: tuple[Status, ...], at_most: int | None = None) -> Iterator[frozenset[Status]]:
    sizes = range((len(statuses) if at_most is None else at_most) + 1)
    return map(frozenset, chain.from_iterable(combinations(statuses, size) for size in sizes))


def first(*lines: tuple[bool, Status]) -> Status:
    return next(status for applies, status in lines if applies)


YES_OR_NO = (False, True)


def test_component_rules_agree_with_the_table_for_every_combination() -> None:
    inputs = product(
        YES_OR_NO, YES_OR_NO, YES_OR_NO, subsets(OF_CONSTRAINT), subsets(OF_CONFIGURATION), (None, UNFEASIBLE, FEASIBLE)
    )
    for failed, required, active, constraints, configurations, selected in inputs:
        if selected is not None and selected not in configurations:
            continue
        status = component_status(
            failed=failed,
            required=required,
            active=active,
            constraints=constraints,
            configurations=configurations,
            selected_configurations=[] if selected is None else [selected],
        )
        assert status in OF_COMPONENT
        assert status is first(
            (failed, FAILURE),
            (configurations == {UNFEASIBLE}, UNFEASIBLE),
            (VIOLATED in constraints, UNFEASIBLE),
            (required and selected is UNFEASIBLE, ERROR),
            (required and not active, UNSOLVED),
            (required and len(configurations) > 0 and selected is None, UNSOLVED),
            (required, SOLVED),
            (True, FEASIBLE),
        )


def test_component_configuration_rules_agree_with_the_table_for_every_combination() -> None:
    for constraints in subsets(OF_CONSTRAINT):
        status = component_configuration_status(constraints)
        assert status in OF_CONFIGURATION
        assert status is first((VIOLATED in constraints, UNFEASIBLE), (True, FEASIBLE))


def test_function_design_rules_agree_with_the_table_for_every_combination() -> None:
    for selected, constraints, components in product(YES_OR_NO, subsets(OF_CONSTRAINT), subsets(OF_COMPONENT)):
        status = function_design_status(selected=selected, constraints=constraints, components=components)
        assert status in OF_DESIGN
        assert status is first(
            (VIOLATED in constraints, UNFEASIBLE),
            (bool(components & {FAILURE, UNFEASIBLE}), UNFEASIBLE),
            (selected and ERROR in components, IMPLICIT_ERROR),
            (selected and bool(components - {SOLVED}), UNSOLVED),
            (selected, SOLVED),
            (True, FEASIBLE),
        )


def test_function_rules_agree_with_the_table_for_every_combination() -> None:
    for required, designs, selected in product(YES_OR_NO, subsets(OF_DESIGN), (None, *OF_DESIGN[:-1])):
        if selected is not None and selected not in designs:
            continue
        chosen = [] if selected is None else [selected]
        status = function_status(required=required, designs=designs, selected_designs=chosen)
        assert status in OF_FUNCTION
        assert status is first(
            (len(designs) == 0, UNFEASIBLE),
            (designs == {UNFEASIBLE}, UNFEASIBLE),
            (required and selected is UNFEASIBLE, ERROR),
            (required and selected is IMPLICIT_ERROR, IMPLICIT_ERROR),
            (required and selected in (None, UNSOLVED), UNSOLVED),
            (required, SOLVED),
            (True, FEASIBLE),
        )


def test_action_rules_agree_with_the_table_for_every_combination() -> None:
    for required, constraints, functions in product(YES_OR_NO, subsets(OF_CONSTRAINT), subsets(OF_FUNCTION)):
        status = action_status(required=required, constraints=constraints, functions=functions)
        assert status in OF_ACTION
        assert status is first(
            (VIOLATED in constraints, UNFEASIBLE),
            (UNFEASIBLE in functions, UNFEASIBLE),
            (required and bool(functions & {ERROR, IMPLICIT_ERROR}), IMPLICIT_ERROR),
            (required and UNSOLVED in functions, UNSOLVED),
            (required, SOLVED),
            (True, FEASIBLE),
        )


@pytest.mark.parametrize("status", Status)
def test_all_but_the_unfeasible_and_the_failed_are_selectable(status: Status) -> None:
    assert is_selectable(status) == (status.value not in ("unfeasible", "failure"))


@pytest.mark.parametrize("always_improve", YES_OR_NO)
@pytest.mark.parametrize("status", Status)
def test_adaptable_is_what_is_unsolved_or_in_error_or_may_improve(status: Status, always_improve: bool) -> None:
    expected = status.value in ("unsolved", "configuration error") or (status.value == "solved" and always_improve)
    assert is_adaptable(status, always_improve) == expected


def test_which_statuses_occur_counts_and_not_in_what_collection() -> None:
    for gather in (list, set, tuple, lambda statuses: dict.fromkeys(statuses, 7)):
        assert function_design_status(selected=True, constraints=gather([]), components=gather([ERROR])) is (
            IMPLICIT_ERROR
        )
