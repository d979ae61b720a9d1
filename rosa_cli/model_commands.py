"""``rosa check``, ``status``, ``explain``, ``query`` and ``schema``: questions about a knowledge model."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rosa_cli.choice import choice_document, choice_lines, choose
from rosa_cli.named_number import named_number
from rosa_cli.options import SituationOptions
from rosa_cli.output import plain_table, print_json
from rosa_core import ElementKind, InputError, KnowledgeBase, KnowledgeModel, SimulationClock, Situation, Status
from rosa_core.errors import Problem, nearest
from rosa_core.kb import Explanation, stated_situation
from rosa_core.model.effort import count_effort
from rosa_core.model.utility import Utility

_KINDS = {
    "actions": ElementKind.ACTION,
    "functions": ElementKind.FUNCTION,
    "components": ElementKind.COMPONENT,
    "function_designs": ElementKind.FUNCTION_DESIGN,
    "component_configurations": ElementKind.COMPONENT_CONFIGURATION,
}


def check_model(files: list[Path]) -> None:
    """Say that the model holds together, and how large it is."""
    effort = count_effort(KnowledgeModel.load(*files))
    print(f"ok: {effort.entities} entities, {effort.relations} relations")


def show_status(files: list[Path], situation: SituationOptions, utility: Utility | None, *, as_json: bool) -> None:
    """Print the status of every element; with a utility also what it chooses for the required action, and why."""
    kb = load_knowledge_base(files, situation)
    choice = None if utility is None else choose(kb, utility)
    if as_json:
        document = _status_document(kb)
        print_json(document if choice is None else {**document, "choice": choice_document(choice)})
        return
    from rich.console import Console
    from rich.text import Text

    table = plain_table("kind", "name", "status")
    for kind in _KINDS.values():
        for name, status in kb.statuses(kind).items():
            table.add_row(kind.value.replace("_", " "), Text(name), Text(status, _STYLES.get(status, "")))
    for constraint, status in kb.constraints():
        constrained = Text(f"{constraint} on {constraint.constrained}")
        table.add_row("constraint", constrained, Text(status, _STYLES.get(status, "")))
    console = Console(highlight=False)
    console.print(table)
    console.print(Text(f"\nselectable actions: {', '.join(kb.selectable_actions()) or 'none'}"))
    if choice is not None:
        console.print(Text("\n" + "\n".join(choice_lines(choice))))


def show_explanation(arguments: list[str], situation: SituationOptions, *, as_json: bool) -> None:
    """Print why an element has its status."""
    if len(arguments) < 3:
        raise InputError(Problem("files, a kind and a name are needed", hint="rosa explain model.yaml action fly"))
    *files, kind, name = arguments
    known = {element.value for element in _KINDS.values()}
    kind = kind.replace("-", "_")
    if kind not in known:
        hint = nearest(kind, known) or f"kinds are: {', '.join(sorted(known))}"
        raise InputError(Problem(f"'{kind}' is not a kind of element", hint=hint))
    explanation = load_knowledge_base([Path(file) for file in files], situation).explain(kind, name)
    if as_json:
        details = {"notes": list(explanation.notes), "remedies": list(explanation.remedies)}
        print_json({**_explanation_document(explanation), **details})
        return
    print(explanation)
    for note in explanation.notes:
        print(f"\nnote: {note}")
    if len(explanation.remedies) == 1:
        print(f"\nto make it feasible: {explanation.remedies[0]}")
    elif explanation.remedies:
        print("\nto make it feasible, all of:", *explanation.remedies, sep="\n  - ")


def show_answer(arguments: list[str], situation: SituationOptions, *, as_json: bool) -> None:
    """Print the rows that answer a query."""
    if len(arguments) < 2:
        hint = "rosa query model.yaml 'match $a isa Action, has name $n; fetch $n;'"
        raise InputError(Problem("a file and a query are needed", hint=hint))
    *files, text = arguments
    rows = load_knowledge_base([Path(file) for file in files], situation).query(
        sys.stdin.read() if text == "-" else text
    )
    if as_json:
        print_json(rows)
        return
    from rich.console import Console
    from rich.text import Text

    flat = [dict(_columns(row)) for row in rows]
    names = list(dict.fromkeys(name for row in flat for name in row))
    table = plain_table(*names)
    for row in flat:
        table.add_row(*(Text(row.get(name, "")) for name in names))
    console = Console(highlight=False)
    if rows:
        console.print(table)
    else:
        console.print("no rows")


def _columns(row: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """A row with one column for each attribute of a thing; texts as they are, other values as in JSON."""
    for name, value in row.items():
        parts = value if isinstance(value, dict) else {"": value}
        for part, entry in parts.items():
            shown = entry if isinstance(entry, str) else json.dumps(entry, ensure_ascii=False)
            yield f"{name}.{part}" if part else name, "" if entry is None else shown


def show_schema() -> None:
    """Print the JSON Schema."""
    from rosa_core.formats.yaml_format import json_schema

    print_json(json_schema())


def load_knowledge_base(files: list[Path], options: SituationOptions) -> KnowledgeBase:
    """A knowledge base of models in the situation that the files state and the command line adds to.

    Args:
        files: the models; later ones extend earlier ones.
        options: what the command line adds.

    Raises:
        InputError: if a model cannot be used, or an option names what is not in it.
    """
    model = KnowledgeModel.load(*files)
    designs, configurations = _selection(model, options.select or [])
    stated = stated_situation(model)
    situation = Situation(
        measurements={
            **stated.measurements,
            **dict(named_number("--measure", text, "battery_level=0.24") for text in options.measure or []),
        },
        failed_components=(*stated.failed_components, *(options.failed or ())),
        required_actions=(*stated.required_actions, *(options.require or ())),
        selected_designs=(*stated.selected_designs, *designs),
        selected_configurations=(*stated.selected_configurations, *configurations),
        active_components=(*stated.active_components, *(options.active or ())),
    )
    kb = KnowledgeBase(model, clock=SimulationClock())
    kb.suppose(situation)
    return kb


def _selection(model: KnowledgeModel, names: list[str]) -> tuple[list[str], list[str]]:
    """Which of the names are designs, which are configurations; a name that is both selects both."""
    designs = model.names[ElementKind.FUNCTION_DESIGN]
    configurations = model.names[ElementKind.COMPONENT_CONFIGURATION]
    for name in names:
        if name not in designs and name not in configurations:
            hint = nearest(name, (*designs, *configurations)) or "see 'rosa status' for the names"
            raise InputError(Problem(f"--select {name}: no function design or configuration has that name", hint=hint))
    return [n for n in names if n in designs], [n for n in names if n in configurations]


def _status_document(kb: KnowledgeBase) -> dict[str, Any]:
    document: dict[str, Any] = {section: kb.statuses(kind) for section, kind in _KINDS.items()}
    document["constraints"] = [
        {
            "measure": constraint.measure,
            "constrained": constraint.constrained.name,
            "constrained_kind": constraint.constrained.kind,
            "operator": constraint.operator,
            "value": constraint.value,
            "status": status,
        }
        for constraint, status in kb.constraints()
    ]
    document["selectable_actions"] = kb.selectable_actions()
    return document


def _explanation_document(explanation: Explanation) -> dict[str, Any]:
    return {
        "kind": explanation.kind,
        "name": explanation.name,
        "status": explanation.status,
        "reason": explanation.reason,
        "because": [_explanation_document(cause) for cause in explanation.because],
    }


_STYLES = {
    Status.UNFEASIBLE: "red",
    Status.VIOLATED: "red",
    Status.FAILURE: "bold red",
    Status.CONFIGURATION_ERROR: "red",
    Status.IMPLICIT_CONFIGURATION_ERROR: "red",
    Status.UNSOLVED: "yellow",
    Status.SOLVED: "green",
    Status.SATISFIED: "green",
}
