"""Options that belong together, declared once as the fields of a frozen dataclass."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, get_type_hints


def expand_options(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose parameters that are dataclasses are replaced by the fields of these.

    Typer reads the options off the result's signature; when it calls it, the dataclasses are made again.

    Args:
        command: a function with annotated parameters; a field of a dataclass is annotated as a parameter would be.

    Returns:
        the function to be registered as a command.

    Example:
        >>> from dataclasses import dataclass
        >>> @dataclass(frozen=True)
        ... class Range:
        ...     low: int
        ...     high: int = 9
        >>> def show(name: str, limits: Range) -> None:
        ...     print(name, limits)
        >>> expand_options(show)(name="x", low=1, high=2)
        x Range(low=1, high=2)
        >>> str(inspect.signature(expand_options(show)))
        '(*, name: str, low: int, high: int = 9)'
    """
    parameters: list[inspect.Parameter] = []
    groups: dict[str, type] = {}
    hints = get_type_hints(command, include_extras=True)
    for parameter in inspect.signature(command).parameters.values():
        annotation = hints[parameter.name]
        if isinstance(annotation, type) and is_dataclass(annotation):
            groups[parameter.name] = annotation
            parameters += inspect.signature(annotation, eval_str=True).parameters.values()
        else:
            parameters.append(parameter.replace(annotation=annotation))

    def expanded(**values: Any) -> None:
        for name, group in groups.items():
            values[name] = group(**{field.name: values.pop(field.name) for field in fields(group)})
        command(**values)

    keyword_only = [parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY) for parameter in parameters]
    expanded.__name__, expanded.__doc__ = command.__name__, command.__doc__
    expanded.__annotations__ = {parameter.name: parameter.annotation for parameter in keyword_only}
    expanded.__dict__["__signature__"] = inspect.Signature(keyword_only)
    return expanded
