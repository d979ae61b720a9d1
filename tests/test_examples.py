"""The programs in ``examples/`` run, and print what they say at their end."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.hang_limit import HANG_LIMIT

EXAMPLES = sorted((Path(__file__).resolve().parent.parent / "examples").glob("*.py"))


@pytest.mark.parametrize("program", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_prints_what_it_says(program: Path, tmp_path: Path) -> None:
    said = re.search(r"^# prints:\n((?:#.*\n)+)\Z", program.read_text(encoding="utf-8"), re.MULTILINE)
    assert said is not None, "it ends with '# prints:' and the lines, each in a comment"
    process = subprocess.run(
        [sys.executable, "-X", "utf8", program], capture_output=True, text=True, encoding="utf-8", cwd=tmp_path,
        check=False, timeout=HANG_LIMIT,
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    assert process.stdout.splitlines() == [line[2:] for line in said[1].splitlines()]
