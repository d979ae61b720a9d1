"""docs/uav.md: its commands print what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.doc_commands import links, untrue_commands
from uav_example.parameters import PARAMETERS

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "uav.md").read_text(encoding="utf-8")


def test_the_commands_print_what_the_page_says() -> None:
    assert list(untrue_commands(TEXT, ROOT)) == []


def test_the_code_draws_the_picture_of_the_page() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    names: dict[str, str] = {}
    exec(code, names)
    assert names["svg"] == (ROOT / "docs" / "uav.svg").read_text(encoding="utf-8")


def test_the_parameters_of_the_page_are_there() -> None:
    (shown,) = re.findall(r"parameters: \{(.*)\}", TEXT)
    assert {pair.split(":")[0].strip() for pair in shown.split(",")} <= set(PARAMETERS)


@pytest.mark.parametrize("link", links(TEXT))
def test_every_file_that_the_page_names_is_there(link: str) -> None:
    assert (ROOT / "docs" / link).exists()
