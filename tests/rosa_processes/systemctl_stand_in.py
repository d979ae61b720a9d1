"""Answers like ``systemctl`` for units that are folders: each with what it does, and the number of its process."""

import os
import signal
import subprocess
import sys
from pathlib import Path

DAEMON = """
import os, sys
if os.fork():
    sys.exit()
os.setsid()
with open(sys.argv[1] + "/pid.new", "w") as file:
    file.write(str(os.getpid()))
os.rename(sys.argv[1] + "/pid.new", sys.argv[1] + "/pid")
os.execvp("sleep", ["sleep", "1000"])
"""
folder, scope, _, verb, *rest = sys.argv[1:]
assert scope in ("--user", "--system"), scope


def main_pid(unit: Path) -> int:
    try:
        pid = int((unit / "pid").read_text())
        os.kill(pid, 0)
    except (OSError, ValueError):
        return 0
    # Its children are nobody's here: one that has ended stays as a zombie until init sees to it.
    return 0 if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z" else pid


def start(unit: Path) -> int:
    if not unit.is_dir():
        print(f"Unit {unit.name} not found.", file=sys.stderr)
        return 5
    if (unit / "refuses").exists():
        print(f"Job for {unit.name} failed.", file=sys.stderr)
        return 1
    if not main_pid(unit):
        (unit / "pid").unlink(missing_ok=True)
        command = [sys.executable, "-I", "-S", "-c", DAEMON, str(unit)]
        subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        while not (unit / "pid").exists():
            pass
    return 0


def stop(unit: Path) -> int:
    pid = main_pid(unit)
    if pid:
        os.kill(pid, signal.SIGKILL)
        while main_pid(unit):
            pass
    return 0


if verb == "show":
    blocks = []
    for name in rest[2:]:
        unit = Path(folder) / name
        pid = main_pid(unit)
        load = "loaded" if unit.is_dir() else "not-found"
        blocks.append(f"MainPID={pid}\nLoadState={load}\nActiveState={'active' if pid else 'inactive'}\n")
    print("\n".join(blocks))
    sys.exit(0)
unit = Path(folder) / rest[0]
with (Path(folder) / "calls").open("a") as calls:
    calls.write(f"{scope} {verb} {unit.name}\n")
if verb == "restart":
    stop(unit)
sys.exit(stop(unit) if verb == "stop" else 0 if verb == "reload" else start(unit))
