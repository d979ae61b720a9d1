"""Formats and query languages are ports: readers by suffix, and TypeQL found by itself, if it is there."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from rosa_core import InputError, KnowledgeModel, KnowledgeModelError
from rosa_core.errors import Location, Problem
from rosa_core.formats import ModelBuilder, loader, register_format
from rosa_core.model import ElementKind
from rosa_core.plugins import MissingPluginError, Plugin

ROOT = Path(__file__).parents[3]

WITHOUT_TYPEQL = """
import sys
from importlib.abc import MetaPathFinder

class NotInstalled(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name.partition(".")[0] == "rosa_typeql":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, NotInstalled())
from rosa_core import KnowledgeBase, KnowledgeModel, KnowledgeModelError, QueryError

kb = KnowledgeBase(KnowledgeModel.load("suave/models/suave.yaml"))
print(kb.selectable_actions())
for ask, error in (
    (lambda: KnowledgeModel.load("suave/models/suave.yaml", "more.tql"), KnowledgeModelError),
    (lambda: kb.query("match $a isa Action; get $a;"), QueryError),
):
    try:
        ask()
    except error as refusal:
        print(refusal)
"""


@pytest.fixture
def _own_readers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Readers that are registered are there for one test."""
    monkeypatch.setattr(loader, "_READERS", dict(loader._READERS))


def read_lines(path: str, builder: ModelBuilder) -> None:
    """Every line of the file is an action."""
    for number, name in enumerate(Path(path).read_text(encoding="utf-8").splitlines(), 1):
        if not name:
            raise InputError(Problem("an action without a name", Location(path, number), "write one"))
        builder.declare(ElementKind.ACTION, name, Location(path, number))


@pytest.mark.usefixtures("_own_readers")
def test_a_format_of_ones_own_goes_together_with_the_others(tmp_path: Path) -> None:
    register_format(".actions", read_lines)
    (tmp_path / "a.actions").write_text("fly\nland\n", encoding="utf-8")
    (tmp_path / "b.yaml").write_text("actions: {land: , hover: }\n", encoding="utf-8")
    model = KnowledgeModel.load(tmp_path / "a.actions", tmp_path / "b.yaml")
    assert model.names[ElementKind.ACTION] == ("fly", "land", "hover")


@pytest.mark.usefixtures("_own_readers")
def test_what_a_reader_refuses_is_an_error_of_the_model(tmp_path: Path) -> None:
    register_format(".actions", read_lines)
    (tmp_path / "a.actions").write_text("fly\n\n", encoding="utf-8")
    with pytest.raises(KnowledgeModelError, match=r"a\.actions:2: an action without a name \(write one\)"):
        KnowledgeModel.load(tmp_path / "a.actions")


def test_a_suffix_without_a_reader_lists_those_that_have_one() -> None:
    with pytest.raises(KnowledgeModelError, match=r"a model ends in \.yaml, \.yml, \.tql"):
        KnowledgeModel.load("model.json")


def test_without_rosa_typeql_the_core_works_and_says_what_is_missing() -> None:
    process = subprocess.run(
        [sys.executable, "-c", WITHOUT_TYPEQL], capture_output=True, text=True, cwd=ROOT, check=False
    )
    assert process.returncode == 0, process.stderr
    actions, model, query = process.stdout.splitlines()
    assert "search_pipeline" in actions
    hint = "needs the package rosa_typeql, which is not installed (install rosa_typeql, or add its folder to the"
    assert model.startswith(f"a TypeQL file (.tql) {hint}")
    assert query.startswith(f"a TypeQL query {hint}")


def test_importing_the_core_imports_neither_typeql_nor_sqlite() -> None:
    program = "import sys, rosa_core; print(sorted({'rosa_typeql', 'sqlite3', 'lark', 'networkx'} & set(sys.modules)))"
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=ROOT, check=True)
    assert process.stdout.strip() == "[]"


def test_a_package_that_is_not_there_is_named() -> None:
    with pytest.raises(MissingPluginError, match="drawing needs the package no_such_package, which is not installed"):
        Plugin("no_such_package.module", "draw", "drawing").load()


def test_a_package_that_lacks_something_itself_is_not_called_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "half_there.py").write_text("import no_such_package\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    with pytest.raises(ModuleNotFoundError, match="no_such_package"):
        Plugin("half_there", "anything", "a test").load()
