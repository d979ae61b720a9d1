"""Trees are shown, watched, served, logged and replayed as a user does it, in real processes."""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import time
from pathlib import Path
from xml.etree import ElementTree as ET

import py_trees
import pytest

from rosa_cli.watching import Watching
from rosa_core import InputError, SimulationClock
from task_layer.bt.groot import BtLogWriter
from tests.rosa_cli.cli import refused, rosa
from tests.task_layer.groot.asking import asking, free_port

MISSION = """<root BTCPP_format="4">
  <BehaviorTree ID="Mission">
    <Sequence name="all"><look_around far="true"/><SubTree ID="Home"/></Sequence>
  </BehaviorTree>
  <BehaviorTree ID="Home"><go_home/></BehaviorTree>
</root>
"""


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    path = tmp_path / "mission.xml"
    path.write_text(MISSION.replace("<root ", '<root main_tree_to_execute="Mission" '), encoding="utf-8")
    return path


def test_a_mission_with_unknown_leaves_is_printed(mission: Path) -> None:
    process = rosa("tree", mission)
    assert process.returncode == 0
    assert process.stdout.splitlines() == [
        '{-} Sequence "all"',
        "    --> look_around far=true",
        "    -^- Home",
        "        --> go_home",
    ]


def test_a_mission_is_printed_for_graphviz(mission: Path) -> None:
    process = rosa("tree", mission, "--dot")
    assert process.stdout.startswith("digraph")
    assert '"look_around far=true"' in process.stdout


def test_a_mission_is_drawn(mission: Path, tmp_path: Path) -> None:
    process = rosa("tree", mission, "--svg", tmp_path / "mission.svg")
    assert (process.returncode, process.stdout) == (0, "")
    assert "drawn in" in process.stderr
    texts = [text.text for text in ET.parse(tmp_path / "mission.svg").iter("{http://www.w3.org/2000/svg}text")]
    assert {"Sequence", '"all"', "look_around", "far=true", "Home", "go_home"} == set(texts)


def test_a_mission_that_cannot_be_run_is_shown_and_what_is_wrong_is_said(tmp_path: Path) -> None:
    path = tmp_path / "mission.xml"
    path.write_text(
        '<root><include path="gone.xml"/><BehaviorTree ID="A"><SubTree ID="B"/></BehaviorTree></root>', encoding="utf-8"
    )
    process = rosa("tree", path)
    assert process.returncode == 0
    assert process.stdout == "--> B\n"
    assert re.search(r"mission.xml:1: 'gone.xml': cannot read it", process.stderr)


def test_what_is_no_mission_is_refused(mission: Path, tmp_path: Path) -> None:
    (tmp_path / "bad.xml").write_text("<root>\n<", encoding="utf-8")
    assert "bad.xml:2: not valid XML" in refused(rosa("tree", tmp_path / "bad.xml"))
    assert "give one of them" in refused(rosa("tree", mission, "--dot", "--svg", tmp_path / "a.svg"))


def test_a_run_is_logged_and_replayed(tmp_path: Path) -> None:
    log = tmp_path / "run.btlog"
    assert rosa("run", "suave-extended", "-q", "--btlog", log).returncode == 0
    printed = rosa("replay", log).stdout.splitlines()
    assert re.fullmatch(r" *0\.000000 s  RetryUntilSuccessful .* IDLE -> RUNNING", printed[0])
    document = json.loads(rosa("replay", log, "--json").stdout)
    changes = document["transitions"]
    assert len(changes) == len(printed)
    before: dict[int, str] = {}
    for change in changes:
        assert change["old"] == before.get(change["uid"], "IDLE") != change["new"]
        before[change["uid"]] = change["new"]
    assert set(before.values()) == {"IDLE"}  # the run ends with a halt
    times = [change["time_s"] for change in changes]
    assert times == sorted(times)
    assert times[-1] == pytest.approx(300.0, abs=1.0)
    assert "recharge" in {change["name"] for change in changes if change["new"] == "SUCCESS"}


def test_the_same_run_gives_the_same_log(tmp_path: Path) -> None:
    logs = [tmp_path / "one.btlog", tmp_path / "two.btlog"]
    for log in logs:
        rosa("run", "suave", "-q", "--time-limit", "30", "--btlog", log)
    assert logs[0].read_bytes() == logs[1].read_bytes()


def test_a_replay_can_take_its_time(tmp_path: Path) -> None:
    log = tmp_path / "short.btlog"
    clock, root = SimulationClock(), py_trees.behaviours.Running("run")
    with BtLogWriter(log, root, clock):
        clock.advance_to(20.0)
        root.tick_once()
    began = time.monotonic()
    assert rosa("replay", log, "--speed", "20").returncode == 0
    assert time.monotonic() - began >= 1.0


def test_what_is_no_log_is_refused(mission: Path, tmp_path: Path) -> None:
    assert "not a log of a behaviour tree" in refused(rosa("replay", mission))
    xml = b"<root><"
    (tmp_path / "odd.btlog").write_bytes(b"BTCPP4-FileLogger2\x01" + struct.pack("<i", len(xml)) + xml + bytes(8))
    assert "the tree in the log cannot be read" in refused(rosa("replay", tmp_path / "odd.btlog"))


def test_groot_can_watch_a_run() -> None:
    port = free_port()
    command = [sys.executable, "-m", "rosa_cli.main", "run", "suave", "-q", "--speed", "40", "--groot", str(port)]
    with subprocess.Popen([*command, "--time-limit", "60"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        with asking(port) as groot:
            xml = ET.fromstring(groot.ask("T")[1])
            uids = {int(element.get("_uid", "0")) for element in xml.find("BehaviorTree").iter() if element.get("_uid")}
            seen = []
            for _ in range(10):
                seen.append(groot.statuses())
                time.sleep(0.02)
        assert all(set(statuses) == uids for statuses in seen)
        assert seen[-1][1] == 1
        _, errors = process.communicate(timeout=60)
    assert (process.returncode, errors) == (0, b"")


BAD = {
    "no terminal": (["--watch"], "--watch needs a terminal.*rosa replay"),
    "no such address": (["--groot", "1.2.3.4:1667", "-q"], "cannot listen at 1.2.3.4:1667"),
    "a log nowhere": (["--btlog", "nowhere/a.btlog", "-q"], "nowhere/a.btlog: cannot write the log"),
}


@pytest.mark.parametrize(("options", "said"), BAD.values(), ids=BAD)
def test_what_cannot_be_watched_is_refused(options: list[str], said: str, tmp_path: Path) -> None:
    errors = refused(rosa("run", "suave", *options, cwd=tmp_path))
    assert re.search(said, errors, re.DOTALL)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("watching", "task_layer", "said"),
    [
        (Watching(btlog=Path("a.btlog")), "pddl", "--btlog needs a behaviour tree"),
        (Watching(groot="1667"), "pddl", "--groot needs a behaviour tree"),
        (Watching(terminal=True), "bt", "--quiet shows nothing"),
        (Watching(groot="groot"), "bt", "'groot' is not an address for Groot2"),
        (Watching(groot="host:"), "bt", "'host:' is not an address for Groot2"),
        (Watching(groot="1234567"), "bt", "'1234567' is not an address for Groot2"),
    ],
)
def test_wishes_that_do_not_go_together_are_refused(watching: Watching, task_layer: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        watching.check(task_layer, quiet=True, is_terminal=True)


def in_a_terminal(*arguments: object, rows: int, columns: int = 120) -> str:
    """What the command shows in a terminal of that size."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    environment = {name: text for name, text in os.environ.items() if name not in ("COLUMNS", "LINES", "NO_COLOR")}
    command = [sys.executable, "-m", "rosa_cli.main", *map(str, arguments)]
    process = subprocess.Popen(command, stdout=theirs, stderr=theirs, env={**environment, "TERM": "xterm-256color"})
    os.close(theirs)
    shown = b""
    with contextlib.suppress(OSError):  # how Linux says that nobody writes any more
        while block := os.read(ours, 65536):
            shown += block
    os.close(ours)
    assert process.wait(timeout=60) == 0
    return shown.decode()


def test_a_run_is_watched_in_the_terminal() -> None:
    shown = in_a_terminal("run", "suave", "--watch", "--speed", "60", "--time-limit", "60", rows=50)
    plain = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", shown)
    assert plain.count("until done  RetryUntilSuccessful num_attempts=-1") > 5  # drawn again and again
    assert "▶ search_pipeline  performing search_pipeline" in plain
    assert "✓ is_action_feasible  action_name=search_pipeline" in plain
    assert "\x1b[1;33m" in shown  # what runs stands out
    last = plain[plain.rindex("until done") :]
    assert "time limit" in last  # the tree stays above the summary


def test_a_tree_that_does_not_fit_is_cut() -> None:
    shown = in_a_terminal("run", "suave-extended", "--watch", "--speed", "100", "--time-limit", "40", rows=12)
    assert re.search(r"and \d+ more", shown)
