"""Reflexes of other robots: the AGV's bumper, and the underwater robot's distance to the sea bed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rosa_core import SimulationClock
from rosa_reflexes import GateEvent, HandedBack, Preempted
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from suave.sea_bed_reflex import SeaBedReflex
from suave.world.environment import SEA_BED
from suave.world.parameters import WorldParameters
from suave.world.vehicle import Vehicle


def run(scenario: str, **parameters: Any) -> RunRecord:
    return find_scenario(scenario).run(RunRequest(seed=3, parameters=parameters, time_limit=120.0), SilentObserver())


@pytest.mark.parametrize("guarded", [True, False])
def test_the_vehicle_keeps_clear_of_the_sea_bed_whatever_setpoint_it_gets(guarded: bool) -> None:
    clock, events = SimulationClock(), list[GateEvent]()
    vehicle = Vehicle(WorldParameters(start_spread=0.0, noise_vertical=0.0), np.random.default_rng(0))
    if guarded:
        SeaBedReflex(vehicle, clock, events.append)
    vehicle.target = (-17.0, 2.0, SEA_BED - 1.0)
    least = 10.0
    for _ in range(600):
        clock.advance_to(clock.now() + 0.1)
        vehicle.step()
        least = min(least, vehicle.position[2] - SEA_BED)
    assert (least > 0.1) == guarded
    kinds = [type(event) for event in events if isinstance(event, Preempted | HandedBack)]
    assert kinds[:3] == ([Preempted, HandedBack, Preempted] if guarded else [])


@pytest.mark.parametrize("scenario", ["agv", "suave"])
def test_reflexes_are_off_unless_they_are_asked_for(scenario: str) -> None:
    plain, off, on = run(scenario), run(scenario, reflexes=False), run(scenario, reflexes=True)
    assert (plain.events, plain.trajectory, plain.inputs) == (off.events, off.trajectory, off.inputs)
    assert "reflexes" not in plain.inputs
    assert on.inputs["reflexes"] is True


def test_the_agv_stands_still_for_two_seconds_after_a_collision() -> None:
    scenario = find_scenario("agv")
    for seed in range(200):
        record = scenario.run(RunRequest(seed=seed, parameters={"reflexes": True}), SilentObserver())
        facts = [fact for event in record.events for fact in event.facts]
        if any(fact["fact"] == "collision" for fact in facts):
            break
    assert any(fact["fact"] == "preempted" and fact["reflex"] == "bumper" for fact in facts)
    held = [fact["held_s"] for fact in facts if fact["fact"] == "handed back"]
    assert held == pytest.approx([2.0] * len(held), abs=0.11)
