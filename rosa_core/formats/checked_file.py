"""Files from outside, checked against a pydantic model: all that is wrong is told with file, line and hint.

The one way in for what people and other programs write: YAML (:func:`read_yaml_file`), JSON (:func:`read_json`),
records such as the rows of a table (:func:`checked`) and single values (:func:`value_reader`). Models are made of
:class:`Entry` and the types below; what no type can say, such as that two names belong together, is checked afterwards
and collected with :meth:`CheckedFile.refuse`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import lru_cache
from os import PathLike
from typing import Annotated, Any, Generic, TypeVar, get_args, get_origin, get_type_hints

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    RootModel,
    TypeAdapter,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from rosa_core.errors import InputError, Location, Problem, nearest
from rosa_core.formats.text_source import read_text
from rosa_core.formats.yaml_source import KeyPath, YamlSource

Content = TypeVar("Content")
_LONGEST_SHOWN = 60


class Entry(BaseModel):
    """A mapping in a file; keys that it has no field for are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class MisfitError(ValueError):
    """Raised by a validator of a model: what is wrong, and the hint. The door adds file and line."""

    def __init__(self, what: str, hint: str | None = None) -> None:
        super().__init__(what)
        self.what, self.hint = what, hint


def within(low: float = -math.inf, high: float = math.inf) -> WrapValidator:
    """The range that a number must be in, both ends included, such as ``Annotated[Number, within(0, 1)]``."""
    if low == -math.inf:
        allowed = "" if high == math.inf else f" up to {high:g}"
    else:
        allowed = f" from {low:g}" + (" up" if high == math.inf else f" to {high:g}")

    def check(value: object, read: ValidatorFunctionWrapHandler) -> float:
        try:
            number: float = read(value)
        except ValidationError as error:
            expected = _expected(error.errors(include_url=False)[0])
        else:
            if low <= number <= high:
                return number
            expected = f"a {'whole ' if isinstance(number, int) else ''}number is expected"
        raise ValueError(expected.replace(" is expected", f"{allowed} is expected"))

    return WrapValidator(check)


def _name(value: object) -> object:
    return str(value) if isinstance(value, int | float) and not isinstance(value, bool) else value


def _whole(value: object) -> object:
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _several(value: object) -> object:
    return value if isinstance(value, list) else [value]


Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
"""A finite number; true and false are none."""
Whole = Annotated[int, BeforeValidator(_whole), Field(strict=True)]
"""A whole number; 2.0 is one."""
Text = Annotated[str, Field(strict=True, min_length=1)]
"""Text, not empty."""
Flag = Annotated[bool, Field(strict=True)]
"""True or false."""
Name = Annotated[str, BeforeValidator(_name), Field(strict=True, min_length=1)]
"""Text, or a number, which stands for its digits."""
Names = Annotated[tuple[Name, ...], BeforeValidator(_several)]
"""One name, or a list of them."""


class CheckedFile(Generic[Content]):
    """A file that fits its model, and what has been found wrong with it since.

    Args:
        source: the parsed file.
        content: the model made of it.
        at: where in the file the content stands; paths are counted from there.
    """

    def __init__(self, source: YamlSource, content: Content, at: KeyPath = ()) -> None:
        self.content = content
        self.problems: list[Problem] = []
        self._source = source
        self._at = at

    @property
    def document(self) -> Any:
        """What stands in the file, as plain mappings, lists and scalars."""
        return self._source.part(self._at)

    def location(self, *path: str | int) -> Location:
        """File and line of what stands at a path, such as ``location("goals", 0)``."""
        return self._source.location(_in_file((*self._at, *path), self._source.data))

    def refuse(self, what: str, hint: str | None, *path: str | int) -> None:
        """Add something that is wrong at a path."""
        self.problems.append(Problem(what, self.location(*path), hint))

    @contextmanager
    def refusing(self, *path: str | int) -> Iterator[None]:
        """What an InputError or a ValueError in here says is wrong at a path, unless it says where itself."""
        try:
            yield
        except InputError as error:
            here = self.location(*path)
            self.problems += [Problem(p.what, p.where or here, p.hint) for p in error.problems]
        except ValueError as error:
            self.refuse(str(error), None, *path)

    def raise_problems(self) -> None:
        """Stop if anything is wrong.

        Raises:
            InputError: with all of it.
        """
        if self.problems:
            raise InputError(self.problems)


def read_yaml_file(path: str | PathLike[str], model: type[Content], kind: str, form: str) -> CheckedFile[Content]:
    """Read a file in YAML (or JSON) that holds a mapping.

    Args:
        path: the file.
        model: the type that it must fit.
        kind: what the file is to be, such as ``a mission``.
        form: the hint for a file that is something else, such as ``it looks like 'start: A'``.

    Raises:
        InputError: if it cannot be read or does not fit; with file, line and hint for all that is wrong.
    """
    return checked_part(YamlSource(path), (), model, kind, form)


def checked_part(source: YamlSource, at: KeyPath, model: type[Content], kind: str, form: str) -> CheckedFile[Content]:
    """What stands at a path of a parsed file, as :func:`read_yaml_file` checks a whole one.

    Raises:
        InputError: if it does not fit.
    """
    data = source.part(at)
    if not isinstance(data, dict) or not data:
        raise InputError(Problem(f"not {kind}", source.location(at), form))
    return CheckedFile(source, checked(data, model, lambda path: source.location((*at, *path))), at)


def read_json(path: str | PathLike[str], model: type[Content]) -> Content:
    """Read a file in JSON.

    Raises:
        InputError: if it cannot be read, is not JSON or does not fit.
    """

    def where(at: KeyPath) -> Location:
        # Lines are only looked up for what is wrong.
        try:
            return YamlSource(path).location(at)
        except InputError:
            return Location(str(path))

    return checked(parsed_json(read_text(path), Location(str(path))), model, where)


def parsed_json(text: str, where: Location) -> Any:
    """The value of a JSON text.

    Raises:
        InputError: if it is none.
    """
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        line = error.lineno if where.line is None else where.line
        raise InputError(Problem(f"not valid JSON: {error.msg}", Location(where.file, line))) from None
    except (ValueError, RecursionError) as error:
        raise InputError(Problem(f"not valid JSON: {str(error)[:_LONGEST_SHOWN]}", where)) from None


def checked(data: Any, model: type[Content], where: Location | Callable[[KeyPath], Location]) -> Content:
    """A plain value as a model has it.

    Args:
        data: plain mappings, lists and scalars.
        model: a pydantic model, a dataclass, or any type that pydantic understands.
        where: the place of the data, or of a path in it.

    Raises:
        InputError: for all that does not fit.

    >>> checked({"speed": 2}, dict[str, Number], Location("robot.yaml", 1))
    {'speed': 2.0}
    >>> checked({"speed": True}, dict[str, Number], Location("robot.yaml", 1))
    Traceback (most recent call last):
    rosa_core.errors.InputError: robot.yaml:1: speed: True does not fit here (a number is expected)
    """
    kind: Any = model
    adapter: TypeAdapter[Content] = _adapter(kind)
    try:
        return adapter.validate_python(data)
    except ValidationError as error:
        raise InputError(_problems(error, data, model, where)) from None


def value_reader(kind: Any) -> Callable[[object], Any]:
    """What reads one value of a kind, such as ``Number``; it raises a ValueError that says what is expected.

    >>> value_reader(Annotated[Number, within(0, 1)])(2)
    Traceback (most recent call last):
    ValueError: a number from 0 to 1 is expected
    """

    def read(raw: object) -> Any:
        try:
            return _adapter(kind).validate_python(raw)
        except ValidationError as error:
            raise ValueError(_expected(error.errors(include_url=False)[0])) from None

    return read


@lru_cache(maxsize=128)
def _adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)


# -- pydantic's errors in words --


def _problems(
    error: ValidationError, data: Any, model: Any, where: Location | Callable[[KeyPath], Location]
) -> list[Problem]:
    """What pydantic found wrong with the data, each thing once, with its place."""
    found: dict[tuple[KeyPath, str], list[Problem]] = {}
    errors = [(_in_file(details["loc"], data), details) for details in error.errors(include_url=False)]
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


def _in_file(loc: tuple[str | int, ...], data: Any) -> KeyPath:
    """The part of pydantic's location that is a path in the file: members of unions and the like are not."""
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
        return Problem(f"{what} is {_shown(given)}", at, _expected(details))
    if given is None:
        return Problem(f"{what} is empty", at, _expected(details))
    shown = "" if isinstance(given, dict | list) else f" {_shown(given)}"
    return Problem(f"{what}:{shown} does not fit here", at, _expected(details))


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


def _expected(details: Any) -> str:
    context = details.get("ctx", {})
    if details["type"] == "value_error":
        error = context["error"]
        return (error.hint if isinstance(error, MisfitError) else None) or str(error)
    form = _EXPECTED.get(details["type"])
    return str(details["msg"]) if form is None else form.format(**context)
