"""Which runs a campaign has: paired, and with ids that are the same whenever the run is."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_evaluation.campaign import Experiment, ManagerSpec, make_plan, read_managers
from rosa_simulation.scenario import find_scenario
from tests.rosa_evaluation.campaign.scenarios import Walk, plan


def experiment(tmp_path: Path, text: str) -> Experiment:
    path = tmp_path / "experiment.yaml"
    path.write_text(text, encoding="utf-8")
    return Experiment.load(path)


def test_managers_are_named_with_their_task_layer_or_without() -> None:
    assert read_managers("calm, wild-pddl", Walk()) == (
        ManagerSpec("calm", "calm", "bt"),
        ManagerSpec("wild-pddl", "wild", "pddl"),
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("clam", r"did you mean 'calm'\?"),
        ("calm-pdl", r"did you mean 'calm-pddl'\?"),
        ("", "there are: calm, calm-bt, calm-pddl, wild"),
        ("calm,", "there is no manager ''"),
        ("calm,wild,calm", "'calm' and 'calm', which is the same"),
        ("calm,calm-bt", "'calm' and 'calm-bt', which is the same"),
    ],
)
def test_managers_that_are_not_there_or_twice_are_refused(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_managers(text, Walk())


def test_every_manager_has_the_same_seeds_and_all_managers_have_one_before_the_next_comes() -> None:
    runs = plan(Walk(), runs=3).runs
    assert [(run.manager.name, run.request.seed) for run in runs] == [
        ("calm", 100),
        ("wild", 100),
        ("calm", 101),
        ("wild", 101),
        ("calm", 102),
        ("wild", 102),
    ]


def test_what_is_varied_is_the_same_for_every_manager_and_another_for_every_seed(tmp_path: Path) -> None:
    varied = experiment(tmp_path, "parameters: {drift: {uniform: [-1, 0.5]}}")
    runs = plan(Walk(), runs=5, experiment=varied).runs
    drifts = {
        name: [run.request.parameters["drift"] for run in runs if run.manager.name == name] for name in ("calm", "wild")
    }
    assert drifts["calm"] == drifts["wild"]
    assert len(set(drifts["calm"])) == 5


def test_an_id_is_the_same_however_the_campaign_is_cut() -> None:
    few, many = plan(Walk(), runs=2, managers="wild"), plan(Walk(), runs=6, managers="calm,wild-bt")
    assert {run.run_id for run in few.runs} < {run.run_id for run in many.runs}
    assert few.campaign_id != many.campaign_id


def test_an_id_is_another_when_anything_that_makes_the_outcome_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    still = experiment(tmp_path, "parameters: {drift: 0.1}")
    plans = [
        plan(Walk(), 1, "calm"),
        plan(Walk(), 1, "calm-pddl"),
        plan(Walk(), 1, "wild"),
        plan(Walk(name="stroll"), 1, "calm"),
        plan(Walk(), 1, "calm", still),
    ]
    monkeypatch.setattr("rosa_evaluation.campaign.plan.package_versions", lambda: {"mujoco": "0.1"})
    plans.append(plan(Walk(), 1, "calm"))
    assert len({run.run_id for some in plans for run in some.runs}) == len(plans)


def test_python_itself_is_no_part_of_an_id(monkeypatch: pytest.MonkeyPatch) -> None:
    ids = set()
    for python in ("3.11.1", "3.13.0"):
        versions = {"python": python, "mujoco": "4"}
        monkeypatch.setattr("rosa_evaluation.campaign.plan.package_versions", lambda versions=versions: versions)
        ids.add(plan(Walk(), 1, "calm").runs[0].run_id)
    assert len(ids) == 1


def test_a_campaign_is_another_when_its_managers_are_called_otherwise() -> None:
    one, other = plan(Walk(), managers="calm"), plan(Walk(), managers="calm-bt")
    assert [run.run_id for run in one.runs] == [run.run_id for run in other.runs]
    assert one.campaign_id != other.campaign_id


def test_parameters_that_the_scenario_does_not_have_are_refused_with_their_line(tmp_path: Path) -> None:
    wrong = experiment(tmp_path, "parameters:\n  drft: 1\n  width: wide\n")
    with pytest.raises(InputError) as refusal:
        plan(Walk(), experiment=wrong)
    first, second = refusal.value.problems
    assert (first.where and first.where.line, first.hint) == (2, "did you mean 'drift'?")
    assert (second.where and second.where.line, second.hint) == (3, "a number is expected")


def test_parameters_that_do_not_go_together_are_refused_before_anything_runs(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not as wide"):
        plan(Walk(), experiment=experiment(tmp_path, "parameters: {drift: {uniform: [0, 2]}, width: 0.5}"))


def test_suave_takes_visibility_thrusters_and_start(tmp_path: Path) -> None:
    scenario = find_scenario("suave")
    varied = experiment(
        tmp_path,
        "parameters:\n"
        "  water_visibility_sec_shift: {uniform: [0, 80]}\n"
        "  thruster_events: [[{integer: [1, 6]}, failure, {uniform: [20, 60]}], '(2,recovery,5)']\n"
        "  start: [-17, {normal: [1.95, 0.5]}]\n",
    )
    some = make_plan(scenario, read_managers("rosa", scenario), range(30), varied)
    thrusters = {run.request.parameters["thruster_events"][0][0] for run in some.runs}
    assert thrusters == {1, 2, 3, 4, 5, 6}
    for run in some.runs:
        assert 0 <= run.request.parameters["water_visibility_sec_shift"] <= 80
        assert 20 <= run.request.parameters["thruster_events"][0][2] <= 60
        assert run.request.parameters["start"][0] == -17
