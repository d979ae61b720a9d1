"""The robot that most tests are about, a pretended managed system, and ways to look at a whole knowledge base."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.kb import Event
from rosa_core.model.elements import ParameterValue
from rosa_core.model.records import TOPICS

KINDS = ("action", "function", "component", "function_design", "component_configuration")

DRONE = """
measures:
  battery: {kind: quality}
  wind: {kind: environmental}
  light: {kind: environmental}
actions:
  deliver:
    requires: [fly, see]
    constraints: [{measure: battery, operator: ">=", value: 0.25}]
  hover: {requires: [fly]}
  wait: {}
functions:
  fly: {}
  see: {always_improve: true}
components:
  rotors: {}
  autopilot: {type: lifecycle_node, package: drone, executable: autopilot}
  damper: {type: ros_node, package: drone, executable: damper}
  camera: {type: lifecycle_node, package: drone, executable: camera, always_improve: true}
  lidar: {type: lifecycle_node, package: drone, executable: lidar}
  beacon: {type: lifecycle_node, package: drone, executable: beacon}
function_designs:
  fly fast:
    function: fly
    components: [rotors, autopilot]
    priority: 1
    constraints: [{measure: wind, operator: "<", value: 8}]
  fly gently: {function: fly, components: [rotors, autopilot, damper], priority: 2}
  see by camera: {function: see, components: [camera], priority: 1}
  see by lidar: {function: see, components: [lidar], priority: 2}
component_configurations:
  sharp:
    component: camera
    parameters: {exposure: 0.01}
    priority: 1
    constraints: [{measure: light, value: 50}]
  grainy:
    component: camera
    parameters: {exposure: 0.1, gain: 8}
    priority: 2
    constraints: [{measure: light, value: 5}]
"""
"""A drone that delivers parcels. The two designs to fly share rotors and autopilot; no design needs the beacon."""


@cache
def knowledge_model(text: str) -> KnowledgeModel:
    """The model that a YAML text states."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "model.yaml"
        file.write_text(text, encoding="utf-8")
        return KnowledgeModel.load(file)


class PretendedRobot:
    """A managed system that remembers its calls; on ``broken`` components they raise, on ``deaf`` ones say no."""

    def __init__(self, broken: tuple[str, ...] = (), deaf: tuple[str, ...] = ()) -> None:
        self.calls: list[tuple[Any, ...]] = []
        self.running: set[str] = set()
        self.parameters: dict[str, dict[str, ParameterValue]] = {}
        self.broken = set(broken)
        self.deaf = set(deaf)
        self.during_call: Callable[[tuple[Any, ...]], None] = lambda call: None

    def activate(self, component: str) -> bool | None:
        return self._call("activate", component, then=lambda: self.running.add(component))

    def deactivate(self, component: str) -> bool | None:
        return self._call("deactivate", component, then=lambda: self.running.discard(component))

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool | None:
        given = dict(parameters)
        return self._call("set_parameters", component, given, then=lambda: self.parameters.update({component: given}))

    def _call(self, *call: Any, then: Callable[[], object]) -> bool | None:
        self.calls.append(call)
        self.during_call(call)
        if call[1] in self.broken:
            raise OSError(f"{call[1]} does not answer")
        if call[1] in self.deaf:
            return False
        then()
        return None


def heard(kb: KnowledgeBase, *event_types: type[Event]) -> list[Event]:
    """A list that every event from now on, or every one of these types, is appended to."""
    events: list[Event] = []
    kb.subscribe(events.append, event_types or None)
    return events


def snapshot(kb: KnowledgeBase) -> dict[str, Any]:
    """Everything that the knowledge base answers about its state."""
    model = kb.model
    return {
        "revision": kb.revision,
        "statuses": {kind: kb.statuses(kind) for kind in KINDS},
        "constraints": kb.constraints(),
        "measurements": {measure.name: kb.measurement(measure.name) for measure in model.measures},
        "required": kb.required_actions(),
        "designs": {f.name: kb.selected_function_design(f.name) for f in model.functions},
        "configurations": {c.name: kb.selected_component_configuration(c.name) for c in model.components},
        "active": {c.name: kb.is_component_active(c.name) for c in model.components},
        "selectable": kb.selectable_actions(),
        "adaptable functions": kb.adaptable_functions(),
        "adaptable components": kb.adaptable_components(),
        "pending plan": kb.pending_reconfiguration_plan(),
        "explanations": [str(kb.explain(kind, name)) for kind in KINDS for name in kb.statuses(kind)],
        "history": {topic: kb.history(topic) for topic in TOPICS},
    }
