"""What every simulated robot shares: scenarios, missions, managers, nodes, run records."""

from rosa_simulation.metric import Better, Metric, MetricKind
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import (
    MissionFiles,
    Parameter,
    RunRequest,
    Scenario,
    SilentObserver,
    find_scenario,
    scenario_names,
)
from rosa_simulation.simulated_scenario import SimulatedScenario

__all__ = [
    "Better",
    "Metric",
    "MetricKind",
    "MissionFiles",
    "Parameter",
    "RunRecord",
    "RunRequest",
    "Scenario",
    "SilentObserver",
    "SimulatedScenario",
    "find_scenario",
    "scenario_names",
]
