"""docs/streams.md: its files load, its commands and its code run and print what the page says; so do docstrings."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import rosa_streams
from tests.doc_commands import links, untrue_commands

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "streams.md").read_text(encoding="utf-8")
MODULES = sorted(each.name for each in pkgutil.walk_packages(rosa_streams.__path__, "rosa_streams."))


def test_the_commands_print_what_the_page_says(tmp_path: Path) -> None:
    (yaml,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    (xml,) = re.findall(r"```xml\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "ball.yaml").write_text(yaml, encoding="utf-8")
    (tmp_path / "pose.xml").write_text(xml, encoding="utf-8")
    shown = re.sub(r"```sh\nrosa streams (?:monitor|plan [^\n]*--json).*?```\n", "", PAGE, flags=re.DOTALL)
    assert shown.count("```sh") == 2
    assert list(untrue_commands(shown, tmp_path)) == []


def test_the_code_runs_and_prints_what_the_page_says() -> None:
    found = re.findall(r"```python\n(.*?)```(?:\s*```text\n(.*?)```)?", PAGE, re.DOTALL)
    program = "".join(code for code, _ in found)
    process = subprocess.run(
        [sys.executable, "-X", "utf8", "-c", program], capture_output=True, text=True, encoding="utf-8", cwd=ROOT,
        check=False, timeout=120,
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    assert process.stdout == "".join(printed for _, printed in found)


def test_the_page_links_to_what_is_there() -> None:
    assert all((ROOT / "docs" / link).exists() for link in links(PAGE))


@pytest.mark.parametrize("module", MODULES)
def test_the_examples_of_docstrings_run(module: str) -> None:
    outcome = doctest.testmod(importlib.import_module(module))
    assert outcome.failed == 0
