"""``rosa effort``: development effort as in the ROSA paper's sections 7.5 and 7.6."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.text import Text

from rosa_cli.output import plain_table, print_json
from rosa_core import InputError, KnowledgeModel
from rosa_core.errors import Problem
from rosa_core.model.effort import count_effort
from rosa_evaluation.effort import ROSA_TASK, EffortRow, effort_rows, growths


def show_effort(files: list[Path], *, table: bool, growth: bool, most: int, as_json: bool) -> None:
    """Print what a model counts, or table 7, or the growth with up to ``most`` adaptations.

    Raises:
        InputError: unless exactly one of them is asked for.
    """
    if bool(files) + table + growth != 1:
        hint = "rosa effort model.yaml, rosa effort --table, or rosa effort --growth"
        raise InputError(Problem("either files, --table or --growth is needed, and only one of them", hint=hint))
    if files:
        _show_model_effort(files, as_json=as_json)
    elif table:
        _show_table(as_json=as_json)
    else:
        _show_growth(most, as_json=as_json)


def _show_model_effort(files: list[Path], *, as_json: bool) -> None:
    """Print what the model counts."""
    effort = count_effort(KnowledgeModel.load(*files))
    if as_json:
        totals = {"entities": effort.entities, "relations": effort.relations, "total": effort.total}
        print_json({**totals, "by_kind": effort.by_kind})
        return
    for kind, count in effort.by_kind.items():
        print(f"{kind.replace('_', ' '):26}{count:6}")
    print(f"{'entities':26}{effort.entities:6}")
    print(f"{'relations':26}{effort.relations:6}")
    print(f"{'total':26}{effort.total:6}")


def _show_table(*, as_json: bool) -> None:
    """Print what was modelled for every installed robot."""
    rows = effort_rows()
    if as_json:
        print_json({"rows": [row.document() for row in rows]})
        return
    console = Console(highlight=False)
    table = plain_table("use case", "approach", "counted", "total", "published", right=("total", "published"))
    for row in rows:
        published = "" if row.published is None else str(row.published)
        table.add_row(row.use_case, row.approach, _counted(row), str(row.total), published)
    console.print(table)
    if any(row.approach == ROSA_TASK for row in rows):
        note = f"'{ROSA_TASK}' is not in the paper: it adds the nodes by which ROSA's task trees ask what is feasible"
        console.print(Text(note), soft_wrap=True)


def _show_growth(most: int, *, as_json: bool) -> None:
    """Print how much there is to model with up to ``most`` adaptations."""
    measured = growths(most)
    if as_json:
        print_json({"growth": [growth.document() for growth in measured]})
        return
    console = Console(highlight=False)
    columns = ("approach", "adaptations", "structural", "parameter")
    table = plain_table(*columns, right=columns[1:])
    for growth in measured:
        table.add_row(growth.approach, "0", str(growth.base), str(growth.base))
        for number, total in growth.structural.items():
            table.add_row("", str(number), str(total), str(growth.parameter[number]))
    console.print(table)
    for growth in measured:
        console.print(Text(f"{growth.approach}: {growth.formula}"), soft_wrap=True)
    console.print("n_sa structural, n_pa parameter adaptations of one action; systems were generated and counted")


def _counted(row: EffortRow) -> str:
    return " + ".join(f"{count} {name}" for name, count in row.parts.items())
