"""``rosa run --manager``: which are offered for which mission."""

from __future__ import annotations

import json

import pytest

from tests.rosa_cli.cli import refused, rosa


@pytest.mark.parametrize("manager", ["none", "random", "bt", "metacontrol", "rosa"])
def test_all_managers_fly_the_plain_mission(manager: str) -> None:
    process = rosa("run", "suave", "-q", "--json", "--time-limit", "40", "--manager", manager)
    assert process.returncode == 0, process.stderr
    document = json.loads(process.stdout)
    assert document["manager"] == manager
    assert document["completed"] is True
    adapts = manager in ("bt", "metacontrol", "rosa")
    assert bool(document["reaction_times"]["U1"]) is adapts


@pytest.mark.parametrize("manager", ["none", "bt", "rosa"])
def test_those_that_can_recharge_and_the_floor_fly_the_extended_one(manager: str) -> None:
    process = rosa("run", "suave-extended", "-q", "--json", "--time-limit", "160", "--manager", manager)
    assert process.returncode == 0, process.stderr
    assert bool(json.loads(process.stdout)["reaction_times"]["U3"]) is (manager != "none")


@pytest.mark.parametrize("manager", ["random", "metacontrol"])
def test_those_that_cannot_are_refused_there(manager: str) -> None:
    said = refused(rosa("run", "suave-extended", "--manager", manager))
    assert f"there is no manager '{manager}' for this scenario" in said
    assert "rosa, bt, none" in said
