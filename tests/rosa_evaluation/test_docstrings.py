"""The examples in docstrings run."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import rosa_cli
import rosa_evaluation

MODULES = [
    module.name
    for package in (rosa_evaluation, rosa_cli)
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
]


@pytest.mark.parametrize("name", [*MODULES, "rosa_simulation.metric"])
def test_examples_in_docstrings_run(name: str) -> None:
    if name.endswith("clingo_peer"):
        pytest.importorskip("clingo")
    assert doctest.testmod(importlib.import_module(name)).failed == 0
