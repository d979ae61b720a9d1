"""What runs leave behind: records, tables of the exemplar, logs of trees; and diagnostics of a running robot."""

from __future__ import annotations

import json
import shutil
import struct
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from rosa_cli.replay_command import replay
from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.mape import DiagnosticsMonitor
from rosa_core.model.elements import Component, Measure
from rosa_evaluation.exemplar_csv import read_missions, read_reactions
from rosa_evaluation.report.sources import RunSources
from rosa_simulation.run_reader import read_run
from rosa_simulation.scenario import RunRequest, SilentObserver
from task_layer.bt.groot.btlog import MAGIC, read_btlog
from tests.fuzz.harness import bounded_work, fuzzed, result_or_refusal
from tests.fuzz.mutations import ODD_VALUES, Change, changed_bytes, changed_document, changed_tokens, tokens_of
from tests.rosa_evaluation.campaign.scenarios import Walk

MISSIONS = """mission name,datetime,"initial pos (x,y)",mission duration (s),\
pipeline found,time searching pipeline (s),distance inspected (m),mean reaction time (s)
suave metacontrol,28-Nov-2022-14-03-21,"(-17.0, 2.0)",300,True,81,31.5,0.25
suave none,28-Nov-2022-14-13-21,"(-17.0, 2.0)",300,False,300,0,0.5
"""
REACTIONS = """mission_name,datetime,reaction time (s)
suave metacontrol,28-Nov-2022-14-03-21,0.25
suave none,28-Nov-2022-14-13-21,1.5
"""
CSV_WORDS = (
    ",",
    "\n",
    "\r",
    '"',
    "\0",
    ";",
    "300",
    "28-Nov-2022-14-03-21",
    "29-Feb-2023-99-00-00",
    "mission_name",
    "inf",
)


@pytest.fixture(scope="module")
def record(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("record") / "run"
    Walk().run(RunRequest("calm", "bt", 1), SilentObserver()).write(directory)
    return directory


@pytest.mark.parametrize("name", ["run.json", "wall_clock.json", "events.jsonl", "trajectory.csv"])
def test_run_records(name: str, record: Path, folder: Path) -> None:
    directory = folder / name
    shutil.copytree(record, directory)
    text = (record / name).read_text(encoding="utf-8")
    lines = [json.loads(line) for line in text.splitlines()] if name == "events.jsonl" else None
    document = json.loads(text) if name.endswith(".json") else lines
    tokens = tokens_of(text)[:400]

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        if document is None or changes[0].what % 3 == 0:
            altered = changed_tokens(tokens, changes, CSV_WORDS)
        else:
            result = changed_document(document, changes)
            several = result if lines is not None and isinstance(result, list) else [result]
            altered = "\n".join(json.dumps(_with_keys(item)) for item in several) + "\n"
        (directory / name).write_text(altered, "utf-8", "replace")
        result_or_refusal(lambda: read_run(directory))
        result_or_refusal(lambda: _report(directory))

    check()


def _with_keys(value: Any) -> Any:
    """The same with keys that JSON can have."""
    if isinstance(value, dict):
        return {str(key): _with_keys(item) for key, item in value.items()}
    return [_with_keys(item) for item in value] if isinstance(value, list) else value


def _report(path: Path) -> object:
    with RunSources() as sources:
        sources.add([path])
        return sources.studies()


def test_tables_of_the_exemplar(folder: Path) -> None:
    path = folder / "missions.csv"
    missions, reactions = tokens_of(MISSIONS), tokens_of(REACTIONS)
    for read, text in ((read_missions, MISSIONS), (read_reactions, REACTIONS)):
        path.write_text(text)
        assert len(read(path)) == 2

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        for read, tokens in ((read_missions, missions), (read_reactions, reactions)):
            text = changed_tokens(tokens, changes, CSV_WORDS).encode("utf-8", "replace")
            path.write_bytes(changed_bytes(text, changes[4:]))
            result_or_refusal(partial(read, path))

    check()


def test_logs_of_trees(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = folder / "tree.btlog"
    tree = b'<BehaviorTree ID="a"><Sequence _uid="1"><A _uid="2" name="b"/></Sequence></BehaviorTree>'
    xml = b'<root BTCPP_format="4">' + tree + b"</root>"
    transitions = b"".join(struct.pack("<IHHB", 1000 * number, 0, 1 + number % 2, number % 5) for number in range(6))
    data = MAGIC + b"\x01" + struct.pack("<I", len(xml)) + xml + struct.pack("<q", 10**15) + transitions
    path.write_bytes(data)
    assert len(read_btlog(path).transitions) == 6

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        path.write_bytes(changed_bytes(data, changes))
        result_or_refusal(lambda: replay(path, speed=None, as_json=changes[0].payload % 2 == 0))
        capsys.readouterr()

    check()


class _Raising:
    """Raises whatever is asked of it."""

    def __str__(self) -> str:
        raise RuntimeError("no text")

    def __iter__(self) -> Iterator[Any]:
        raise RuntimeError("no items")

    def __getattr__(self, name: str) -> Any:
        raise ZeroDivisionError(name)

    def __float__(self) -> float:
        raise MemoryError


class _Endless:
    def __iter__(self) -> Iterator[Any]:
        while True:
            yield {"key": "battery", "value": "0.5"}


def test_diagnostics_are_taken_or_rejected_value_by_value() -> None:
    def status(message: str, *values: tuple[Any, Any]) -> dict[str, Any]:
        return {"level": 0, "message": message, "values": [{"key": key, "value": value} for key, value in values]}

    array = {
        "header": {"stamp": {"sec": 3, "nanosec": 5}},
        "status": [
            status("QA status", ("battery", "0.5"), ("light", "2")),
            status("Component status", ("arm", "FALSE")),
        ],
    }
    model = KnowledgeModel(measures=(Measure("battery"), Measure("light")), components=(Component("arm"),))
    odd = (_Raising(), _Endless(), b"\xff", object(), 10**5000, *ODD_VALUES)

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        altered = changed_document(array, changes)
        if isinstance(altered, dict) and changes[0].what % 2:
            _put(altered, changes[0], odd)
        last = status("QA measurement", ("battery", 0.75))
        if isinstance(altered, dict) and isinstance(altered.get("status"), list):
            altered["status"].append(last)
        kb = KnowledgeBase(model, clock=SimulationClock(10.0))
        monitor = DiagnosticsMonitor(kb)
        with bounded_work():
            report = monitor.update(altered)
        assert monitor.rejected == len(report.rejected)
        assert all(len(reason) < 2000 for reason in report.rejected)
        monitor.update({"status": [last]})
        assert kb.measurement("battery") is not None

    check()


def _put(array: dict[str, Any], change: Change, odd: Sequence[Any]) -> None:
    """Put an odd object somewhere into an array."""
    several = array.get("status")
    if not isinstance(several, list) or not several or not isinstance(several[0], dict):
        array["status"] = change.pick(odd)
        return
    values = several[0].get("values")
    if isinstance(values, list) and values and isinstance(values[0], dict) and change.where % 3:
        values[0][("key", "value")[change.where % 2]] = change.pick(odd)
    else:
        several[0][("message", "values", "name")[change.where % 3]] = change.pick(odd)
