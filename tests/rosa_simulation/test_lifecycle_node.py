"""Nodes of simulated robots: what is called takes effect a little later."""

from __future__ import annotations

import pytest

from rosa_core import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot_event import NodeChange


class Ticking(LifecycleNode):
    name = "ticking"

    def __init__(self, clock: SimulationClock) -> None:
        self.heard: list[tuple[float, NodeChange]] = []
        self.ticks: list[float] = []
        super().__init__(clock, 0.5, lambda node, change: self.heard.append((clock.now(), change)))
        self.parameters["rate"] = 1.0

    def on_activate(self) -> None:
        self.every(1.0, lambda: self.ticks.append(self.clock.now()))


@pytest.fixture
def node() -> Ticking:
    return Ticking(SimulationClock())


def test_it_works_from_its_activation_to_its_deactivation(node: Ticking) -> None:
    node.activate()
    assert not node.active
    node.clock.advance_to(3.0)
    node.deactivate()
    node.clock.advance_to(9.0)
    assert node.ticks == [1.5, 2.5, 3.5]
    assert node.heard == [(0.5, NodeChange.ACTIVATED), (3.5, NodeChange.DEACTIVATED)]


def test_a_second_activation_changes_nothing(node: Ticking) -> None:
    node.activate()
    node.activate()
    node.clock.advance_to(2.0)
    assert node.heard == [(0.5, NodeChange.ACTIVATED)]
    assert node.ticks == [1.5]


def test_parameters_are_checked_at_once_and_take_effect_later(node: Ticking) -> None:
    with pytest.raises(KeyError, match="no parameter 'rat'"):
        node.set_parameters({"rat": 1.0})
    with pytest.raises(TypeError, match="is a float"):
        node.set_parameters({"rate": "fast"})
    node.set_parameters({"rate": 2.0})
    assert node.parameters["rate"] == 1.0
    node.clock.advance_to(1.0)
    assert node.parameters["rate"] == 2.0
    assert node.heard == [(0.5, NodeChange.PARAMETERS)]
