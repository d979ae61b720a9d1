"""docs/verification.md: its commands print what it says, and the picture is the one that they draw."""

from __future__ import annotations

from pathlib import Path

from rosa_core import ElementKind, KnowledgeModel
from rosa_core.model.elements import ElementRef
from rosa_verification import Structure
from rosa_verification.drawing import fault_tree_svg
from rosa_verification.fault_tree import fault_tree
from suave.models import model_files
from tests.doc_commands import links, untrue_commands

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")


def test_the_commands_print_what_the_page_says() -> None:
    no_files_written = TEXT.replace("rosa verify suave/models/suave.yaml --action", "")
    assert list(untrue_commands(no_files_written, ROOT)) == []


def test_the_picture_is_the_one_that_the_command_draws() -> None:
    structure = Structure(KnowledgeModel.load(*model_files(extended=False)))
    tree = fault_tree(structure, ElementRef(ElementKind.ACTION, "search_pipeline"))
    assert fault_tree_svg(tree) == (ROOT / "docs" / "fault_tree.svg").read_text(encoding="utf-8")


def test_every_file_that_the_page_names_is_there() -> None:
    assert all((ROOT / "docs" / link).exists() for link in links(TEXT))
