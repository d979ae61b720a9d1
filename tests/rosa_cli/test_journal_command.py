"""``rosa journal show|compact|export``."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from rosa_core import JournalOptions, KnowledgeBase, KnowledgeModel, Result, SimulationClock
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.elements import Component

MODEL = """
measures: {battery: {}}
actions: {explore: {requires: [move], constraints: [{measure: battery, value: 0.25}]}}
functions: {move: {}}
components: {wheels: {type: lifecycle_node}}
function_designs: {drive: {function: move, components: [wheels]}}
component_configurations: {fast: {component: wheels, parameters: {speed: 2.0}}}
"""


@pytest.fixture
def model(tmp_path: Path) -> KnowledgeModel:
    (tmp_path / "model.yaml").write_text(MODEL)
    return KnowledgeModel.load(tmp_path / "model.yaml")


@pytest.fixture
def journal(tmp_path: Path, model: KnowledgeModel) -> Path:
    path, clock = tmp_path / "kb", SimulationClock(149.0)
    with KnowledgeBase(model, clock, path, journal_options=JournalOptions(snapshot_every=2)) as kb:
        kb.request_action("explore", preference="battery")
        clock.advance_to(150.0)
        plan = ConfigurationPlanner(kb).plan()
        assert plan is not None
        with kb.transaction():
            kb.set_component_active("wheels", True)
            kb.set_reconfiguration_result(plan, Result.COMPLETED)
        kb.add_measurement("battery", 0.24)
        kb.set_component_failure("wheels")
        kb.finish_action("explore", "failed")
        kb.add_elements(Component("lamp"))
    return path


def rosa(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "rosa_cli.main", "journal", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_show_tells_each_write_in_a_line(journal: Path) -> None:
    done = rosa("show", journal)
    assert done.returncode == 0
    lines = done.stdout.splitlines()
    assert len(lines) == 7
    assert "149.000 s  explore requested with preference battery; " in lines[0]
    assert "drive selected; fast selected; plan 1 made (activate wheels; set fast)" in lines[1]
    assert "wheels active; plan 1 completed; fast applied; " in lines[2]
    assert "battery measured 0.24 at 150.000 s" in lines[3]
    assert "explore: solved -> unfeasible" in lines[3]
    assert "wheels failed at 150.000 s" in lines[4]
    assert "explore failed" in lines[5]
    assert "component 'lamp' added" in lines[6]
    assert rosa("show", journal, "--limit", 2).stdout.splitlines() == lines[-2:]


def test_export_prints_json_lines(journal: Path) -> None:
    done = rosa("export", journal)
    writes = [json.loads(line) for line in done.stdout.splitlines()]
    assert [write["revision"] for write in writes] == list(range(1, 8))
    assert writes[3]["facts"] == [{"fact": "measurement", "measure": "battery", "value": 0.24, "time": 150.0}]
    change = {"kind": "action", "name": "explore", "old": "solved", "new": "unfeasible"}
    assert change in writes[3]["statuses"]
    assert writes[6]["facts"][0]["added"] == {"components": [{"name": "lamp"}]}


def test_compact_keeps_what_is_asked_for(journal: Path, model: KnowledgeModel) -> None:
    done = rosa("compact", journal, "--keep-writes", 0)
    assert done.returncode == 0
    assert done.stdout.startswith("0 of 7 writes kept")
    assert rosa("compact", journal).stdout.startswith("0 of 0")
    assert rosa("show", journal).stdout == ""
    with KnowledgeBase(model, SimulationClock(150.0), journal) as kb:
        assert kb.revision == 7
        assert kb.measurement("battery").value == 0.24  # type: ignore[union-attr]


def test_a_journal_can_be_read_while_it_is_written_but_not_compacted(journal: Path, model: KnowledgeModel) -> None:
    with KnowledgeBase(model, SimulationClock(150.0), journal) as kb:
        kb.clear_component_failure("wheels")
        assert "wheels works again" in rosa("show", journal, "--limit", 1).stdout
        done = rosa("compact", journal)
    assert done.returncode == 2
    assert "in use" in done.stderr


@pytest.mark.parametrize("command", ["show", "export", "compact"])
def test_what_is_no_journal_is_bad_input(tmp_path: Path, command: str) -> None:
    for name, content in (("missing", None), ("text", "hello"), ("empty", ""), ("longer", "hello " * 1000)):
        file = tmp_path / name
        if content is not None:
            file.write_text(content)
        done = rosa(command, file)
        assert done.returncode == 2, (name, done)
        assert name in done.stderr
        assert "Traceback" not in done.stderr
        assert done.stdout == ""


def test_damage_ends_with_a_message(journal: Path) -> None:
    journal.write_bytes(journal.read_bytes().replace(b"0.24", b"0.42"))
    done = rosa("show", journal)
    assert done.returncode == 2
    assert "write 4 is altered" in done.stderr
    assert "Traceback" not in done.stderr
