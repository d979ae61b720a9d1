"""How many Python functions are called: ``python benchmarks/count_calls.py``.

A count is the same on every machine and however busy it is. Counted are the calls (``sys.setprofile``) from a
diagnostic array to the last event delivered, in SUAVE extended with the adaptation loop and a robot in which everything
works, and how often a default mission plans.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.mape import AdaptationLoop, ConfigurationPlanner
from rosa_core.mape.diagnostics import diagnostic
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from suave.models import model_files


class ObedientSystem:
    """A managed system in which everything works."""

    def activate(self, component: str) -> None:
        """Nothing to do."""

    def deactivate(self, component: str) -> None:
        """Nothing to do."""

    def set_parameters(self, component: str, parameters: object) -> None:
        """Nothing to do."""


def python_calls(work: Callable[[], object]) -> int:
    """How many Python functions ``work`` calls, itself not counted; a generator counts each time it is resumed."""
    count = 0

    def profile(_frame: FrameType, event: str, _argument: Any) -> None:
        nonlocal count
        count += event == "call"

    sys.setprofile(profile)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count - 1


def plannings(work: Callable[[], object]) -> int:
    """How often a configuration planner plans meanwhile."""
    count = 0
    plan = ConfigurationPlanner.plan

    def counted(planner: ConfigurationPlanner) -> object:
        nonlocal count
        count += 1
        return plan(planner)

    ConfigurationPlanner.plan = counted  # type: ignore[method-assign, assignment]
    try:
        work()
    finally:
        ConfigurationPlanner.plan = plan  # type: ignore[method-assign]
    return count


def searching_robot() -> tuple[KnowledgeBase, AdaptationLoop]:
    """SUAVE extended, searching for its pipeline in clear water with a full battery."""
    kb = KnowledgeBase(KnowledgeModel.load(*model_files(extended=True)), SimulationClock())
    loop = AdaptationLoop(kb, ObedientSystem())
    kb.add_measurement("water_visibility", 4.0)
    kb.add_measurement("battery_level", 0.9)
    kb.request_action("search_pipeline")
    return kb, loop


def calls_for(message: str, key: str, value: str) -> int:
    """The calls for one diagnostic array with one value, once everything that is kept for the next time is there."""
    array = diagnostic(1.0, "monitor", message, key, value)
    calls = 0
    for _ in range(2):
        kb, loop = searching_robot()
        with kb, loop:
            calls = python_calls(lambda update=loop.monitor.update: update(array))  # type: ignore[misc]
    return calls


def calls_for_a_write() -> int:
    """The calls for a measurement that changes no status, written without a diagnostic array."""
    kb, loop = searching_robot()
    with kb, loop:
        return python_calls(lambda: kb.add_measurement("battery_level", 0.89))


def main() -> None:
    """Print the table."""
    scenario = find_scenario("suave-extended")
    rows = {
        "calls for a measurement that changes no status": calls_for("QA measurement", "battery_level", "0.89"),
        "of them kb.add_measurement and what follows": calls_for_a_write(),
        "calls for a measurement that makes another configuration the best": calls_for(
            "EA measurement", "water_visibility", "2.5"
        ),
        "calls for a thruster failure, to the executed plan": calls_for("Component status", "c_thruster_1", "FALSE"),
        "plannings in a default suave-extended mission": plannings(
            lambda: scenario.run(RunRequest(manager="rosa"), SilentObserver())
        ),
    }
    for what, count in rows.items():
        print(f"{what:68}{count:8}")


if __name__ == "__main__":
    main()
