"""The page on watching does what it says."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

from tests.task_layer.groot.asking import free_port

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "watching.md").read_text(encoding="utf-8")


def test_the_example_prints_what_the_page_shows(tmp_path: Path) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    printed = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)[-1]
    assert "port=1667" in code
    code = code.replace("port=1667", f"port={free_port()}")
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert process.returncode == 0, process.stderr
    assert process.stdout == printed
