"""The scenario ``uav``: its record, its managers, what may be set."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from tests.uav_example.flights import SOUND_GRIPPER, STEADY_BATTERY, actions, events_with, fly
from uav_example.parameters import PARAMETERS
from uav_example.scenario import UAV
from uav_example.world.parameters import WorldParameters


@pytest.fixture(scope="module")
def default_run() -> RunRecord:
    """The mission as ``rosa run uav`` flies it."""
    return UAV.run(RunRequest(), SilentObserver())


def test_it_is_installed() -> None:
    assert find_scenario("uav") == UAV


def test_the_default_run_meets_all_three_uncertainties_and_ends_well(default_run: RunRecord) -> None:
    assert default_run.ended_by == "mission done"
    assert all(default_run.reactions[name] for name in ("U1", "U2", "U3"))
    metrics = default_run.metrics
    assert metrics["samples_found"] == metrics["samples"] == 6
    assert metrics["samples_picked_up"] + metrics["samples_in_situ"] == 6
    assert metrics["adaptations"] == sum(len(several) for several in default_run.reactions.values())
    assert actions(default_run)[-1] == ("land_fold", "completed")


def test_a_plan_achieves_what_the_tree_does(default_run: RunRecord) -> None:
    planned = UAV.run(RunRequest(task_layer="pddl"), SilentObserver())
    assert planned.ended_by == "mission done"
    assert planned.plans[0].steps == (
        "(search search uav1)",
        "(return_base return_base search uav1)",
        "(land_fold land_fold uav1)",
    )
    timed = {"mean_reaction_time_s"}
    assert {k: v for k, v in planned.metrics.items() if k not in timed} == pytest.approx(
        {k: v for k, v in default_run.metrics.items() if k not in timed}
    )


def test_reactions_are_a_services_delay_and_a_little_computing(default_run: RunRecord) -> None:
    for reactions in default_run.reactions.values():
        for reaction in reactions:
            assert reaction.delay_s == pytest.approx(WorldParameters().service_time)
            assert reaction.compute_s > 0


def test_the_battery_never_runs_empty_with_a_manager(default_run: RunRecord) -> None:
    assert min(row[-1] for row in default_run.trajectory) > 0.1


def test_the_aircraft_ends_on_the_ground_at_its_base(default_run: RunRecord) -> None:
    _, x, y, _, _ = default_run.trajectory[-1]
    assert (x, y) == (0.0, 0.0)


def test_without_a_manager_the_battery_runs_empty() -> None:
    record = fly(manager="none", **SOUND_GRIPPER)
    assert record.ended_by == "battery empty"
    assert events_with(record, "the battery is empty")
    assert record.metrics["recharges"] == 0
    assert not any(record.reactions.values())


def test_without_a_manager_a_failed_gripper_is_waited_for_till_the_end() -> None:
    record = fly(manager="none", **STEADY_BATTERY, gripper_fails_after=5.0, time_limit=120.0)
    assert record.ended_by == "time limit"
    assert record.metrics["samples_found"] == 1
    assert record.metrics["samples_in_situ"] == 0


def test_without_uncertainties_the_floor_does_as_well() -> None:
    calm = {**SOUND_GRIPPER, **STEADY_BATTERY}
    unmanaged, managed = fly(manager="none", **calm), fly(**calm)
    assert unmanaged.ended_by == managed.ended_by == "mission done"
    assert unmanaged.metrics["samples_picked_up"] == managed.metrics["samples_picked_up"] == 6
    assert unmanaged.duration_s == pytest.approx(managed.duration_s, abs=2.0)


def test_all_runs_with_the_same_seed_are_the_same(default_run: RunRecord, tmp_path: Path) -> None:
    default_run.write(tmp_path / "a")
    fly().write(tmp_path / "b")
    for name in ("run.json", "events.jsonl", "trajectory.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_another_seed_is_another_flight(default_run: RunRecord) -> None:
    assert fly(seed=1).trajectory != default_run.trajectory


def test_every_parameter_is_a_number_of_the_world() -> None:
    assert set(PARAMETERS) <= set(WorldParameters.__dataclass_fields__)
    for name, parameter in PARAMETERS.items():
        default = getattr(WorldParameters(), name)
        if default is not None:
            assert parameter.read(default) == default


def test_a_file_may_set_parameters_and_the_request_counts_before_it(tmp_path: Path) -> None:
    config = tmp_path / "calm.yaml"
    config.write_text("parameters: {samples: 2, gripper_life: 1000000, time_limit: 50}\n", encoding="utf-8")
    record = UAV.run(RunRequest(mission_config=config, parameters={"samples": 1}, time_limit=20.0), SilentObserver())
    world = record.inputs["world"]
    assert (world["samples"], world["gripper_life"], world["time_limit"]) == (1, 1e6, 20.0)
    assert record.ended_by == "time limit"
    assert record.duration_s == 20.0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("parameters: {sampels: 2}\n", r"uav.yaml:1: .*no parameter 'sampels' \(did you mean 'samples'\?\)"),
        ("parameters:\n  speed: fast\n", "uav.yaml:2: speed is 'fast' .a number from 0.1 to 100"),
        ("parameters: {samples: 2.5}\n", "a whole number from 0 to 1000"),
        ("parameters: {spring: maybe}\n", "true or false"),
        ("samples: 2\n", "unknown key 'samples'"),
        ("", "not a file of parameters"),
        ("parameters: [1]\n", "a mapping is expected"),
        ("parameters: {lane_spacing: 100}\n", "samples would be missed"),
        ("parameters: {charge_rate: 0.001}\n", "never be full"),
    ],
)
def test_parameters_that_cannot_be_are_refused(tmp_path: Path, text: str, said: str) -> None:
    config = tmp_path / "uav.yaml"
    config.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said):
        UAV.check(RunRequest(mission_config=config))


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        (RunRequest(manager="rose"), "did you mean 'rosa'"),
        (RunRequest(task_layer="xml"), "there are: bt, pddl"),
        (RunRequest(manager="none", task_layer="pddl"), "fly plans with --manager rosa"),
        (RunRequest(domain=Path("d.pddl")), "add --task-layer pddl"),
    ],
)
def test_requests_that_cannot_be_are_refused(request_: RunRequest, said: str) -> None:
    with pytest.raises(InputError, match=said):
        UAV.check(request_)


def test_the_record_says_where_the_samples_lay(default_run: RunRecord, tmp_path: Path) -> None:
    default_run.write(tmp_path)
    run = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    assert [sample["number"] for sample in run["inputs"]["samples"]] == [1, 2, 3, 4, 5, 6]
