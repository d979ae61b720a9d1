"""The code in docs/pddl.md runs, and what planning costs is paid only by those who plan."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def run(code: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60, cwd=ROOT
    ).stdout


def test_the_example_replans_for_a_low_battery() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "pddl.md").read_text(encoding="utf-8"), re.DOTALL)
    status, first, second = run(code).splitlines()
    assert status == "ExecutionStatus.SUCCESS"
    assert first.endswith("(the mission begins)")
    assert second.startswith("plan (recharge recharge")


def test_a_mission_flown_by_a_tree_does_not_load_the_planner() -> None:
    code = (
        "import sys; from rosa_simulation.scenario import *; from suave.scenario import SUAVE;"
        "SUAVE.run(RunRequest(time_limit=5.0), SilentObserver());"
        "print([name for name in sys.modules if name.startswith(('unified_planning', 'up_', 'pyperplan'))])"
    )
    assert run(code).strip() == "[]"
