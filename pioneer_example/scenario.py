"""The scenario ``pioneer``."""

from __future__ import annotations

from pioneer_example.events import PioneerEvent
from pioneer_example.metrics import METRICS
from pioneer_example.missions import MISSION
from pioneer_example.parameters import PARAMETERS
from rosa_simulation.simulated_scenario import SimulatedScenario

PIONEER = SimulatedScenario(
    name="pioneer",
    description="drive to the origin past obstacles that the planner does not know; reflexes take the command",
    assemble="pioneer_example.assembly:assemble",
    files=MISSION,
    parameters=PARAMETERS,
    metrics=METRICS,
    own_managers={
        name: f"pioneer_example.managers:{name}_manager" for name in ("gate", "rocs", "deliberative", "reactive")
    },
    tree_managers=("gate", "rocs", "deliberative", "reactive"),
    waking=(PioneerEvent.ORIGIN_REACHED, PioneerEvent.TIME_LIMIT),
    columns=(
        "x_m",
        "y_m",
        "heading_rad",
        "reactive",
        "clearance_m",
        "actions",
        "explorer_x_m",
        "explorer_y_m",
        "explorer_heading_rad",
    ),
    film="pioneer_example.film:prepare_film",
    spec="pioneer_example.report_spec:report_spec",
)
