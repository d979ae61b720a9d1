"""YAML from outside: safe, with the line of every value, and no way to make a small file cost much."""

from __future__ import annotations

import re
from os import PathLike
from typing import Any

import yaml

from rosa_core.errors import InputError, Location, Problem
from rosa_core.formats.text_source import read_text

_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DEEPEST = 50
_EXPANSION = 10
_LARGEST_INTEGER = 2**63

_EXPONENT = re.compile(r"[-+]?[0-9]+[eE][-+]?[0-9]+")

KeyPath = tuple[str | int, ...]


class YamlSource:
    """One parsed YAML file: ``data`` as plain Python values, and where each of them stands.

    Raises:
        InputError: if the file cannot be read, is not YAML, or repeats a key.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        self.file = str(path)
        self.problems: list[Problem] = []
        self._lines: dict[KeyPath, int] = {}
        self._budget = 0
        self._constructor = yaml.constructor.SafeConstructor()
        root = self._compose(read_text(path))
        self.data: Any = None if root is None else self._value(root, ())
        if self.problems:
            raise InputError(self.problems)

    def location(self, path: KeyPath) -> Location:
        """Where the value at ``path`` stands (for a mapping's value: the line of its key)."""
        while path and path not in self._lines:
            path = path[:-1]
        return Location(self.file, self._lines.get(path, 1))

    def part(self, path: KeyPath) -> Any:
        """The value at a path, which must be there."""
        data = self.data
        for step in path:
            data = data[step]
        return data

    def _compose(self, text: str) -> yaml.Node | None:
        try:
            self._survey(text)
            node: yaml.Node | None = yaml.compose(text, Loader=_Loader)
        except yaml.MarkedYAMLError as error:
            line = None if error.problem_mark is None else error.problem_mark.line + 1
            what = " ".join(filter(None, (error.context, error.problem)))
            raise InputError(Problem(f"not valid YAML: {what}", Location(self.file, line))) from None
        except (yaml.YAMLError, RecursionError) as error:
            what = " ".join(str(error).split())[:200] or "nested too deeply"
            raise InputError(Problem(f"not valid YAML: {what}", Location(self.file))) from None
        return node

    def _survey(self, text: str) -> None:
        """Look through the file without building anything: composing recurses, and aliases multiply."""
        depth = nodes = 0
        for event in yaml.parse(text, Loader=_Loader):
            if isinstance(event, yaml.CollectionStartEvent):
                depth += 1
                if depth > _DEEPEST:
                    raise self._excessive(event.start_mark.line + 1 if event.start_mark else None)
            elif isinstance(event, yaml.CollectionEndEvent):
                depth -= 1
            nodes += isinstance(event, yaml.NodeEvent)
        self._budget = _EXPANSION * nodes

    def _excessive(self, line: int | None) -> InputError:
        what = "it is nested too deeply, or its aliases expand to too much"
        return InputError(Problem(what, Location(self.file, line), f"at most {_DEEPEST} levels"))

    def _value(self, node: yaml.Node, path: KeyPath) -> Any:
        self._lines.setdefault(path, node.start_mark.line + 1)
        self._budget -= 1
        if self._budget < 0 or len(path) > _DEEPEST:
            raise self._excessive(node.start_mark.line + 1)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, path)
        if isinstance(node, yaml.SequenceNode):
            return [self._value(item, (*path, index)) for index, item in enumerate(node.value)]
        return self._scalar(node)

    def _mapping(self, node: yaml.MappingNode, path: KeyPath) -> dict[Any, Any]:
        mapping: dict[Any, Any] = {}
        names: dict[str, str | int] = {}
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            key = self._scalar(key_node) if isinstance(key_node, yaml.ScalarNode) else None
            if not isinstance(key, str | int):
                self.problems.append(Problem("a key must be a plain word or number", Location(self.file, line)))
                continue
            if str(key) in names:
                first = self._lines[(*path, names[str(key)])]
                what = f"'{key}' stands twice; it is already in line {first}"
                self.problems.append(Problem(what, Location(self.file, line), "merge or rename one"))
                continue
            names[str(key)] = key
            self._lines[(*path, key)] = line
            mapping[key] = self._value(value_node, (*path, key))
        return mapping

    def _scalar(self, node: yaml.Node) -> Any:
        try:
            if isinstance(node, yaml.ScalarNode) and not node.style and _EXPONENT.fullmatch(node.value):
                # JSON and YAML 1.2 take 1e-3 for a number; YAML 1.1 wants 1.0e-3.
                return float(node.value)
            value = self._constructor.construct_object(node)
            if isinstance(value, int) and not -_LARGEST_INTEGER <= value < _LARGEST_INTEGER:
                raise ValueError("an integer of more than 64 bits")
            return value
        # PyYAML's constructors fail on values such as "!!int ''" in whatever way it comes.
        except (yaml.YAMLError, ValueError, TypeError, LookupError, AttributeError, OverflowError):
            where = Location(self.file, node.start_mark.line + 1)
            what = f"{str(node.value)[:60]!r} cannot be read as {node.tag.rpartition(':')[2]}"
            self.problems.append(Problem(what, where, "write a plain value, quoted if it is text"))
            return None
