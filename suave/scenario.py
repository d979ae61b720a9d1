"""The scenarios ``suave`` and ``suave-extended``."""

from __future__ import annotations

from rosa_simulation.simulated_scenario import SimulatedScenario
from suave.events import SuaveEvent
from suave.metrics import METRICS
from suave.missions import EXTENDED_MISSION, PLAIN_MISSION
from suave.parameters import PARAMETERS

_COLUMNS = ("x_m", "y_m", "z_m", "yaw_rad", "visibility_m", "battery_level")
_WAKING = (SuaveEvent.PIPELINE_FOUND, SuaveEvent.PIPELINE_INSPECTED, SuaveEvent.RECHARGED, SuaveEvent.TIME_LIMIT)
_MANAGING_TREE = "rosa_simulation.managers.managing_tree:bt_manager"

SUAVE = SimulatedScenario(
    name="suave",
    description="search for a pipeline and inspect it, with failing thrusters and murky water",
    assemble="suave.assembly:assemble",
    configure="suave.parameters:plain_settings",
    files=PLAIN_MISSION,
    parameters=PARAMETERS,
    metrics=METRICS,
    own_managers={
        "bt": _MANAGING_TREE,
        "metacontrol": "rosa_simulation.managers.metacontrol:metacontrol_manager",
        "random": "rosa_simulation.managers.random_modes:random_manager",
    },
    tree_managers=("bt",),
    waking=_WAKING,
    columns=_COLUMNS,
    film="suave.film:prepare_film",
    spec="suave.report_spec:plain_report",
)
SUAVE_EXTENDED = SimulatedScenario(
    name="suave-extended",
    description="the same with a battery that runs low and must be recharged",
    assemble="suave.assembly:assemble",
    configure="suave.parameters:extended_settings",
    files=EXTENDED_MISSION,
    parameters=PARAMETERS,
    metrics=METRICS,
    own_managers={"bt": _MANAGING_TREE},
    tree_managers=("bt",),
    waking=_WAKING,
    columns=_COLUMNS,
    film="suave.film:prepare_film",
    spec="suave.report_spec:extended_report",
)
