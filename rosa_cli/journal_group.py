"""The sub-commands of ``rosa journal``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(help="Look into a knowledge base's journal.", no_args_is_help=True, rich_markup_mode=None)

JournalFile = Annotated[Path, typer.Argument(metavar="FILE", help="The file given as journal=... to a knowledge base.")]


@app.command("show")
def journal_show(
    file: JournalFile,
    limit: Annotated[int | None, typer.Option(min=1, metavar="N", help="Only the last N writes.")] = None,
) -> None:
    """Print what was written, a line for each write: what, and the statuses that changed by it."""
    from rosa_cli.journal_commands import show_journal

    show_journal(file, limit)


@app.command("compact")
def journal_compact(
    file: JournalFile,
    keep_writes: Annotated[int | None, typer.Option(min=0, metavar="N", help="Keep the last N writes.")] = None,
    keep_seconds: Annotated[
        float | None, typer.Option(min=0.0, metavar="S", help="Keep the writes of the last S seconds.")
    ] = None,
) -> None:
    """Let old writes go and shrink the file; the state stays. By default, by the journal's own retention."""
    from rosa_cli.journal_commands import compact

    compact(file, keep_writes, keep_seconds)


@app.command("export")
def journal_export(file: JournalFile) -> None:
    """Print the writes as JSON lines, one object for each write."""
    from rosa_cli.journal_commands import export_journal

    export_journal(file)
