"""The README's commands and code are what is run and tested."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.hang_limit import HANG_LIMIT

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


def test_there_are_two_commands_each_makes_its_own_environment() -> None:
    fly, test = (block.strip() for block in blocks("sh"))
    install = "python3 -m venv .venv && .venv/bin/pip install -c constraints.txt"
    assert fly == f"{install} . && .venv/bin/rosa run suave-extended"
    assert test == f'{install} -e ".[test]" && .venv/bin/python -m pytest -n 2'


def test_ci_runs_exactly_the_test_command() -> None:
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert "README.md" in script  # it takes the command from there, not a copy of it
    assert "pytest" not in re.sub(r"#.*", "", script)


def test_every_dependency_is_pinned_for_a_fresh_install() -> None:
    import tomllib

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"].values()
    wanted = [*project["dependencies"], *(line for extra in extras for line in extra)]
    names = {re.split(r"[<>=\[ ]", line)[0].lower().replace("_", "-") for line in wanted}
    constraints = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pinned = {line.split("==")[0].lower().replace("_", "-") for line in constraints if "==" in line}
    assert names - pinned == set()
    assert all(">=" in line or "==" in line for line in wanted)


def test_the_python_example_does_what_the_readme_says() -> None:
    (code,) = blocks("python")
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=False, timeout=HANG_LIMIT
    )
    assert process.returncode == 0, process.stderr
    printed = next(block for block in blocks("text") if block.startswith("set camera")).splitlines()
    for said, is_said in zip(process.stdout.splitlines(), printed, strict=True):
        assert said.startswith(is_said.removesuffix("..."))
    assert len([line for line in code.splitlines() if line.strip() and "import" not in line]) <= 20


def test_the_mission_goes_as_the_readme_shows() -> None:
    (shown,) = (block for block in blocks("text") if "GUIDED" in block)
    process = subprocess.run(
        [sys.executable, "-m", "rosa_cli.main", "run", "suave-extended"],
        capture_output=True,
        text=True,
        check=True,
        timeout=HANG_LIMIT,
    )
    # The pipeline may be found a little sooner or later on another processor; what happens is the same.
    printed = [re.sub(r"^ *[\d.]+ s ", "", line) for line in process.stderr.splitlines() if line.strip()]
    assert [re.sub(r"^ *[\d.]+ s ", "", line) for line in shown.splitlines()] == printed


@pytest.mark.parametrize("link", re.findall(r"\]\(([^)#]+)\)", README))
def test_every_file_that_the_readme_names_is_there(link: str) -> None:
    assert (ROOT / link).exists()
