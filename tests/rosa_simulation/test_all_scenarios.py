"""What every installed scenario does, whoever declared it."""

from __future__ import annotations

import dataclasses
import pickle
import pkgutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from rosa_core import InputError, KnowledgeBase
from rosa_evaluation.report import ReportSpec
from rosa_simulation.mission import Mission, TaskParts
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario, scenario_names
from rosa_simulation.simulated_scenario import SimulatedScenario
from rosa_simulation.simulation import Simulation
from task_layer.bt import Registry, TreeRunner
from task_layer.skill import Skill, SkillStatus
from tests.hang_limit import HANG_LIMIT

OURS = ("agv", "pioneer", "suave", "suave-extended", "uav")


def simulated(name: str) -> SimulatedScenario:
    scenario = find_scenario(name)
    assert isinstance(scenario, SimulatedScenario)
    return scenario


def run(scenario: SimulatedScenario, **request: Any) -> RunRecord:
    return scenario.run(RunRequest(**{"time_limit": 15.0, **request}), SilentObserver())


def managed() -> Iterator[tuple[str, str, str]]:
    """Every scenario with each of its managers and the task layers that go with it."""
    for name in OURS:
        yield from ((name, manager, "bt") for manager in simulated(name).managers)
        yield name, "rosa", "pddl"


@pytest.fixture(params=OURS)
def scenario(request: pytest.FixtureRequest) -> SimulatedScenario:
    return simulated(request.param)


def test_these_are_all_of_ours() -> None:
    assert set(OURS) <= set(scenario_names())


@pytest.mark.parametrize(("name", "manager", "task_layer"), list(managed()))
def test_every_manager_runs_with_every_task_layer_and_records_what_is_declared(
    name: str, manager: str, task_layer: str
) -> None:
    scenario = simulated(name)
    request = {"manager": manager, "task_layer": task_layer}
    record = run(scenario, **request)
    assert (record.scenario, record.manager, record.task_layer) == (name, manager, task_layer)
    assert record.completed
    assert record.duration_s == 15.0
    assert record.ended_by == "time limit"
    assert tuple(record.metrics) == tuple(metric.name for metric in scenario.metrics)
    assert record.trajectory_columns == ("time_s", *scenario.columns)
    assert {len(row) for row in record.trajectory} == {len(scenario.columns) + 1}
    assert bool(record.plans) == (task_layer == "pddl")
    again = run(scenario, **request)
    assert (again.events, again.trajectory, again.inputs) == (record.events, record.trajectory, record.inputs)


def tree(tmp_path: Path, leaf: str) -> Path:
    file = tmp_path / "mission.xml"
    file.write_text(f'<root BTCPP_format="4"><BehaviorTree ID="m">{leaf}</BehaviorTree></root>', encoding="utf-8")
    return file


@pytest.mark.parametrize(("leaf", "ended_by"), [("<AlwaysSuccess/>", "mission done"), ("<AlwaysFailure/>", "failed")])
def test_the_tree_that_is_given_is_performed_under_every_manager(
    scenario: SimulatedScenario, tmp_path: Path, leaf: str, ended_by: str
) -> None:
    for manager in set(scenario.managers) - set(scenario.tree_managers):
        record = run(scenario, manager=manager, mission=tree(tmp_path, leaf))
        assert record.duration_s == 0.0
        # A SUAVE mission begins when its tree sets the mode GUIDED.
        assert ended_by in record.ended_by or record.ended_by == "never in mode GUIDED"


def test_a_tree_may_name_all_leaves_of_the_scenario(scenario: SimulatedScenario, tmp_path: Path) -> None:
    leaves = scenario.mission_leaves()
    assert isinstance(leaves, Registry)
    assert scenario.takes_missions
    parts: list[TaskParts] = []

    def note(given: TaskParts) -> TaskParts:
        parts.append(given)
        return given

    run(changed(scenario, note), mission=tree(tmp_path, "<AlwaysSuccess/>"))
    assert {*parts[0].skills, *parts[0].own_skills, "IsActionFeasible"} <= set(leaves.names())


def test_a_tree_that_names_what_is_not_there_is_refused(scenario: SimulatedScenario, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"mission\.xml"):
        run(scenario, mission=tree(tmp_path, "<sing_a_song/>"))


class Raising(Skill):
    """A skill whose driver is broken."""

    def update(self) -> SkillStatus:
        raise OSError("no driver")


def changed(scenario: SimulatedScenario, change: Callable[[TaskParts], TaskParts]) -> SimulatedScenario:
    """The scenario with something else done by its task layer."""
    assemble = pkgutil.resolve_name(scenario.assemble) if isinstance(scenario.assemble, str) else scenario.assemble

    def assemble_changed(settings: Any, simulation: Simulation) -> Mission:
        mission = assemble(settings, simulation)

        def task_parts(kb: KnowledgeBase | None) -> TaskParts:
            return change(mission.task_parts(kb))

        return dataclasses.replace(mission, task_parts=task_parts)

    return dataclasses.replace(scenario, assemble=assemble_changed)


def broken(parts: TaskParts) -> TaskParts:
    plan_skills = None if parts.plan_skills is None else {name: Raising() for name in parts.plan_skills}
    return dataclasses.replace(parts, skills={name: Raising() for name in parts.skills}, plan_skills=plan_skills)


@pytest.mark.parametrize("task_layer", ["bt", "pddl"])
def test_what_raises_is_in_the_record_with_its_traceback(scenario: SimulatedScenario, task_layer: str) -> None:
    record = run(changed(scenario, broken), task_layer=task_layer)
    facts = [fact for event in record.events for fact in event.facts if fact["fact"] == "raised"]
    assert facts
    assert all(fact["error"] == "OSError: no driver" and "Traceback" in fact["traceback"] for fact in facts)
    assert any("raised OSError: no driver: it has failed" in event.text for event in record.events)


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        ({"manager": "rosy"}, "there is no manager 'rosy' for this scenario .did you mean 'rosa'"),
        ({"task_layer": "xml"}, "there are: bt, pddl"),
        ({"manager": "none", "task_layer": "pddl"}, "fly plans with --manager rosa"),
        ({"domain": Path("d.pddl")}, "add --task-layer pddl"),
        ({"task_layer": "pddl", "mission": Path("m.xml")}, "leave --task-layer pddl out"),
        ({"parameters": {"no_such_parameter": 1}}, "no parameter 'no_such_parameter'"),
    ],
)
def test_requests_that_cannot_be_run_are_refused(
    scenario: SimulatedScenario, request_: dict[str, Any], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        scenario.check(RunRequest(**request_))
    with pytest.raises(InputError, match=said):
        run(scenario, **request_)


def test_only_those_that_film_take_a_video(scenario: SimulatedScenario, tmp_path: Path) -> None:
    if scenario.films:
        with pytest.raises(InputError, match="video format"):
            run(scenario, video=tmp_path / "film.txt")
    else:
        with pytest.raises(InputError, match="cannot be filmed"):
            run(scenario, video=tmp_path / "film.mp4")


def test_a_report_knows_how_to_show_it(scenario: SimulatedScenario) -> None:
    assert isinstance(scenario.report_spec(), ReportSpec)


def test_it_is_pickled_by_its_name(scenario: SimulatedScenario) -> None:
    assert pickle.loads(pickle.dumps(scenario)) is scenario


@pytest.fixture
def plug_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str, str], None]:
    """Installs a manager for a scenario, as a package of its own would."""

    def install(group: str, value: str) -> None:
        info = tmp_path / "idle-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text("Metadata-Version: 2.1\nName: idle\nVersion: 1.0\n", encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[{group}]\nidle = {value}\n", encoding="utf-8")
        monkeypatch.syspath_prepend(tmp_path)

    return install


def idle(mission: Mission) -> TreeRunner:
    """A manager that performs the mission's tree, and never starts a component."""
    return mission.runner(mission.unguarded_tree(lambda action: mission.skills[action]))


def test_other_packages_bring_managers_for_every_scenario(
    scenario: SimulatedScenario, plug_in: Callable[[str, str], None]
) -> None:
    plug_in(f"rosa.{scenario.name.replace('-', '_')}_managers", f"{__name__}:idle")
    assert scenario.managers[-1] == "idle"
    record = run(scenario, manager="idle")
    assert record.manager == "idle"
    assert record.ended_by == "time limit"


def test_a_manager_that_cannot_be_imported_is_named_with_its_entry_point(
    scenario: SimulatedScenario, plug_in: Callable[[str, str], None]
) -> None:
    plug_in(f"rosa.{scenario.name.replace('-', '_')}_managers", "nowhere:idle")
    with pytest.raises(InputError, match="correct the entry point 'idle = nowhere:idle' of the group rosa"):
        run(scenario, manager="idle")


def test_our_managers_cannot_be_replaced(scenario: SimulatedScenario, tmp_path: Path) -> None:
    entries = simulated(scenario.name).managers
    assert len(set(entries)) == len(entries)
    assert entries[0] == "rosa"
    assert "none" in entries


def test_an_entry_point_that_names_no_scenario_is_refused(plug_in: Callable[[str, str], None]) -> None:
    plug_in("rosa.scenarios", "pathlib:Path")
    with pytest.raises(InputError, match=r"names no scenario: it has no description.*SimulatedScenario"):
        find_scenario("idle")


def test_an_entry_point_that_cannot_be_imported_is_refused(plug_in: Callable[[str, str], None]) -> None:
    plug_in("rosa.scenarios", "nowhere:SCENARIO")
    with pytest.raises(InputError, match="correct the entry point 'idle = nowhere:SCENARIO'"):
        find_scenario("idle")


def test_listing_the_scenarios_loads_no_simulator() -> None:
    listing = (
        "import sys; from rosa_simulation import find_scenario;"
        f"print([find_scenario(name).managers for name in {OURS}]);"
        "print({'mujoco', 'numpy', 'unified_planning'} & set(sys.modules))"
    )
    process = subprocess.run(
        [sys.executable, "-c", listing], capture_output=True, text=True, timeout=HANG_LIMIT, check=True
    )
    assert process.stdout.splitlines()[-1] == "set()"
