"""Environments, change sets, validity, and the validity matrix."""

from __future__ import annotations

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.stream_libraries import random_library
from rosa_core import InputError
from rosa_streams.costs import DeclaredCosts, update_cost
from rosa_streams.environment import Change, Environment, Port, Target, Transformation, Unit, update
from rosa_streams.matching import PortName, ValidityMatrix
from rosa_streams.tags import Ontology, parse_tag
from rosa_streams.validity import ViolationKind, violations

UNITS = [Unit.of(f"u.{number}", "t", {}, {"out": f"/c{number}"}) for number in range(4)]
TRANSFORMATIONS = [Transformation(f"t{number}", "s") for number in range(4)]
TARGETS = [Target(f"q{number}", parse_tag("A"), f"/c{number}") for number in range(4)]


def sets(of: list) -> st.SearchStrategy[frozenset]:  # type: ignore[type-arg]
    return st.frozensets(st.sampled_from(of))


environments = st.builds(Environment, sets(UNITS), sets(TRANSFORMATIONS), sets(TARGETS))
changes = st.builds(
    Change, sets(UNITS), sets(UNITS), sets(TRANSFORMATIONS), sets(TRANSFORMATIONS), sets(TARGETS), sets(TARGETS)
)


@given(environments, changes)
def test_an_update_adds_first_and_then_removes(environment: Environment, change: Change) -> None:
    after = update(environment, change)
    assert after.units == (environment.units | change.units_added) - change.units_removed
    assert after.transformations == (
        (environment.transformations | change.transformations_added) - change.transformations_removed
    )
    assert after.targets == (environment.targets | change.targets_added) - change.targets_removed
    assert after.units.isdisjoint(change.units_removed)
    assert update(after, change) == after, "applied again, it changes nothing more"
    assert update(environment, Change()) == environment


@given(environments, changes)
def test_an_update_leaves_the_environment_before_it_as_it_was(environment: Environment, change: Change) -> None:
    copy = Environment(environment.units, environment.transformations, environment.targets)
    update(environment, change)
    assert environment == copy


SOURCE = Transformation("source", "s", (), (Port("out", parse_tag("Image")),), labor=2.0, upkeep=0.5)
FILTER = Transformation("filter", "s", (Port("in", parse_tag("Image")),), (Port("out", parse_tag("Hull")),), labor=3.0)
GOAL = Target("q", parse_tag("Hull"), "/r")
RIGHT = (Unit.of("source.1", "source", {}, {"out": "/i"}), Unit.of("filter.1", "filter", {"in": "/i"}, {"out": "/r"}))


def environment(*units: Unit, library: tuple[Transformation, ...] = (SOURCE, FILTER)) -> Environment:
    return Environment(frozenset(units), frozenset(library), frozenset({GOAL}))


@pytest.mark.parametrize(
    ("case", "kind", "about", "said"),
    [
        (environment(*RIGHT), None, "", ""),
        (
            environment(*RIGHT, library=(FILTER,)),
            ViolationKind.NO_TRANSFORMATION, "source.1", "'source' is not in the library",
        ),
        (
            environment(RIGHT[0], Unit.of("filter.1", "filter", {"in": None}, {"out": "/r"})),
            ViolationKind.NO_STREAM, "filter.1.in", "subscribes to no channel",
        ),
        (environment(RIGHT[1]), ViolationKind.NO_STREAM, "filter.1.in", "no unit writes to its channel '/i'"),
        (environment(RIGHT[0]), ViolationKind.UNSATISFIED_TARGET, "q", "no unit writes there"),
        (
            environment(Unit.of("source.1", "source", {}, {"out": "/r"})),
            ViolationKind.UNSATISFIED_TARGET, "q", "Image from source.1 is not that",
        ),
        (
            environment(*RIGHT, Unit.of("filter.2", "filter", {"in": "/r"}, {"out": "/x"})),
            ViolationKind.TAG_MISMATCH, "filter.2.in", "asks for Image and gets Hull from filter.1.out",
        ),
        (
            environment(*RIGHT, Unit.of("source.2", "source", {}, {"out": "/i"})),
            ViolationKind.SHARED_CHANNEL, "/i", "source.1.out, source.2.out",
        ),
        (
            environment(*RIGHT, Unit.of("source.1", "source", {}, {"out": "/other"})),
            ViolationKind.SHARED_NAME, "source.1", "have this name",
        ),
    ],
)  # fmt: skip
def test_each_condition_of_validity_is_checked_with_its_reason(
    case: Environment, kind: ViolationKind | None, about: str, said: str
) -> None:
    found = violations(case)
    assert [(each.kind, each.about) for each in found] == ([] if kind is None else [(kind, about)])
    assert all(said in each.reason for each in found)


def test_an_update_costs_labor_once_and_upkeep_over_the_horizon() -> None:
    empty = environment()
    change = Change(units_added=frozenset(RIGHT))
    assert update_cost(empty, change, DeclaredCosts(default_upkeep=0.1), 10) == 2 + 3 + 10 * (0.5 + 0.1)
    running = update(empty, change)
    moved = Unit.of("filter.1", "filter", {"in": "/i"}, {"out": "/elsewhere"})
    reconnect = Change(units_added=frozenset({moved}), units_removed=frozenset({RIGHT[1]}))
    assert update_cost(running, reconnect, DeclaredCosts(default_upkeep=0.1), 10) == 10 * (0.5 + 0.1)


def test_two_ports_of_one_name_are_refused() -> None:
    with pytest.raises(InputError, match="two ports 'a'"):
        Transformation("t", "s", (Port("a", parse_tag("A")),), (Port("a", parse_tag("B")),))


@pytest.mark.parametrize("seed", range(5))
def test_a_matrix_that_is_kept_up_to_date_is_the_one_computed_from_nothing(seed: int) -> None:
    rng = random.Random(seed)
    library = list(random_library(40, seed, kinds=8).transformations)
    library.append(Transformation("any", "s", (Port("in", parse_tag("∃hasSource.field")),), ()))
    library.append(Transformation("all", "s", (Port("in", parse_tag("⊤")),), ()))
    present: dict[str, Transformation] = {}
    matrix = ValidityMatrix(Ontology())
    for _ in range(150):
        each = rng.choice(library)
        if each.tid in present:
            matrix.remove(present.pop(each.tid))
        else:
            matrix.add(each)
            present[each.tid] = each
    fresh = ValidityMatrix.of(present.values())
    assert set(matrix.pairs()) == set(fresh.pairs())
    ontology = Ontology()
    for into in matrix.inputs:
        wanted = present[into.owner].input(into.port).tag
        expected = {
            PortName(tid, port.name)
            for tid, each in present.items()
            for port in each.outputs
            if ontology.matches(port.tag, wanted)
        }
        assert set(matrix.providers(into)) == expected
        assert all(matrix.matches(output, into) == (output in expected) for output in matrix.outputs)
