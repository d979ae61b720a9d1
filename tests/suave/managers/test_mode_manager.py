"""Putting parts into modes, by a port that writes down its calls."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from rosa_core.model.elements import ParameterValue
from suave.managers.modes import load_suave_modes
from suave.managers.system_modes import ModeManager, load_system_modes


class Port:
    """A managed system that writes calls down, and refuses those to the nodes in ``broken``."""

    def __init__(self) -> None:
        self.calls: list[str] = []
        self.broken: set[str] = set()

    def activate(self, component: str) -> bool:
        return self._call("activate", component)

    def deactivate(self, component: str) -> bool:
        return self._call("deactivate", component)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        return self._call(f"set {dict(parameters)}", component)

    def _call(self, what: str, component: str) -> bool:
        self.calls.append(f"{what} {component}")
        if component == "crashing":
            raise ConnectionError("gone")
        return component not in self.broken

    def since(self) -> list[str]:
        calls, self.calls = self.calls, []
        return calls


@pytest.fixture
def port() -> Port:
    return Port()


@pytest.fixture
def manager(port: Port) -> ModeManager:
    return ModeManager(load_suave_modes(extended=False), port)


SEARCH, SEARCH_NODE = "f_generate_search_path", "f_generate_search_path_node"


def test_a_node_gets_its_parameters_before_it_starts(manager: ModeManager, port: Port) -> None:
    assert manager.change_mode(SEARCH, "fd_spiral_high")
    assert port.since() == [f"set {{'spiral_altitude': 3.0}} {SEARCH_NODE}", f"activate {SEARCH_NODE}"]
    assert manager.mode(SEARCH) == manager.mode(SEARCH_NODE) == "fd_spiral_high"


def test_only_what_differs_is_changed(manager: ModeManager, port: Port) -> None:
    manager.change_mode(SEARCH, "fd_spiral_high")
    port.since()
    assert manager.change_mode(SEARCH, "fd_spiral_high")
    assert port.since() == []
    manager.change_mode(SEARCH, "fd_spiral_low")
    assert port.since() == [f"set {{'spiral_altitude': 1.0}} {SEARCH_NODE}"]
    manager.change_mode(SEARCH, "fd_unground")
    assert port.since() == [f"deactivate {SEARCH_NODE}"]
    manager.change_mode(SEARCH, "fd_spiral_low")
    assert port.since() == [f"activate {SEARCH_NODE}"]


def test_a_node_that_was_changed_by_itself_is_put_right_by_its_system(manager: ModeManager, port: Port) -> None:
    manager.change_mode(SEARCH, "fd_spiral_high")
    manager.change_mode(SEARCH_NODE, "fd_spiral_low")
    port.since()
    manager.change_mode(SEARCH, "fd_spiral_high")
    assert port.since() == [f"set {{'spiral_altitude': 3.0}} {SEARCH_NODE}"]


def test_what_failed_is_tried_again(manager: ModeManager, port: Port) -> None:
    port.broken = {SEARCH_NODE}
    assert not manager.change_mode(SEARCH, "fd_spiral_high")
    assert manager.mode(SEARCH) is None
    port.since()
    port.broken = set()
    assert manager.change_mode(SEARCH, "fd_spiral_high")
    assert len(port.since()) == 2


def test_an_unknown_part_or_mode_is_an_error_with_the_nearest_name(manager: ModeManager) -> None:
    with pytest.raises(LookupError, match="did you mean 'f_follow_pipeline"):
        manager.change_mode("f_folow_pipeline", "fd_unground")
    with pytest.raises(LookupError, match="'f_follow_pipeline' has no mode 'fd_spiral'; there are: __DEFAULT__"):
        manager.change_mode("f_follow_pipeline", "fd_spiral")
    assert manager.modes.modes("f_follow_pipeline") == ("__DEFAULT__", "fd_follow_pipeline", "fd_unground")


NESTED = """\
robot: {ros__parameters: {type: system, parts: [arm, crashing], modes: {
  __DEFAULT__: {arm: active, crashing: inactive},
  WORK: {arm: active.WORK},
  REST: {arm: inactive},
  RISK: {crashing: active, arm: inactive}}}}
arm: {ros__parameters: {type: system, parts: hand elbow, modes: {
  __DEFAULT__: {hand: inactive, elbow: active}, WORK: {hand: active, elbow: active.FAST}}}}
hand: {ros__parameters: {type: node, modes: {__DEFAULT__: {ros__parameters: {}}}}}
elbow: {ros__parameters: {type: node, modes: {
  __DEFAULT__: {ros__parameters: {speed: 1.0}}, FAST: {ros__parameters: {speed: 2.0}}}}}
crashing: {ros__parameters: {type: node, modes: {__DEFAULT__: {ros__parameters: {}}}}}
"""


@pytest.fixture
def nested(tmp_path: Path, port: Port) -> ModeManager:
    (tmp_path / "robot.yaml").write_text(NESTED, encoding="utf-8")
    return ModeManager(load_system_modes(tmp_path / "robot.yaml"), port)


def test_a_system_of_systems_puts_all_nodes_below_it_into_their_modes(nested: ModeManager, port: Port) -> None:
    assert nested.change_mode("robot", "WORK")
    assert port.since() == ["activate hand", "set {'speed': 2.0} elbow", "activate elbow"]
    assert nested.mode("arm") == "WORK"
    assert nested.change_mode("robot", "REST")
    assert port.since() == ["deactivate hand", "deactivate elbow"]
    assert nested.mode("arm") is None


def test_a_call_that_raises_has_failed_and_the_other_parts_are_seen_to(nested: ModeManager, port: Port) -> None:
    assert not nested.change_mode("robot", "RISK")
    assert port.since() == ["activate crashing", "deactivate hand", "deactivate elbow"]
