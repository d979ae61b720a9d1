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
from rosa_cli.command_groups import CommandGroups, titled
from rosa_cli.exit_codes import ExitCode

DISTRIBUTION = "rosa-coadaptation"

app = typer.Typer(
    name="rosa",
    help="Robots that adapt their task and their architecture together.",
    no_args_is_help=True,
    cls=CommandGroups,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for group, title in (
    (model_group, "Knowledge models"),
    (mission_group, "Missions"),
    (evaluation_group, "Many runs"),
):
    app.add_typer(titled(group.app, title))
app.add_typer(titled(journal_group.app, "Commands", "journal"), name="journal", rich_help_panel="Knowledge models")
app.add_typer(titled(streams_command.app, "Commands", "streams"), name="streams", rich_help_panel="Missions")


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
        code = app(standalone_mode=False)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader went away (rosa ... | head); there is nobody to complain to.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(ExitCode.BROKE_OFF)
    except KeyboardInterrupt:
        sys.exit(ExitCode.INTERRUPTED)
    except Exception as error:
        sys.exit(_refused(error))
    sys.exit(code if isinstance(code, int) else ExitCode.DONE)


def _refused(error: Exception) -> int:
    """Print what is wrong with the input, the command line or the machine; a defect of the program is raised again."""
    # Imported only now: it takes longer than all that --help needs.
    from rosa_core.errors import RosaError, shortened, unwritable

    show = getattr(error, "show", None)
    if show is not None:
        # Click's own errors, about the command line; it prints them with the usage.
        vars(error)["message"] = shortened(str(vars(error).get("message", error)))
        show()
        return ExitCode.BAD_INPUT
    if isinstance(error, OSError) and error.strerror:
        error = unwritable(error.filename or "the output", error, "may you read and write there?")
    if not isinstance(error, RosaError):
        raise error
    print(f"rosa: {error}", file=sys.stderr)
    return ExitCode.BAD_INPUT


if __name__ == "__main__":
    main()
