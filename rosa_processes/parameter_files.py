"""Parameters as files and texts that programs read."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

from rosa_core.model.elements import ParameterValue


def as_text(value: ParameterValue) -> str:
    """A value as it stands in an argument or an environment file.

    >>> as_text(True), as_text(2.0), as_text("wide"), as_text((1, 2))
    ('true', '2.0', 'wide', '1,2')
    """
    if isinstance(value, tuple | list):
        return ",".join(map(as_text, value))
    return str(value).lower() if isinstance(value, bool) else str(value)


def as_json_line(parameters: Mapping[str, ParameterValue]) -> str:
    """All of them as one line.

    >>> as_json_line({"rate": 10})
    '{"rate": 10}\\n'
    """
    return json.dumps(dict(parameters)) + "\n"


def as_environment(parameters: Mapping[str, ParameterValue]) -> str:
    """Lines ``KEY="VALUE"``, as systemd reads them from an ``EnvironmentFile``.

    Raises:
        ValueError: if a key is no name of a variable, or a value has a line break.
    """
    lines = []
    for key, value in parameters.items():
        text = as_text(value)
        if not key.isidentifier() or "\n" in text:
            raise ValueError(f"parameter '{key}' cannot be written to an environment file")
        escaped = "".join(f"\\{char}" if char in '"\\$`' else char for char in text)
        lines.append(f'{key}="{escaped}"\n')
    return "".join(lines)


def replace_file(file: Path, text: str) -> None:
    """Write a file so that nobody ever reads half of it.

    Raises:
        OSError: if it cannot be written.
    """
    beside = file.with_name(f".{file.name}.{os.getpid()}")
    beside.write_text(text, encoding="utf-8")
    beside.replace(file)
