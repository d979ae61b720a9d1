"""``rosa effort --table`` and ``--growth``: development effort as in the ROSA paper's sections 7.5 and 7.6."""

from __future__ import annotations

import json

from rich.console import Console
from rich.table import Table
from rich.text import Text

from rosa_evaluation.effort import ROSA_TASK, EffortRow, effort_rows, growths


def show_effort_table(*, as_json: bool) -> None:
    """Print what was modelled for every installed robot."""
    rows = effort_rows()
    if as_json:
        print(json.dumps({"rows": [row.document() for row in rows]}, indent=2, ensure_ascii=False))
        return
    console = Console(highlight=False)
    table = _table("use case", "approach", "counted", "total", "published")
    for row in rows:
        published = "" if row.published is None else str(row.published)
        table.add_row(row.use_case, row.approach, _counted(row), str(row.total), published)
    console.print(table)
    if any(row.approach == ROSA_TASK for row in rows):
        told = f"'{ROSA_TASK}' is not in the paper: it adds the nodes by which ROSA's task trees ask what is feasible"
        console.print(Text(told), soft_wrap=True)


def show_growth(most: int, *, as_json: bool) -> None:
    """Print how much there is to model with up to ``most`` adaptations."""
    measured = growths(most)
    if as_json:
        print(json.dumps({"growth": [growth.document() for growth in measured]}, indent=2, ensure_ascii=False))
        return
    console = Console(highlight=False)
    table = _table("approach", "adaptations", "structural", "parameter")
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


def _table(*columns: str) -> Table:
    table = Table(box=None, pad_edge=False, header_style="bold")
    for column in columns:
        table.add_column(column, justify="left" if column in ("use case", "approach", "counted") else "right")
    return table
