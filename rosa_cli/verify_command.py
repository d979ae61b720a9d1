"""``rosa verify``: what can go wrong with a robot, before its mission."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from rosa_cli.exit_codes import ExitCode
from rosa_cli.model_files import load_given_model
from rosa_cli.named_number import named_number
from rosa_cli.options import VerifyOptions
from rosa_cli.output import plain_table, print_json
from rosa_core import ElementKind, InputError, KnowledgeModel
from rosa_core.errors import Location, Problem, nearest, unwritable
from rosa_core.model.elements import ElementRef
from rosa_verification.causes import Cause, cause_text
from rosa_verification.model_findings import ModelFindings, verify_model
from rosa_verification.reliability_file import Reliability, read_reliability
from rosa_verification.structure import Structure

if TYPE_CHECKING:
    from rosa_verification.reliability import ActionReliability

_MOST_SHOWN = 20
"""Of each element so many cut sets are shown; all of them are in the JSON document."""
_MOST_PATHS = 5


def verify_files(files: list[Path], options: VerifyOptions, *, as_json: bool) -> ExitCode:
    """Print what is found in models, and write what is asked for.

    Args:
        files: the models; later ones extend earlier ones.
        options: of what, and how far.
        as_json: print the JSON document.

    Raises:
        InputError: if a model, a file or an option cannot be used.
    """
    model = load_given_model(files)
    measured = _measured(model, options.measure or [])
    reliability = None if options.reliability is None else read_reliability(options.reliability, model)
    structure = Structure(model)
    action = _action(model, options) if options.fault_tree else ""
    findings = verify_model(model, options.order)
    reliabilities = []
    if reliability is not None:
        from rosa_verification.reliability import action_reliabilities

        reliabilities = action_reliabilities(structure, reliability.probabilities, measured)
    for file in options.fault_tree or ():
        write_fault_tree(file, structure, action, reliability, measured)
    if as_json:
        figures = {} if reliability is None else {"reliability": [one.document() for one in reliabilities]}
        print_json({**findings.document(), **figures})
    else:
        show_findings(findings, options.order, every_kind=options.every_kind)
        if reliability is not None:
            show_reliabilities(reliabilities)
        show_verdict(findings)
    return ExitCode.BROKE_OFF if findings.defects else ExitCode.DONE


def write_fault_tree(
    file: Path, structure: Structure, action: str, reliability: Reliability | None, measured: Mapping[str, float]
) -> None:
    """Write the fault tree of an action into a file of a kind that its name says.

    Raises:
        InputError: if the file cannot be written, or the tree is too large to be drawn.
    """
    from rosa_verification.drawing import fault_tree_svg
    from rosa_verification.exports import galileo, open_psa
    from rosa_verification.fault_tree import fault_tree

    tree = fault_tree(structure, ElementRef(ElementKind.ACTION, action))
    texts: dict[str, Callable[[], str]] = {
        ".svg": lambda: fault_tree_svg(tree),
        ".xml": lambda: open_psa(tree, reliability, measured),
        ".dft": lambda: galileo(tree, reliability, measured),
    }
    text = texts[file.suffix]()
    try:
        file.write_text(text, encoding="utf-8")
    except OSError as error:
        raise unwritable(file, error, "name a file in a directory that there is") from None
    print(f"rosa: fault tree of '{action}' in {file}", file=sys.stderr)


def _measured(model: KnowledgeModel, texts: list[str]) -> dict[str, float]:
    measured = dict(named_number("--measure", text, "battery_level=0.24") for text in texts)
    known = model.names[ElementKind.MEASURE]
    for name in measured:
        if name not in known:
            raise InputError(Problem(f"--measure {name}: no measure has that name", hint=nearest(name, known)))
    return measured


def _action(model: KnowledgeModel, options: VerifyOptions) -> str:
    """The action whose fault tree is asked for, once all that is asked for can be written."""
    for file in options.fault_tree or ():
        if file.suffix not in (".svg", ".xml", ".dft"):
            hint = "name it .svg for a drawing, .xml for Open-PSA, .dft for Galileo"
            raise InputError(Problem("no kind of fault tree", Location(str(file)), hint))
    actions = model.names[ElementKind.ACTION]
    if options.action is None:
        if len(actions) == 1:
            return actions[0]
        hint = f"say --action {actions[0]}" if actions else "the model has no action"
        raise InputError(Problem("a fault tree is of one action", hint=hint))
    if options.action not in actions:
        hint = nearest(options.action, actions) or f"actions are: {', '.join(actions)}"
        raise InputError(Problem(f"--action {options.action}: no action has that name", hint=hint))
    return options.action


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


def show_verdict(findings: ModelFindings) -> None:
    """Print how many defects there are."""
    count = len(findings.defects)
    verdict = f"{count} defect{'' if count == 1 else 's'} of the model" if count else "no defects of the model"
    Console(highlight=False).print(Text(verdict, "red" if count else "green"))


def show_reliabilities(reliabilities: list[ActionReliability]) -> None:
    """Print how likely actions are to be unfeasible, and what matters for it."""
    table = plain_table(
        "action",
        "unfeasible",
        "component",
        "Birnbaum",
        "Fussell-Vesely",
        right=("unfeasible", "Birnbaum", "Fussell-Vesely"),
    )
    for found in reliabilities:
        cells = (Text(found.action), f"{found.unfeasible:.4g}")
        if not found.importances:
            table.add_row(*cells)
        for one in found.importances:
            share = "" if one.fussell_vesely is None else f"{one.fussell_vesely:.4g}"
            table.add_row(*cells, Text(one.component), f"{one.birnbaum:.4g}", share)
            cells = (Text(""), "")
    _show(Console(highlight=False), "how likely actions are to be unfeasible", table)


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
