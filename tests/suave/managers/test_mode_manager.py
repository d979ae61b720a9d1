"""Putting parts into modes, by a port that writes down its calls."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core.model.elements import ParameterValue
from rosa_simulation.system_modes import ModeManager, NodePart, PartState, SystemModes, SystemPart, load_system_modes
from tests.suave.flights import suave_modes


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
    return ModeManager(suave_modes(extended=False), port)


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


class Robot:
    """A managed system whose nodes are in a state; calls to broken ones fail."""

    def __init__(self) -> None:
        self.active: dict[str, bool] = {}
        self.parameters: dict[str, dict[str, ParameterValue]] = {}
        self.broken: set[str] = set()

    def activate(self, component: str) -> bool:
        return self._switch(component, True)

    def deactivate(self, component: str) -> bool:
        return self._switch(component, False)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        if component not in self.broken:
            self.parameters.setdefault(component, {}).update(parameters)
        return component not in self.broken

    def _switch(self, component: str, active: bool) -> bool:
        if component not in self.broken:
            self.active[component] = active
        return component not in self.broken

    def is_in(self, modes: SystemModes, name: str, state: PartState) -> bool:
        """Whether a part really is in a state, as the modes define it."""
        part = modes.part(name)
        if isinstance(part, SystemPart):
            if not state.active:
                return all(self.is_in(modes, member, PartState(False)) for member in part.parts)
            return all(self.is_in(modes, member, wanted) for member, wanted in part.modes[state.mode].items())
        if not state.active:
            return self.active.get(name) is False
        return self.active.get(name) is True and self.has_parameters(part, state.mode)

    def has_parameters(self, node: NodePart, mode: str) -> bool:
        return self.parameters.get(node.name, {}).items() >= node.modes[mode].items()


SHARED = """\
all: {ros__parameters: {type: system, parts: [one, two], modes: {
  __DEFAULT__: {one: active, two: inactive}, A: {one: active.A, two: active.A}, B: {two: active}}}}
one: {ros__parameters: {type: system, parts: [m, n], modes: {
  __DEFAULT__: {m: inactive, n: inactive}, A: {m: active.F, n: active}, B: {m: active}}}}
two: {ros__parameters: {type: system, parts: [n], modes: {__DEFAULT__: {n: active}, A: {n: active.F}}}}
m: {ros__parameters: {type: node, modes: {
  __DEFAULT__: {ros__parameters: {v: 1}}, F: {ros__parameters: {v: 2}}}}}
n: {ros__parameters: {type: node, modes: {
  __DEFAULT__: {ros__parameters: {v: 1, w: a}}, F: {ros__parameters: {v: 2, w: b}}}}}
"""
CHANGES = [("all", mode) for mode in ("__DEFAULT__", "A", "B")] + [("one", mode) for mode in ("__DEFAULT__", "A", "B")]
CHANGES += [(name, mode) for name, mode in (("two", "A"), ("two", "__DEFAULT__"), ("m", "F"), ("n", "F"))]


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> SystemModes:
    """Systems that share a node and contain one another, in the ways that a file may say."""
    file = tmp_path_factory.mktemp("modes") / "shared.yaml"
    # A mode that contradicts itself is nobody's to put right: the two systems want the same of their node in A.
    file.write_text(SHARED.replace("A: {m: active.F, n: active}", "A: {m: active.F, n: active.F}"), encoding="utf-8")
    return load_system_modes(file)


@given(st.lists(st.tuples(st.sampled_from(CHANGES), st.sets(st.sampled_from("mn")))))
def test_a_change_that_was_successful_leaves_the_robot_in_that_mode_whatever_went_before(
    shared: SystemModes, changes: list[tuple[tuple[str, str], set[str]]]
) -> None:
    robot = Robot()
    manager = ModeManager(shared, robot)
    for (name, mode), broken in changes:
        robot.broken = broken
        done = manager.change_mode(name, mode)
        part = shared.part(name)
        if isinstance(part, NodePart):
            assert robot.has_parameters(part, mode) or not done
            continue
        contradicts = (name, mode) == ("all", "__DEFAULT__")  # n is part of both
        assert not done or contradicts or robot.is_in(shared, name, PartState(True, mode))
        assert done or broken
