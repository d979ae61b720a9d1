"""Files from outside, checked against a pydantic model: all that is wrong is reported with file, line and hint.

The one way in for what people and other programs write: YAML (:func:`read_yaml_file`), JSON (:func:`read_json`),
records such as the rows of a table (:func:`checked`) and single values (:func:`value_reader`). Models are made of
:class:`Entry` and the types below; what no type can say, such as that two names belong together, is checked afterwards
and collected with :meth:`CheckedFile.refuse`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from os import PathLike
from typing import Annotated, Any, Generic, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WrapValidator,
)

from rosa_core.errors import InputError, Location, Problem
from rosa_core.formats.misfits import expected_by, path_in, problems_of
from rosa_core.formats.text_source import read_text
from rosa_core.formats.yaml_source import KeyPath, YamlSource

Content = TypeVar("Content")


class Entry(BaseModel):
    """A mapping in a file; keys that it has no field for are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def within(low: float = -math.inf, high: float = math.inf) -> WrapValidator:
    """The range that a number must be in, both ends included.

    Args:
        low: the least that is allowed; by default there is no least.
        high: the most that is allowed; by default there is no most.

    Returns:
        what to annotate a number's type with; the range is named in what is said of a number outside it.

    Example:
        >>> share = value_reader(Annotated[Number, within(0, 1)])
        >>> share(0.5)
        0.5
        >>> share(2)
        Traceback (most recent call last):
        ValueError: a number from 0 to 1 is expected
    """
    if low == -math.inf:
        allowed = "" if high == math.inf else f" up to {high:g}"
    else:
        allowed = f" from {low:g}" + (" up" if high == math.inf else f" to {high:g}")

    def check(value: object, read: ValidatorFunctionWrapHandler) -> float:
        try:
            number: float = read(value)
        except ValidationError as error:
            expected = expected_by(error.errors(include_url=False)[0])
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
        return self._source.location(path_in((*self._at, *path), self._source.data))

    def refuse(self, what: str, hint: str | None, *path: str | int) -> None:
        """Add something that is wrong at a path; it is raised with the others when the check ends.

        Args:
            what: is wrong, without the place.
            hint: how to fix it, if that is known.
            path: keys and indices from the content's place on; the line of the last one is named.
        """
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

    Args:
        source: the parsed file.
        at: keys and indices from the top of the file to the part.
        model: what it must fit.
        kind: what it should be, with its article, such as ``a map``; said when it is no mapping at all.
        form: the hint for that case: what such a part looks like.

    Returns:
        the part, with paths counted from it.

    Raises:
        InputError: if it does not fit.
    """
    data = source.part(at)
    if not isinstance(data, dict) or not data:
        raise InputError(Problem(f"not {kind}", source.location(at), form))
    return CheckedFile(source, checked(data, model, lambda path: source.location((*at, *path))), at)


def read_json(path: str | PathLike[str], model: type[Content]) -> Content:
    """Read a file in JSON, and check it against a model.

    Args:
        path: of the file.
        model: a pydantic model.

    Returns:
        the model's instance.

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

    Args:
        text: the JSON.
        where: named in the error; without a line, the line within the text is.

    Returns:
        plain dictionaries, lists and scalars, unchecked.

    Raises:
        InputError: if it is none.
    """
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        line = error.lineno if where.line is None else where.line
        raise InputError(Problem(f"not valid JSON: {error.msg}", Location(where.file, line))) from None
    except (ValueError, RecursionError) as error:
        raise InputError(Problem(f"not valid JSON: {str(error)[:60]}", where)) from None


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
        raise InputError(problems_of(error, data, model, where)) from None


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
            raise ValueError(expected_by(error.errors(include_url=False)[0])) from None

    return read


@lru_cache(maxsize=128)
def _adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)
