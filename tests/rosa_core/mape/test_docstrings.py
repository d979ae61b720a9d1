"""The examples in docstrings run."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import rosa_core.mape

MODULES = [module.name for module in pkgutil.walk_packages(rosa_core.mape.__path__, "rosa_core.mape.")]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_run(name: str) -> None:
    assert doctest.testmod(importlib.import_module(name)).failed == 0
