"""Units of systemd, by a stand-in for ``systemctl`` with real processes: no systemd runs where tests do."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, Status, WallClock
from rosa_core.mape import AdaptationLoop, ComponentState, InThreads
from rosa_processes import BlockingUnits, UnitEntry
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_processes.programs import SOON, Changes, kill
from tests.rosa_processes.test_faults import MODEL

STAND_IN = str(Path(__file__).with_name("systemctl_stand_in.py"))
ENTRIES = {
    "camera": UnitEntry(unit="camera.service", parameters={"file": "camera.env"}),
    "spare": UnitEntry(unit="spare.service", scope="system"),
}


@pytest.fixture
def units(tmp_path: Path) -> Iterator[BlockingUnits]:
    for entry in ENTRIES.values():
        (tmp_path / entry.unit).mkdir()
    system = BlockingUnits(
        ENTRIES, tmp_path, period=0.1, systemctl=[sys.executable, "-I", "-S", STAND_IN, str(tmp_path)]
    )
    yield system
    system.close()
    for entry in ENTRIES.values():
        pid = tmp_path / entry.unit / "pid"
        if pid.exists():
            with contextlib.suppress(ProcessLookupError):
                kill(int(pid.read_text()))


def test_a_unit_is_started_and_stopped(units: BlockingUnits, tmp_path: Path) -> None:
    assert units.state("camera") is ComponentState.INACTIVE
    assert units.activate("camera")
    assert units.state("camera") is ComponentState.ACTIVE
    assert units.deactivate("camera")
    assert units.state("camera") is ComponentState.INACTIVE
    assert units.activate("spare")
    assert (tmp_path / "calls").read_text().splitlines() == [
        "--user start camera.service",
        "--user stop camera.service",
        "--system start spare.service",
    ]


def test_one_that_refuses_and_one_that_is_not_there(units: BlockingUnits, tmp_path: Path) -> None:
    (tmp_path / "camera.service" / "refuses").touch()
    assert not units.activate("camera")
    assert units.state("camera") is ComponentState.INACTIVE
    (tmp_path / "spare.service").rmdir()
    assert not units.activate("spare")
    assert units.state("spare") is ComponentState.ABSENT


def test_that_its_process_has_been_killed_is_seen(units: BlockingUnits, tmp_path: Path) -> None:
    changes = Changes(units)  # type: ignore[arg-type]
    units.activate("camera")
    kill(int((tmp_path / "camera.service" / "pid").read_text()))
    changes.become("camera", ComponentState.INACTIVE)


def test_parameters_are_lines_of_a_file_and_a_running_unit_is_restarted(units: BlockingUnits, tmp_path: Path) -> None:
    assert units.set_parameters("camera", {"rate": 10, "place": 'at "home"'})
    assert (tmp_path / "camera.env").read_text() == 'rate="10"\nplace="at \\"home\\""\n'
    units.activate("camera")
    assert units.set_parameters("camera", {"rate": 10})
    assert units.set_parameters("camera", {"rate": 5})
    assert (tmp_path / "calls").read_text().splitlines()[1:] == ["--user restart camera.service"]
    with pytest.raises(ValueError, match="cannot be written"):
        units.set_parameters("camera", {"rate": "1\n2"})
    with pytest.raises(ValueError, match="not declared"):
        units.set_parameters("spare", {"rate": 1})


def test_when_systemd_does_not_answer_nothing_is_known(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    units = BlockingUnits(ENTRIES, tmp_path, systemctl=["false"])
    assert units.state("camera") is ComponentState.UNKNOWN
    units.close()
    assert "how units are is not known" in caplog.text


def test_the_loop_over_units(units: BlockingUnits, tmp_path: Path) -> None:
    system = InThreads(units)
    so = threading.Condition()

    def notify(_: object) -> None:
        with so:
            so.notify_all()

    def runs_alone(name: str, other: str) -> bool:
        return kb.is_component_active(name) and not kb.is_component_active(other)

    with (
        KnowledgeBase(knowledge_model(MODEL), WallClock(), dispatch="threads") as kb,
        AdaptationLoop(kb, system) as loop,
    ):
        assert loop.watch is not None
        threading.Thread(target=loop.watch.run, daemon=True).start()
        kb.subscribe(notify)
        kb.request_action("watch")
        with so:
            assert so.wait_for(lambda: runs_alone("camera", "spare"), SOON)
        kill(int((tmp_path / "camera.service" / "pid").read_text()))
        with so:
            assert so.wait_for(lambda: runs_alone("spare", "camera"), SOON)
        assert kb.status("component", "camera") is Status.FAILURE
    assert units.state("spare") is ComponentState.ACTIVE
