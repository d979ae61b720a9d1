"""The paper's case study (section V), in simulated time, and on the level of environments."""

from __future__ import annotations

import pytest

from rosa_core.clock import SimulationClock
from rosa_streams.costs import Objective
from rosa_streams.environment import Environment, Sample, Target
from rosa_streams.life_cycle import PerturbationKind
from rosa_streams.manager import Manager
from rosa_streams.matching import ValidityMatrix
from rosa_streams.planning import plan
from rosa_streams.specification import load_specification
from rosa_streams.tags import parse_tag
from rosa_streams.validity import is_valid, violations
from tests.rosa_streams.nao import BALL, DATA, FIELD, FUSED, field, fusion, manager, robot


def running_piff() -> tuple[SimulationClock, Manager, list[Sample]]:
    clock = SimulationClock()
    srm = manager(clock)
    results: list[Sample] = []
    srm.subscribe("/result", results.append)
    srm.add_target("q0", BALL, "/result")
    srm.register(robot("piff"))
    return clock, srm, results


def test_table_1_of_one_robot_makes_a_matrix_of_11_inputs_and_19_outputs() -> None:
    environment = load_specification(DATA / "table1.xml", DATA / "piff.yaml").environment
    matrix = ValidityMatrix.of(environment.transformations, similarity=environment.similarity)
    assert (len(matrix.inputs), len(matrix.outputs)) == (11, 19)
    two = load_specification(DATA / "table1.xml", FIELD).environment
    matrix = ValidityMatrix.of(two.transformations, similarity=two.similarity)
    assert (len(matrix.inputs), len(matrix.outputs)) == (22, 38)
    assert all(
        f"({name})" in str(out) for out, into in matrix.pairs() for name in ("piff", "puff") if name in str(into)
    )


def test_a_target_without_transformations_has_nothing_to_be_done_and_says_why() -> None:
    srm = manager()
    assert not srm.add_target("q0", BALL, "/result")
    assert not srm.journal[-1].plan.change
    assert "no transformation gives Position ⊓ ∃hasSource.Ball" in str(srm.why("q0"))


def test_without_a_source_of_poses_the_reason_names_the_pose() -> None:
    srm = manager()
    srm.register([each for each in robot("piff") if not each.tid.startswith("pose")])
    srm.add_target("q0", BALL, "/result")
    why = srm.why("q0")
    assert not why.satisfied
    assert any("ball_localization(piff) would give it and lacks its input pose" in line for line in why.reasons)
    assert why.remedies[0] == "register a transformation that gives Pose ⊓ ∃hasSource.{piff}".replace("{piff}", "piff")


def test_setup_when_piff_registers_everything_is_instantiated_and_positions_come() -> None:
    clock, srm, results = running_piff()
    assert [unit.cid for unit in srm.journal[-1].change.created()] == [
        "ball_detector.1",
        "ball_localization.1",
        "bottom_cam.1",
        "pose.1",
        "segmenter.1",
        "subsampler.1",
    ]
    assert is_valid(srm.environment), violations(srm.environment)
    clock.advance_to(2.0)
    frames = [sample.value["frame"] for sample in results]
    assert frames[-1] >= 18
    assert srm.why("q0").satisfied
    assert "from segmenter.1.hull" in str(srm.why("q0"))


def test_recovery_makes_only_the_segmenter_anew_and_reuses_the_subsamplers_topics() -> None:
    clock, srm, results = running_piff()
    clock.advance_to(1.05)
    before = srm.environment.graph()
    srm.unload("segmenter.1")
    after = srm.environment.graph()
    change = srm.journal[-1].change
    assert [unit.cid for unit in change.created()] == ["segmenter.2"]
    assert [unit.cid for unit in change.reconfigured()] == ["ball_detector.1"]
    assert not change.unloaded()
    assert dict(after["segmenter.2"].inputs) == dict(before["segmenter.1"].inputs)
    assert {cid for cid in before if after.get(cid) != before[cid]} == {"segmenter.1", "ball_detector.1"}
    seen = len(results)
    clock.advance_to(1.15)
    assert len(results) == seen + 1, "the next frame gives a position again"


def test_joining_puff_is_not_used_since_reuse_is_free() -> None:
    _, srm, _ = running_piff()
    before = srm.environment.units
    srm.register(robot("puff"))
    srm.register(fusion())
    assert srm.environment.units == before
    assert not srm.journal[-1].plan.change


def test_fusion_of_a_renamed_target_instantiates_puffs_pipeline_and_fuses_both() -> None:
    clock, srm, results = running_piff()
    srm.register([*robot("puff"), *fusion()])
    clock.advance_to(1.05)
    running = set(srm.environment.graph())
    assert srm.replace_target("q0", FUSED)
    created = [unit.tid for unit in srm.journal[-1].change.created()]
    assert created == [
        "ball_detector(puff)",
        "ball_localization(puff)",
        "bottom_cam(puff)",
        "fuse_ball_pos",
        "pose(puff)",
        "segmenter(puff)",
        "subsampler(puff)",
    ]
    assert running <= set(srm.environment.graph()), "piff's pipeline stays"
    assert [unit.cid for unit in srm.journal[-1].change.reconfigured()] == ["ball_localization.1"]
    clock.advance_to(2.0)
    assert set(results[-1].value) == {"first", "second"}
    assert is_valid(srm.environment), violations(srm.environment)


def test_fusion_needs_no_renamed_target_where_quality_weighs() -> None:
    clock = SimulationClock()
    srm = manager(clock, objective=Objective(horizon=60.0, quality_weight=1000.0))
    srm.add_target("q0", BALL, "/result")
    srm.register([*robot("piff"), *robot("puff"), *fusion()])
    assert "fuse_ball_pos.1" in srm.environment.graph()
    assert srm.journal[-1].plan.quality == 2.0


def test_three_solutions_are_found_for_the_fusion_case() -> None:
    """Piff's stream, puff's stream, or both fused: by what each would cost from piff's pipeline."""
    library = [*robot("piff"), *robot("puff"), *fusion()]
    goal = frozenset({Target("q0", parse_tag(BALL), "/result")})
    everything = Environment(frozenset(), frozenset(library), goal, field())
    without_piff = Environment(
        frozenset(), frozenset(each for each in library if "(piff)" not in each.tid), goal, field()
    )
    fused = Environment(
        frozenset(), frozenset(library), frozenset({Target("q0", parse_tag(FUSED), "/result")}), field()
    )
    costs = [plan(each).cost for each in (everything, without_piff, fused)]
    assert costs[0] == pytest.approx(costs[1])
    assert costs[2] is not None
    assert costs[0] is not None
    assert costs[2] > costs[0]


def test_when_a_robot_leaves_the_other_one_takes_over() -> None:
    clock, srm, results = running_piff()
    srm.register(robot("puff"))
    clock.advance_to(1.05)
    srm.unregister(*(each.tid for each in robot("piff")))
    assert {unit.tid.partition("(")[2] for unit in srm.environment.units} == {"puff)"}
    assert [str(each.kind) for each in srm.journal[-1].perturbations] == [PerturbationKind.TRANSFORMATIONS_CHANGED]
    clock.advance_to(2.05)
    assert results[-1].time > 1.9
    assert is_valid(srm.environment), violations(srm.environment)


def test_the_same_run_gives_the_same_journal() -> None:
    def journal() -> list[str]:
        clock, srm, _ = running_piff()
        srm.register([*robot("puff"), *fusion()])
        clock.advance_to(1.05)
        srm.unload("subsampler.1")
        srm.replace_target("q0", FUSED)
        clock.advance_to(130.0)
        return [str(entry.as_json()) for entry in srm.journal]

    assert journal() == journal()
