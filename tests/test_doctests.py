"""The examples in docstrings run, and give what they say: those of every package of the project."""

from __future__ import annotations

import doctest
import tomllib
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
OPTIONS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def modules_with_examples() -> list[str]:
    """The modules with a doctest; others are not imported for it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    packages = project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]
    found = []
    for file in sorted(file for package in packages for file in (ROOT / package).rglob("*.py")):
        if ">>> " in file.read_text(encoding="utf-8"):
            parts = file.relative_to(ROOT).with_suffix("").parts
            found.append(".".join(parts[:-1] if parts[-1] == "__init__" else parts))
    return found


@pytest.mark.parametrize("name", modules_with_examples())
def test_the_examples_of_a_module_give_what_they_say(name: str) -> None:
    results = doctest.testmod(import_module(name), optionflags=OPTIONS)
    assert results.attempted
    assert not results.failed, "what differs is in the output above"


def test_the_knowledge_base_has_examples() -> None:
    assert {"rosa_core.kb.knowledge_base", "rosa_core.model.knowledge_model"} <= set(modules_with_examples())
