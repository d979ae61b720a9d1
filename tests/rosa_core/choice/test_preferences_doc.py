"""docs/preferences.md: its code is run, and prints what it says."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from tests.hang_limit import HANG_LIMIT

ROOT = Path(__file__).resolve().parents[3]
TEXT = (ROOT / "docs" / "preferences.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


def test_the_code_prints_what_the_page_says() -> None:
    program = "".join(blocks("python"))
    process = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, cwd=ROOT, check=False, timeout=HANG_LIMIT
    )
    assert process.returncode == 0, process.stderr
    assert process.stdout == "".join(blocks("text"))


def test_every_file_that_the_page_names_is_there() -> None:
    for link in re.findall(r"\]\(([^)#]+)\)", TEXT):
        assert (ROOT / "docs" / link).exists(), link
