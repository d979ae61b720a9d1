"""The list of commands in ``rosa --help``, in groups, and the example below each command's help."""

from __future__ import annotations

from typing import Any

import typer
from typer.core import TyperGroup

from rosa_cli.examples import EXAMPLES


class CommandGroups(TyperGroup):
    """A command whose sub-commands are listed under the titles that :func:`titled` gave them."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the sub-commands, a section for each title, in the order in which they were added."""
        sections: dict[str, list[Any]] = {}
        for name in self.list_commands(ctx):
            command = self.get_command(ctx, name)
            if command is not None and not command.hidden:
                title = getattr(command, "rich_help_panel", None)
                sections.setdefault(title if isinstance(title, str) else "Commands", []).append((name, command))
        widest = max((len(name) for section in sections.values() for name, _ in section), default=0)
        room = formatter.width - 6 - widest
        for title, commands in sections.items():
            with formatter.section(title):
                formatter.write_dl([(name, command.get_short_help_str(room)) for name, command in commands])


def titled(commands: typer.Typer, title: str, prefix: str = "") -> typer.Typer:
    """The commands, to be listed under a title, each with its example.

    Args:
        commands: some that belong together.
        title: of what they are about.
        prefix: what stands before them on the command line, such as ``journal``.
    """
    for command in commands.registered_commands:
        name = f"{prefix} {command.name or getattr(command.callback, '__name__', '')}".strip()
        command.rich_help_panel = title
        command.epilog = f"Example: {EXAMPLES[name]}" if name in EXAMPLES else None
    return commands
