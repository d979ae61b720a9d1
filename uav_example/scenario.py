"""The scenario ``uav``."""

from __future__ import annotations

from rosa_simulation.simulated_scenario import SimulatedScenario
from uav_example.events import UavEvent
from uav_example.metrics import METRICS
from uav_example.missions import MISSION
from uav_example.parameters import PARAMETERS

UAV = SimulatedScenario(
    name="uav",
    description="search an area for samples and analyse them, also when the gripper fails",
    assemble="uav_example.assembly:assemble",
    configure="uav_example.parameters:world_parameters",
    files=MISSION,
    parameters=PARAMETERS,
    metrics=METRICS,
    waking=(
        UavEvent.SAMPLE_FOUND,
        UavEvent.SAMPLE_ANALYSED,
        UavEvent.AREA_SEARCHED,
        UavEvent.GRIPPER_FOLDED,
        UavEvent.CHARGED,
        UavEvent.BATTERY_EMPTY,
        UavEvent.TIME_LIMIT,
    ),
    columns=("x_m", "y_m", "z_m", "battery_level"),
    spec="uav_example.report_spec:report_spec",
)
