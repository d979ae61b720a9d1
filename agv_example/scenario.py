"""The scenario ``agv``."""

from __future__ import annotations

from agv_example.events import AgvEvent
from agv_example.metrics import METRICS
from agv_example.missions import MISSION
from agv_example.parameters import PARAMETERS
from rosa_simulation.simulated_scenario import SimulatedScenario

AGV = SimulatedScenario(
    name="agv",
    description="cross a map of corridors; path and architecture are planned together, and again when needed",
    assemble="agv_example.assembly:assemble",
    configure="agv_example.parameters:requested_mission",
    files=MISSION,
    parameters=PARAMETERS,
    metrics=METRICS,
    waking=(
        AgvEvent.ARRIVED,
        AgvEvent.CORRIDOR_CLOSED,
        AgvEvent.CORRIDOR_OPENED,
        AgvEvent.LIGHT_CHANGED,
        AgvEvent.GOAL_REACHED,
        AgvEvent.TIME_LIMIT,
    ),
    columns=("x_m", "y_m", "light", "battery_level", "risk", "collisions"),
    spec="agv_example.report_spec:report_spec",
)
