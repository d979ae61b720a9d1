"""The baseline: one managing tree, ticked at 10 Hz, over system modes."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from statistics import fmean
from xml.etree import ElementTree

import numpy as np
import pytest

from rosa_simulation.managers.managing_tree import BT_PERIOD, bt_manager, load_managing_tree
from rosa_simulation.managers.modes import mode_manager
from rosa_simulation.mission import Mission
from rosa_simulation.scenario import RunRequest
from rosa_simulation.simulation import Simulation
from rosa_simulation.system_modes import Situation
from suave import monitors
from suave.assembly import assemble
from suave.mission_config import MissionConfig
from suave.parameters import Settings
from suave.robot import SuaveRobot
from suave.world.parameters import WorldParameters
from task_layer.bt import TreeRunner
from tests.suave.flights import BIG_BATTERY, CLEAR_WATER, NO_FAILURE, events_with, fly

SERVICE_TIME = 0.003
SEARCH, FOLLOW = "f_generate_search_path_node", "f_follow_pipeline_node"
MAINTAIN, RECHARGE = "f_maintain_motion_node", "generate_recharge_path_node"


def mission_of(extended: bool, seed: int = 0) -> Mission:
    config = MissionConfig(thruster_events=())
    return assemble(Settings(config, WorldParameters(), extended), Simulation(RunRequest(seed=seed)))


class Managed:
    """A mission whose managing tree is ticked by hand, in a situation made by hand."""

    def __init__(self, extended: bool) -> None:
        self.mission = mission_of(extended)
        assert isinstance(self.mission.robot, SuaveRobot)
        self.robot = self.mission.robot
        self.situation = Situation()
        self.modes = mode_manager(self.mission)
        self.runner: TreeRunner = self.mission.runner(load_managing_tree(self.mission, self.situation, self.modes))
        while self.robot.guided_at is None:  # nodes with memory begin one child a tick
            self.tick()
        self.tick()

    def tick(self) -> set[str]:
        """Tick, let the nodes react, and say which are active."""
        self.runner.tick()
        clock = self.robot.clock
        clock.advance_to(clock.now() + 0.01)
        return {name for name, node in self.robot.nodes.items() if node.active}

    def see(self, visibility: float) -> None:
        self.situation.update(monitors.water_visibility(0.0, visibility))

    def charge(self, level: float) -> None:
        self.situation.update(monitors.battery_level(0.0, level))

    def thruster(self, number: int, works: bool) -> None:
        self.situation.update(monitors.thruster(0.0, number, works))


@pytest.fixture
def plain() -> Managed:
    return Managed(extended=False)


@pytest.fixture
def extended() -> Managed:
    return Managed(extended=True)


@pytest.mark.parametrize(("name", "extended", "count"), [("suave_bt", False, 37), ("suave_extended_bt", True, 50)])
def test_the_trees_have_as_many_nodes_as_the_papers(name: str, extended: bool, count: int) -> None:
    text = files("suave.managers").joinpath(f"{name}.xml").read_text("utf-8")
    (tree,) = ElementTree.fromstring(text).iter("BehaviorTree")
    assert sum(1 for _ in tree.iter()) - 1 == count
    mission = mission_of(extended)
    loaded = load_managing_tree(mission, Situation(), mode_manager(mission))
    assert sum(1 for _ in loaded.iterate()) == count


def test_every_mode_that_a_tree_changes_to_is_there(extended: Managed) -> None:
    text = files("suave.managers").joinpath("suave_extended_bt.xml").read_text("utf-8")
    for leaf in ElementTree.fromstring(text).iter("change_mode"):
        extended.modes.modes.check(leaf.attrib["node_name"], leaf.attrib["mode_name"])


def test_at_first_it_searches_at_the_highest_altitude(plain: Managed) -> None:
    assert plain.tick() == {SEARCH}
    assert plain.robot.search.altitude == 3.0


@pytest.mark.parametrize(("visibility", "altitude"), [(3.25, 3.0), (3.24, 2.0), (2.25, 2.0), (2.24, 1.0), (1.25, 1.0)])
def test_the_altitude_is_the_highest_that_the_visibility_allows(
    plain: Managed, visibility: float, altitude: float
) -> None:
    plain.see(visibility)
    plain.tick()
    assert plain.robot.search.altitude == altitude


def test_thrusters_are_recovered_while_one_has_failed(plain: Managed) -> None:
    plain.thruster(1, works=False)
    plain.thruster(4, works=False)
    assert plain.tick() == {SEARCH, MAINTAIN}
    plain.thruster(1, works=True)
    assert plain.tick() == {SEARCH, MAINTAIN}
    plain.thruster(4, works=True)
    assert plain.tick() == {SEARCH}


def test_once_the_pipeline_is_found_it_is_followed(plain: Managed) -> None:
    plain.robot.pipeline_found = True
    plain.tick()
    assert plain.tick() == {FOLLOW}


def test_with_a_low_battery_it_recharges_and_then_goes_on_where_it_was(extended: Managed) -> None:
    extended.robot.pipeline_found = True
    extended.tick()
    assert extended.tick() == {FOLLOW}
    extended.charge(0.25)
    assert extended.tick() == {FOLLOW}
    extended.charge(0.24)
    assert extended.tick() == {RECHARGE}
    extended.charge(0.9)
    assert extended.tick() == {RECHARGE}  # it goes on until the battery is recharged
    assert extended.robot.battery is not None
    extended.robot.battery.recharge(extended.robot.clock.now())
    extended.tick()
    assert extended.tick() == {FOLLOW}


def test_thrusters_are_recovered_while_recharging_too(extended: Managed) -> None:
    extended.charge(0.1)
    extended.thruster(2, works=False)
    assert extended.tick() == {RECHARGE, MAINTAIN}


def test_when_the_mission_is_over_nothing_stays_active(extended: Managed) -> None:
    extended.thruster(1, works=False)
    assert extended.tick() == {SEARCH, MAINTAIN}
    extended.robot.over = True
    assert extended.tick() == set()


def test_it_is_ticked_ten_times_a_second_at_a_phase_that_the_seed_decides() -> None:
    def tick_times(seed: int) -> list[float]:
        mission = mission_of(False, seed)
        times: list[float] = []
        with bt_manager(mission) as runner:
            runner.tree.add_pre_tick_handler(lambda _: times.append(mission.robot.clock.now()))
            runner.run(until=lambda: len(times) > 30)
        # What begins at once at the start is ticked at once.
        return [time for time in times if time > 0.0]

    times = tick_times(1)
    assert np.diff(times) == pytest.approx(BT_PERIOD)
    assert 0.0 < times[0] < BT_PERIOD
    assert times == tick_times(1) != tick_times(2)


@pytest.fixture(scope="module")
def delays(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[float]]:
    """Delays of the reactions to each uncertainty over ten extended missions."""
    found: dict[str, list[float]] = {"U1": [], "U2": [], "U3": []}
    for seed in range(10):
        record = fly(tmp_path_factory.mktemp("run"), manager="bt", seed=seed, time_limit=160)
        for name, reactions in record.reactions.items():
            found[name] += [reaction.delay_s for reaction in reactions]
    return found


@pytest.mark.parametrize("name", ["U1", "U2", "U3"])
def test_it_reacts_within_a_tick(delays: dict[str, list[float]], name: str) -> None:
    assert len(delays[name]) >= 10
    assert all(SERVICE_TIME <= delay <= BT_PERIOD + SERVICE_TIME + 1e-9 for delay in delays[name])
    assert fmean(delays[name]) == pytest.approx(BT_PERIOD / 2 + SERVICE_TIME, abs=0.03)


def test_rosa_reacts_sooner_than_it(delays: dict[str, list[float]], tmp_path: Path) -> None:
    record = fly(tmp_path, time_limit=160)
    for name, reactions in record.reactions.items():
        assert reactions
        # Simulated delays alone: computing takes microseconds, which differ from machine to machine.
        assert fmean(reaction.delay_s for reaction in reactions) < fmean(delays[name])


def test_nothing_goes_wrong_and_nothing_is_adapted(tmp_path: Path) -> None:
    record = fly(tmp_path, manager="bt", **CLEAR_WATER, **NO_FAILURE, **BIG_BATTERY)
    assert not any(record.reactions.values())
    assert record.metrics["pipeline_found"]


def test_it_flies_the_whole_mission(tmp_path: Path) -> None:
    record = fly(tmp_path, extended=False, manager="bt", **CLEAR_WATER, **NO_FAILURE, time_limit=900)
    assert record.ended_by == "pipeline inspected"
    assert events_with(record, f"{FOLLOW} activated")
