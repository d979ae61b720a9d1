"""The configuration life cycle: what ends a stable interval, what is learned, and what is written down."""

from __future__ import annotations

import itertools
import threading

import pytest

from rosa_core import InputError
from rosa_core.clock import SimulationClock, WallClock
from rosa_streams.costs import Estimator, LearnedCosts, Objective
from rosa_streams.environment import Port, Sample, Transformation
from rosa_streams.life_cycle import PerturbationKind
from rosa_streams.manager import Manager
from rosa_streams.runtime import Function, Sources
from rosa_streams.tags import parse_tag
from rosa_streams.validity import is_valid
from tests.rosa_streams.nao import BALL, manager, robot

A, B = parse_tag("A"), parse_tag("B")


def source(tid: str, labor: float | None = None, upkeep: float | None = None) -> Transformation:
    return Transformation(tid, tid, (), (Port("out", A),), labor=labor, upkeep=upkeep)


def counting(*names: str) -> Sources:
    known = Sources()
    for name in names:
        known.factory(name)(
            lambda parameters: Function(lambda now, at: (at, at + 1), (), ("out",), state=0, period=0.1)
        )
    return known


def kinds(srm: Manager) -> list[PerturbationKind]:
    return [each.kind for each in srm.journal[-1].perturbations]


def piff() -> tuple[SimulationClock, Manager]:
    clock = SimulationClock()
    srm = manager(clock)
    srm.register(robot("piff"))
    srm.add_target("q0", BALL, "/result")
    return clock, srm


def test_a_target_that_is_added_ends_the_stable_interval() -> None:
    _, srm = piff()
    assert kinds(srm) == [PerturbationKind.TARGETS_CHANGED]
    assert srm.is_satisfied("q0")


def test_a_library_that_changes_ends_the_stable_interval() -> None:
    _, srm = piff()
    srm.register(robot("puff"))
    assert kinds(srm) == [PerturbationKind.TRANSFORMATIONS_CHANGED]


def test_a_unit_that_is_lost_while_samples_flow_ends_the_stable_interval() -> None:
    clock, srm = piff()
    clock.advance_to(1.0)
    srm.host.lose("ball_detector.1", "it crashed")
    assert not is_valid(srm.environment) or "ball_detector.1" in srm.environment.graph()
    clock.advance_to(1.0)
    assert kinds(srm) == [PerturbationKind.UNIT_LOST]
    assert [unit.cid for unit in srm.journal[-1].change.created()] == ["ball_detector.2"]
    assert "it crashed" in str(srm.journal[-1])


def test_a_subscription_that_is_lost_ends_the_stable_interval_and_is_made_again() -> None:
    clock, srm = piff()
    clock.advance_to(1.0)
    before = srm.environment
    srm.drop_subscription("ball_detector.1", "hull")
    assert kinds(srm) == [PerturbationKind.SUBSCRIPTION_LOST]
    assert srm.environment == before
    assert [unit.cid for unit in srm.journal[-1].change.reconfigured()] == ["ball_detector.1"]
    assert not srm.journal[-1].change.created()


def test_the_horizon_ends_the_stable_interval_and_starts_the_next_one() -> None:
    clock, srm = piff()
    cycles = srm.cycle
    clock.advance_to(59.9)
    assert srm.cycle == cycles
    clock.advance_to(60.0)
    assert kinds(srm) == [PerturbationKind.HORIZON]
    clock.advance_to(185.0)
    assert srm.cycle == cycles + 3


def test_a_premature_review_moves_the_horizon() -> None:
    clock, srm = piff()
    clock.advance_to(40.0)
    srm.register(robot("puff"))
    cycles = srm.cycle
    clock.advance_to(99.0)
    assert srm.cycle == cycles
    clock.advance_to(100.0)
    assert srm.cycle == cycles + 1


def test_a_hasty_repair_is_refined_soon() -> None:
    """After the loss, the cheapest tree has a source for each input, where one for both would do; it is replaced."""
    library = [
        Transformation("both", "s", (), (Port("a", A), Port("b", B)), (("period", 0.1),), upkeep=0.010),
        Transformation("a", "s", (), (Port("a", A),), (("period", 1 / 6),), upkeep=0.006),
        Transformation("b", "s", (), (Port("b", B),), (("period", 1 / 6),), upkeep=0.006),
        Transformation("join", "join", (Port("a", A), Port("b", B)), (Port("out", parse_tag("C")),), upkeep=0.0),
    ]
    known = Sources()
    known.factory("s")(
        lambda parameters: Function(lambda now: None, (), ("a", "b"), period=float(parameters["period"]))
    )
    known.function("join", lambda a, b: None)
    seconds = itertools.count()
    clock = SimulationClock()
    srm = Manager(
        clock, known, costs=LearnedCosts(first_labor=0.001), objective=Objective(horizon=60.0),
        refine=10.0, cpu_time=lambda: next(seconds) / 1000,
    )  # fmt: skip
    srm.register(library)
    srm.add_target("q", "C", "/r")
    assert {unit.tid for unit in srm.environment.units} == {"both", "join"}
    clock.advance_to(5.05)
    for cid in list(srm.environment.graph()):
        srm.host.lose(cid)
    clock.advance_to(5.05)
    assert {unit.tid for unit in srm.environment.units} == {"a", "b", "join"}
    assert srm.journal[-1].search == "fast"
    clock.advance_to(15.05)
    assert kinds(srm) == [PerturbationKind.REFINEMENT]
    assert {unit.tid for unit in srm.environment.units} == {"both", "join"}


def test_a_reused_detector_whose_segmenter_vanished_is_expanded_and_its_gap_is_closed() -> None:
    clock, srm = piff()
    clock.advance_to(1.0)
    srm.unload("segmenter.1")
    assert srm.environment.graph()["ball_detector.1"].subscription("hull") == "/segmenter.2/hull"


def test_several_losses_at_once_are_repaired_in_one_review() -> None:
    clock, srm = piff()
    clock.advance_to(1.0)
    for cid in ("segmenter.1", "subsampler.1", "bottom_cam.1"):
        srm.host.lose(cid)
    cycles = srm.cycle
    clock.advance_to(1.0)
    assert srm.cycle == cycles + 1
    assert is_valid(srm.environment)
    assert {unit.cid for unit in srm.journal[-1].change.created()} == {"segmenter.2", "subsampler.2", "bottom_cam.2"}


def test_a_target_that_is_removed_unloads_what_nothing_needs() -> None:
    _, srm = piff()
    srm.remove_target("q0")
    assert not srm.environment.units
    assert not srm.host.units()


def test_estimates_are_weighted_recent_history() -> None:
    estimator = Estimator(5.0, weight=0.25)
    assert estimator.value == 5.0
    assert [estimator.observe(value) for value in (8.0, 0.0, 0.0)] == [8.0, 6.0, 4.5]
    with pytest.raises(InputError, match="weight"):
        Estimator(1.0, weight=0.0)


def test_upkeep_is_averaged_over_the_units_of_a_transformation() -> None:
    costs = LearnedCosts(weight=0.5)
    costs.observe_upkeep(source("a"), [1.0, 3.0])
    assert costs.upkeep(source("a")) == 2.0
    costs.observe_upkeep(source("a"), [4.0])
    assert costs.upkeep(source("a")) == 3.0
    assert costs.upkeep(source("b")) == 0.0


def test_labor_and_upkeep_are_learned_from_the_processor_time_that_units_take() -> None:
    """Each measured call takes a millisecond here: one to load, ten a second to produce."""
    seconds = itertools.count()
    clock = SimulationClock()
    srm = Manager(
        clock, counting("a"), costs=LearnedCosts(first_labor=9.0), objective=Objective(horizon=10.0),
        cpu_time=lambda: next(seconds) / 1000,
    )  # fmt: skip
    srm.register([source("a")])
    srm.add_target("q", "A", "/r")
    assert srm.costs.labor(source("a")) == pytest.approx(0.001)
    clock.advance_to(10.0)
    assert srm.costs.upkeep(source("a")) == pytest.approx(0.010, rel=0.02)


@pytest.mark.parametrize(("guess", "tried"), [(0.0, True), (100.0, False)])
def test_a_new_transformation_is_tried_under_a_low_first_guess_and_avoided_under_a_high_one(
    guess: float, tried: bool
) -> None:
    """The known one takes 0.01 s per second; over 100 s that is 1."""
    seconds = itertools.count()
    clock = SimulationClock()
    srm = Manager(
        clock, counting("known", "new"), costs=LearnedCosts(first_labor=guess, first_upkeep=guess / 100),
        objective=Objective(horizon=100.0), cpu_time=lambda: next(seconds) / 1000,
    )  # fmt: skip
    srm.register([source("known")])
    srm.add_target("q", "A", "/r")
    clock.advance_to(100.0)
    srm.register([source("new")])
    assert ("new.1" in srm.environment.graph()) is tried


def test_a_plan_beyond_max_cost_is_refused_and_said() -> None:
    srm = Manager(
        SimulationClock(), counting("a"), costs=LearnedCosts(first_labor=50.0), objective=Objective(max_cost=10.0)
    )
    srm.register([source("a")])
    assert not srm.add_target("q", "A", "/r")
    assert "the cheapest plan costs 50, and MAX_COST is 10" in str(srm.why("q"))


def test_a_transformation_that_fails_again_and_again_is_set_aside_and_another_one_is_used() -> None:
    known = counting("good")
    known.factory("bad")(lambda parameters: 1 / 0)
    clock = SimulationClock()
    srm = Manager(clock, known, objective=Objective(horizon=30.0))
    srm.register([source("bad", labor=0.0)])
    srm.add_target("q", "A", "/r")
    why = srm.why("q")
    assert not why.satisfied
    assert any("bad is set aside until 30 s" in line and "ZeroDivisionError" in line for line in why.reasons)
    assert "fix the implementation of bad" in why.remedies[0]
    srm.register([source("good", labor=5.0)])
    clock.advance_to(0.0)
    assert [unit.cid for unit in srm.environment.units] == ["good.1"]
    tries = [each.cid for each in srm.host.lost]
    assert tries == ["bad.1", "bad.2", "bad.3"]


def test_an_unsatisfiable_target_leaves_the_streams_of_the_others_alone() -> None:
    clock, srm = piff()
    results: list[Sample] = []
    srm.subscribe("/result", results.append)
    before = srm.environment.units
    assert not srm.add_target("q1", "Temperature", "/temperature")
    assert srm.environment.units == before
    assert list(srm.unsatisfied()) == ["q1"]
    clock.advance_to(1.0)
    assert results


def test_the_journal_holds_every_change_set_with_its_reason() -> None:
    clock, srm = piff()
    clock.advance_to(1.0)
    srm.unload("segmenter.1", "the driver was updated")
    entries = [entry.as_json() for entry in srm.journal]
    assert [entry["cycle"] for entry in entries] == [1, 2, 3]
    assert entries[-1]["perturbations"] == ["unit lost: segmenter.1 (the driver was updated)"]
    assert [unit["unit"] for unit in entries[-1]["created"]] == ["segmenter.2"]
    assert entries[1]["targets_added"] == ["q0"]
    assert len(entries[0]["transformations_added"]) == 6


def test_requests_that_make_no_sense_are_refused() -> None:
    _, srm = piff()
    for wrong in (
        lambda: srm.add_target("q0", BALL, "/other"),
        lambda: srm.add_target("q9", BALL, "/result"),
        lambda: srm.remove_target("q9"),
        lambda: srm.unload("nobody.1"),
        lambda: srm.unregister("segmentor(piff)"),
        lambda: srm.drop_subscription("pose.1", "x"),
        lambda: srm.register([source("pose(piff)")]),
        lambda: srm.add_target("q9", "A or B", "/x"),
    ):
        with pytest.raises(InputError):
            wrong()
    assert len(srm.environment.targets) == 1


def test_in_real_time_a_lost_unit_is_replaced_and_samples_come_again() -> None:
    known = Sources()
    known.factory("a")(lambda parameters: Function(lambda now, at: (at, at + 1), (), ("out",), state=0, period=0.005))
    srm = Manager(WallClock(), known, objective=Objective(horizon=1000.0))
    try:
        again, first = threading.Event(), threading.Event()
        srm.register([source("a")])

        def receive(sample: Sample) -> None:
            first.set()
            if "a.2" in {unit.cid for unit in srm.host.units()}:
                again.set()

        srm.subscribe("/r", receive)
        assert srm.add_target("q", "A", "/r")
        assert first.wait(20)
        srm.host.lose("a.1", "it crashed")
        assert again.wait(20)
        assert "it crashed" in str(srm.journal[-1])
    finally:
        srm.close()
