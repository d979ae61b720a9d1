"""``rosa verify``: what can go wrong with a robot, before its mission."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.text import Text

from rosa_cli.exit_codes import ExitCode
from rosa_cli.output import plain_table, print_json
from rosa_core import ElementKind, KnowledgeModel
from rosa_core.model.elements import ElementRef
from rosa_verification.causes import Cause, cause_text
from rosa_verification.model_findings import ModelFindings, verify_model

_MOST_SHOWN = 20
"""Of each element so many cut sets are shown; all of them are in the JSON document."""
_MOST_PATHS = 5


def verify_files(files: list[Path], *, order: int, every_kind: bool, as_json: bool) -> ExitCode:
    """Print what is found in models.

    Args:
        files: the models; later ones extend earlier ones.
        order: the most causes of a cut set.
        every_kind: show the cut sets of all elements, not only those of actions.
        as_json: print the JSON document.

    Raises:
        InputError: if a model cannot be used.
    """
    findings = verify_model(KnowledgeModel.load(*files), order)
    if as_json:
        print_json(findings.document())
    else:
        show_findings(findings, order, every_kind=every_kind)
    return ExitCode.BROKE_OFF if findings.defects else ExitCode.DONE


def show_findings(findings: ModelFindings, order: int, *, every_kind: bool) -> None:
    """Print what is found, for people."""
    console = Console(highlight=False)
    elements = [e for e in findings.cut_sets if every_kind or e.kind is ElementKind.ACTION]
    _show_single_points(console, findings, elements)
    _show_cut_sets(console, findings, elements, order)
    _show_paths(console, findings, elements)
    _show_list(console, "gaps (no configuration although every component works)", findings.gaps)
    _show_list(console, "contradictions", findings.contradictions)
    _show_list(console, "never selected", findings.never_selected)
    _show_list(console, "choices that flap (no hysteresis)", findings.flapping)
    undecided = [f"{element}: too many situations to say" for element in findings.undecided]
    _show_list(console, "never selected or flapping?", undecided)
    count = len(findings.defects)
    verdict = f"{count} defect{'' if count == 1 else 's'} of the model" if count else "no defects of the model"
    console.print(Text(verdict, "red" if count else "green"))


def _show_single_points(console: Console, findings: ModelFindings, elements: list[ElementRef]) -> None:
    table = plain_table("element", "what alone makes it unfeasible")
    for element in elements:
        single = findings.single_points(element)
        if findings.cut_sets[element].sets == ((),):
            table.add_row(Text(str(element)), Text("never feasible", "red"))
        else:
            table.add_row(Text(str(element)), Text(", ".join(map(cause_text, single)) or "nothing"))
    _show(console, "single points of failure", table)


def _show_cut_sets(console: Console, findings: ModelFindings, elements: list[ElementRef], order: int) -> None:
    table = plain_table("element", "order", "what together makes it unfeasible", right=("order",))
    for element in elements:
        found = findings.cut_sets[element]
        several = [one for one in found.sets if len(one) > 1]
        for causes in several[:_MOST_SHOWN]:
            table.add_row(Text(str(element)), str(len(causes)), Text(" and ".join(map(cause_text, causes))))
        if len(several) > _MOST_SHOWN:
            table.add_row(Text(str(element)), "", Text(f"and {len(several) - _MOST_SHOWN} more: see --json"))
        if found.order is not None and found.order < order:
            table.add_row(Text(str(element)), "", Text(f"too many beyond order {found.order}", "yellow"))
    if table.row_count:
        _show(console, f"minimal cut sets, up to order {order}", table)


def _show_paths(console: Console, findings: ModelFindings, elements: list[ElementRef]) -> None:
    table = plain_table("element", "what is enough for it to be feasible")
    for element in elements:
        sets = findings.path_sets[element]
        if sets is None:
            table.add_row(Text(str(element)), Text("too many sets to list"))
            continue
        for one in sets[:_MOST_PATHS]:
            table.add_row(Text(str(element)), Text(_path_text(one)))
        if len(sets) > _MOST_PATHS:
            table.add_row(Text(str(element)), Text(f"or one of {len(sets) - _MOST_PATHS} more sets: see --json"))
    _show(console, "minimal sets that make it possible", table)


def _path_text(parts: tuple[Cause, ...]) -> str:
    return ", ".join(map(str, parts)) or "always feasible"


def _show(console: Console, title: str, table: object) -> None:
    console.print(Text(title, "bold underline"))
    console.print(table)
    console.print()


def _show_list(console: Console, title: str, found: Iterable[object]) -> None:
    lines = [f"  {one}" for one in found]
    if lines:
        console.print(Text(title, "bold underline"))
        console.print(Text("\n".join(lines)))
        console.print()
