"""The command as a user runs it, in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def rosa(*arguments: object, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run ``rosa`` with these arguments."""
    return subprocess.run(
        [sys.executable, "-m", "rosa_cli.main", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={**os.environ, "COLUMNS": "200"},
        check=False,
    )


def refused(process: subprocess.CompletedProcess[str]) -> str:
    """What the command says of bad input: one message on standard error, exit code 2, no traceback."""
    assert process.returncode == 2, process
    assert process.stdout == ""
    assert "Traceback" not in process.stderr
    return process.stderr
