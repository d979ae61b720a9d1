"""Pages whose commands are run: a block of ``sh`` with, after it, a block of ``text`` of what they print."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path

from tests.rosa_cli.cli import rosa

_COMMANDS = re.compile(r"```sh\n(.*?)```\n(?:\n```text\n(.*?)```)?", re.DOTALL)


def links(text: str) -> list[str]:
    """The files that a page links to."""
    return [link for link in re.findall(r"\]\(([^)#]+)\)", text) if "://" not in link]


def untrue_commands(text: str, cwd: Path) -> Iterator[str]:
    """What a page's ``rosa`` commands print otherwise than it shows; ``...`` stands for any lines.

    The events of a mission, which go to standard error, come first.
    """
    for commands, shown in _COMMANDS.findall(text):
        printed = ""
        for line in commands.splitlines():
            if line.startswith("rosa "):
                process = rosa(*shlex.split(line)[1:], cwd=cwd)
                printed += process.stderr + process.stdout
        difference = _difference(printed, shown)
        if difference is not None:
            yield f"{commands}{difference}\n--\n{printed}"


def _difference(printed: str, shown: str) -> str | None:
    """The first line that is shown and was not printed in its place."""
    lines = iter([line.rstrip() for line in printed.splitlines()])
    exactly = True
    for wanted in shown.splitlines():
        if wanted == "...":
            exactly = False
            continue
        found = next(lines, None) if exactly else next((line for line in lines if line == wanted), None)
        if found != wanted:
            return f"shown: {wanted}\nprinted: {found}"
        exactly = True
    return None
