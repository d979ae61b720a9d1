"""What pydantic finds wrong with a file, in words: each thing once, with its place and a hint."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, get_args, get_origin, get_type_hints

from pydantic import BaseModel, RootModel, ValidationError

from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath

_LONGEST_SHOWN = 60


class MisfitError(ValueError):
    """Raised by a validator of a model; whoever reads the file adds file and line.

    Args:
        what: is wrong.
        hint: how to fix it.
    """

    def __init__(self, what: str, hint: str | None = None) -> None:
        super().__init__(what)
        self.what, self.hint = what, hint


def problems_of(
    error: ValidationError, data: Any, model: Any, where: Location | Callable[[KeyPath], Location]
) -> list[Problem]:
    """What pydantic found wrong with the data, each thing once, with its place.

    Args:
        error: what pydantic raised.
        data: what it was to check, for the names and values that are quoted.
        model: what the data was to fit, for the keys that there are.
        where: the place of everything, or a function from a path in the data to its place.

    Returns:
        the problems in pydantic's order; where a value fits none of several types, only what came furthest.
    """
    found: dict[tuple[KeyPath, str], list[Problem]] = {}
    errors = [(path_in(details["loc"], data), details) for details in error.errors(include_url=False)]
    above = {path[:length] for path, _ in errors for length in range(len(path))}
    for path, details in errors:
        if details["type"].endswith("_type") and path in above:
            # Another kind that the value may be of came further.
            continue
        at = where if isinstance(where, Location) else where(path)
        whole = "it" if at is where else "the file"
        problem = _problem(details, path, whole, at, _known_keys(model, details["loc"]))
        found.setdefault((path, problem.what), []).append(problem)
    return [_together(problems) for problems in found.values()]


def _together(problems: list[Problem]) -> Problem:
    """Where a value may be of several kinds, it is wrong in several ways, which is one problem."""
    hints = dict.fromkeys(problem.hint for problem in problems if problem.hint)
    return Problem(problems[0].what, problems[0].where, ", or ".join(hints) or None)


def path_in(loc: tuple[str | int, ...], data: Any) -> KeyPath:
    """The part of pydantic's location that is a path in the file: members of unions and the like are not.

    Args:
        loc: pydantic's location of an error.
        data: what was checked.

    Returns:
        keys as they are in the data, so a number where a name is one, and indices.

    Example:
        >>> path_in(("goals", "list[str]", 1), {"goals": ["a", 2]})
        ('goals', 1)
    """
    path: list[str | int] = []
    for step in loc:
        if isinstance(data, dict):
            # Names may be numbers in the file.
            key = step if step in data else next((known for known in data if str(known) == str(step)), None)
        else:
            key = step if isinstance(data, list) and isinstance(step, int) and 0 <= step < len(data) else None
        if key is not None:
            data = data[key]
            path.append(key)
    return tuple(path)


def _known_keys(model: Any, loc: tuple[str | int, ...]) -> list[str]:
    """The keys that may stand where the last key of a location stands."""
    kinds = [model]
    for step in loc[:-1]:
        kinds = [inner for kind in kinds for inner in _inside(kind, step)] or kinds
    return list(dict.fromkeys(key for kind in kinds for key in _fields(kind)))


def _unwrapped(kind: Any) -> Any:
    """A root model is what it is made of."""
    is_root = isinstance(kind, type) and issubclass(kind, RootModel)
    return get_type_hints(kind, include_extras=True)["root"] if is_root else kind


def _fields(kind: Any) -> Iterator[str]:
    kind = _unwrapped(kind)
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield from (field.alias or name for name, field in kind.model_fields.items())
    elif get_origin(kind) not in (dict, list, tuple, Mapping):
        for member in get_args(kind):
            yield from _fields(member)


def _inside(kind: Any, step: str | int) -> Iterator[Any]:
    """The types of what stands at a step within a type; none if the step is the name of a union's member."""
    kind = _unwrapped(kind)
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield from (field.annotation for name, field in kind.model_fields.items() if step in (name, field.alias))
    elif get_origin(kind) in (dict, list, Mapping):
        yield get_args(kind)[-1]
    elif get_origin(kind) is tuple:
        yield get_args(kind)[0]
    else:
        for member in get_args(kind):
            yield from _inside(member, step)


def _problem(details: Any, path: KeyPath, whole: str, at: Location, known: list[str]) -> Problem:
    parts = [str(part) for part in path]
    what = " / ".join(parts) or whole
    kind, given = details["type"], details["input"]
    if kind == "extra_forbidden":
        hint = nearest(parts[-1], known) or f"allowed here: {', '.join(known)}"
        return Problem(f"unknown key '{parts[-1]}' in {' / '.join(parts[:-1]) or whole}", at, hint)
    if kind == "missing":
        return Problem(f"{what} has no '{details['loc'][-1]}'", at, f"add '{details['loc'][-1]}:'")
    if kind == "value_error" and isinstance(details["ctx"]["error"], MisfitError):
        error = details["ctx"]["error"]
        return Problem(error.what, at, error.hint)
    if kind in ("enum", "literal_error"):
        return Problem(f"{what} is {_shown(given)}", at, expected_by(details))
    if given is None:
        return Problem(f"{what} is empty", at, expected_by(details))
    shown = "" if isinstance(given, dict | list) else f" {_shown(given)}"
    return Problem(f"{what}:{shown} does not fit here", at, expected_by(details))


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= _LONGEST_SHOWN else f"{text[: _LONGEST_SHOWN - 3]}..."


_EXPECTED = {
    **dict.fromkeys(("float_type", "float_parsing"), "a number is expected"),
    **dict.fromkeys(("int_type", "int_from_float", "int_parsing"), "a whole number is expected"),
    **dict.fromkeys(("list_type", "tuple_type"), "a list is expected: [a, b] or lines with '- '"),
    **dict.fromkeys(
        ("dict_type", "mapping_type", "model_type", "dataclass_type"),
        "a mapping is expected: 'key: value' lines, indented",
    ),
    "finite_number": "a finite number is expected",
    "bool_type": "true or false is expected",
    "bool_parsing": "true or false is expected",
    "string_type": "text is expected; put quotes round a number or yes/no",
    "string_too_short": "text is expected",
    "greater_than": "a number above {gt:g} is expected",
    "greater_than_equal": "a number from {ge:g} up is expected",
    "less_than_equal": "a number up to {le:g} is expected",
    "too_short": "at least {min_length} expected",
    "too_long": "at most {max_length} expected",
    "enum": "it must be {expected}",
    "literal_error": "it must be {expected}",
    "union_tag_invalid": "{discriminator} must be one of {expected_tags}",
    "union_tag_not_found": "{discriminator} is missing",
}


def expected_by(details: Any) -> str:
    """What is expected instead of the value that one of pydantic's errors is about."""
    context = details.get("ctx", {})
    if details["type"] == "value_error":
        error = context["error"]
        return (error.hint if isinstance(error, MisfitError) else None) or str(error)
    form = _EXPECTED.get(details["type"])
    return str(details["msg"]) if form is None else form.format(**context)
