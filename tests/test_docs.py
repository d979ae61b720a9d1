"""The code in the docs runs, and prints what the docs say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.hang_limit import HANG_LIMIT

ROOT = Path(__file__).resolve().parent.parent
PAGES = (
    "agv.md",
    "behaviour_trees.md",
    "btcpp_semantics.md",
    "first_robot.md",
    "managers.md",
    "mission_xml.md",
    "py_trees_users.md",
    "reflexes.md",
    "report.md",
    "verification.md",
)
"""Pages whose Python blocks are one program; a ``text`` block right after one is what that block prints."""

_MARK = "-- block --"


def blocks_of(page: str) -> list[tuple[str, str | None]]:
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.findall(r"```python\n(.*?)```(?:\s*```text\n(.*?)```)?", text, re.DOTALL)
    return [(code, printed or None) for code, printed in found]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs_and_prints_what_the_page_says(page: str) -> None:
    blocks = blocks_of(page)
    program = f"print('{_MARK}')\n".join(code for code, _ in blocks)
    process = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", program],
        capture_output=True,
        text=True,
        encoding="utf-8",
        cwd=ROOT,
        check=False,
        timeout=HANG_LIMIT,
    )
    assert process.returncode == 0, process.stderr
    printed = [lines.strip() for lines in process.stdout.split(_MARK)]
    assert [lines for lines in printed if lines] == [text.strip() for _, text in blocks if text is not None]
