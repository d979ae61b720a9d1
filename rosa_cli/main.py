"""The ``rosa`` command: its groups of sub-commands, and what becomes of errors.

The groups only declare arguments and options; what a sub-command needs is imported when it is called, so that
``rosa --help`` answers at once.
"""

from __future__ import annotations

import os
import sys
from typing import Annotated

import typer

from rosa_cli import evaluation_group, journal_group, mission_group, model_group, streams_command
from rosa_cli.exit_codes import ExitCode

DISTRIBUTION = "rosa-coadaptation"

app = typer.Typer(
    name="rosa",
    help="Robots that adapt their task and their architecture together.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for group in (model_group, mission_group, evaluation_group):
    app.add_typer(group.app)
app.add_typer(journal_group.app, name="journal")
app.add_typer(streams_command.app, name="streams")


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"rosa {version(DISTRIBUTION)}")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Robots that adapt their task and their architecture together."""


def main() -> None:
    """Run the command line: bad input ends with its message and exit code 2 (and typer makes 130 of Ctrl-C)."""
    try:
        app(standalone_mode=True)
    except BrokenPipeError:
        # The reader went away (rosa ... | head); there is nobody to complain to.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(ExitCode.BROKE_OFF)
    except Exception as error:
        # Imported only now: it takes longer than all that --help needs.
        from rosa_core.errors import RosaError

        if not isinstance(error, RosaError):
            raise
        print(f"rosa: {error}", file=sys.stderr)
        sys.exit(ExitCode.BAD_INPUT)


if __name__ == "__main__":
    main()
