"""The examples in docstrings run."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import task_layer


def modules() -> list[str]:
    return [
        module.name
        for module in pkgutil.walk_packages(task_layer.__path__, "task_layer.")
        if not module.name.endswith("planner_process")
    ]


@pytest.mark.parametrize("name", modules())
def test_examples_in_docstrings_run(name: str) -> None:
    module = importlib.import_module(name)
    assert doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE).failed == 0
