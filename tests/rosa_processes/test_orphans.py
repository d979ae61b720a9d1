"""A manager that is killed leaves nothing behind: no child, no grandchild, wherever it has moved."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.rosa_processes.programs import FOR_EVER, kill, lines_of, wait_for_end
from tests.rosa_processes.test_processes import GRANDCHILDREN

MANAGER = """
import sys
from pathlib import Path
from rosa_processes import ProcessEntry, ProcessSystem
from tests.rosa_processes.programs import Changes, program
folder = Path(sys.argv[1])
entry = program({text!r}, ready={{"line": "ready"}}, log=Path("log"))
system = ProcessSystem({{"one": entry, "two": entry}}, folder)
changes = Changes(system)
for round in range(int(sys.argv[2])):
    for name in ("one", "two"):
        system.activate(name)
    changes.wait(lambda: all(system.state(name).value == "active" for name in ("one", "two")))
    print(system.pid("one"), system.pid("two"), system._supervisor._keeper.pid, flush=True)
import time
time.sleep(600)
"""

OUTER = """
from rosa_processes import ProcessSystem
from tests.rosa_processes.programs import Changes, program
system = ProcessSystem({{"inner": program({text!r}, ready={{"line": "ready"}})}})
changes = Changes(system)
system.activate("inner")
changes.wait(lambda: system.state("inner").value == "active")
print(system._supervisor._keeper.pid, flush=True)
import time
time.sleep(600)
"""
ROOT = Path(__file__).parents[2]


def manager(text: str, folder: Path) -> subprocess.Popen[str]:
    code = MANAGER.format(text=text)
    return subprocess.Popen([sys.executable, "-c", code, str(folder), "1"], stdout=subprocess.PIPE, text=True, cwd=ROOT)


def kill_and_see(text: str, folder: Path) -> None:
    folder.mkdir()
    with manager(text, folder) as running:
        assert running.stdout is not None
        *components, keeper = map(int, running.stdout.readline().split())
        grandchildren = [int(pid) for line in lines_of(folder / "log", 2) for pid in line.split()[1:]]
        assert grandchildren or text == FOR_EVER
        kill(running.pid)
        wait_for_end([*components, *grandchildren, keeper])


def test_a_manager_that_is_killed_leaves_no_child_and_no_grandchild(tmp_path: Path) -> None:
    kill_and_see(GRANDCHILDREN, tmp_path / "0")


@pytest.mark.slow
def test_that_holds_a_hundred_times(tmp_path: Path) -> None:
    for attempt in range(100):
        kill_and_see(GRANDCHILDREN, tmp_path / str(attempt))


def test_what_a_managed_manager_manages_ends_too(tmp_path: Path) -> None:
    """The inner manager's programs are marked for both keepers."""
    inner = tmp_path / "inner.py"
    inner.write_text(MANAGER.format(text=GRANDCHILDREN).replace("time.sleep", "print('ready', flush=True); time.sleep"))
    text = f"import os, sys; os.execv({sys.executable!r}, [{sys.executable!r}, {str(inner)!r}, {str(tmp_path)!r}, '1'])"
    command = [sys.executable, "-c", OUTER.format(text=text)]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=environment) as running:
        assert running.stdout is not None
        keeper = int(running.stdout.readline())
        grandchildren = [int(pid) for line in lines_of(tmp_path / "log", 2) for pid in line.split()[1:]]
        assert len(grandchildren) == 4
        kill(running.pid)
        wait_for_end([keeper, *grandchildren])


@pytest.mark.slow
def test_also_when_it_is_killed_while_it_starts_them(tmp_path: Path) -> None:
    """Before the first of them is another program than the manager, or after the first shows itself."""
    code = MANAGER.replace("print(", "0 and print(").replace("changes =", "supervisor = system._supervisor; changes =")
    code = code.replace("activate(name)", "activate(name); print(supervisor.mark, supervisor._keeper.pid, flush=True)")
    for attempt in range(40):
        folder = tmp_path / str(attempt)
        folder.mkdir()
        command = [sys.executable, "-c", code.format(text=GRANDCHILDREN), str(folder), "1"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as running:
            assert running.stdout is not None
            mark, keeper = running.stdout.readline().split()
            if attempt % 2:
                lines_of(folder / "log", 1)
            kill(running.pid)
            wait_for_end([int(keeper)])
        assert not every_process_with(mark)


def every_process_with(text: str) -> list[int]:
    return [pid for pid in processes() if text in read(pid, "environ")]


def processes() -> list[int]:
    return [int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit()]


def read(pid: int, name: str) -> str:
    try:
        return Path(f"/proc/{pid}/{name}").read_text(errors="replace")
    except OSError:
        return ""
