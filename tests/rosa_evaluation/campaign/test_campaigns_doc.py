"""What docs/campaigns.md shows is what happens."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.hang_limit import HANG_LIMIT
from tests.rosa_cli.cli import rosa

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "campaigns.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


@pytest.mark.slow
def test_its_experiment_and_programs_work_one_after_the_other(tmp_path: Path) -> None:
    (experiment,) = blocks("yaml")
    (tmp_path / "varied.yaml").write_text(experiment, encoding="utf-8")
    command = ("campaign", "suave", "--managers", "none,rosa", "--runs", 2, "--out", "results")
    process = rosa(*command, "--experiment", "varied.yaml", cwd=tmp_path)
    assert process.returncode == 0, process.stderr
    assert "suave, varied uncertainties: seeds 10000 to 10001" in process.stdout
    read, execute = blocks("python")
    assert "search time" in python(tmp_path, read)
    assert "CampaignOutcome(present=0, carried_out=6, done=6, failed=0, missing=0)" in python(tmp_path, execute)


def python(directory: Path, code: str) -> str:
    (directory / "program.py").write_text(code, encoding="utf-8")
    process = subprocess.run(
        [sys.executable, "program.py"], capture_output=True, text=True, cwd=directory, timeout=HANG_LIMIT, check=False
    )
    assert process.returncode == 0, process.stderr
    return process.stdout
