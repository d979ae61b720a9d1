"""Reads the YAML model files of the ROS 2 package ``system_modes`` as they are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from os import PathLike
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, Discriminator, Field, RootModel, Tag

from rosa_core.errors import nearest
from rosa_core.formats.checked_file import CheckedFile, Entry, Name, Text, read_yaml_file
from rosa_core.model.elements import ParameterValue
from rosa_simulation.system_modes.model import DEFAULT_MODE, INACTIVE, NodePart, PartState, SystemModes, SystemPart

_DEEPEST = 20
_FORM = "it looks like 'NAME: {ros__parameters: {type: node, modes: {__DEFAULT__: {ros__parameters: {KEY: VALUE}}}}}'"


def _value(raw: object) -> ParameterValue:
    if isinstance(raw, bool | int | float | str):
        return raw
    if (
        isinstance(raw, list)
        and len({type(item) for item in raw}) == 1
        and isinstance(raw[0], bool | int | float | str)
    ):
        return tuple(raw)
    raise ValueError("write a boolean, a number, text, or a list of one of these")


def _state(text: object) -> PartState:
    if text == "inactive":
        return INACTIVE
    if text == "active":
        return PartState(True)
    if isinstance(text, str) and text.startswith("active."):
        return PartState(True, text.removeprefix("active."))
    raise ValueError("write inactive, active or active.MODE")


def _with_default(modes: dict[str, Any]) -> dict[str, Any]:
    if DEFAULT_MODE not in modes:
        raise ValueError(f"every part needs a mode {DEFAULT_MODE}")
    return modes


_PartName = Annotated[Text, AfterValidator(lambda name: name.lstrip("/"))]
_HAS_DEFAULT = AfterValidator(_with_default)
# Bare names, one a line, are one scalar with spaces in it.
_SPLIT = BeforeValidator(lambda names: names.split() if isinstance(names, str) else names)


class _Tree(RootModel[Any]):
    """Parameters in groups within groups, or one parameter's value."""

    root: Annotated[
        Annotated[dict[Name, _Tree], Tag("group")] | Annotated[Any, AfterValidator(_value), Tag("value")],
        Discriminator(lambda raw: "group" if isinstance(raw, dict) else "value"),
    ]


class _Settings(BaseModel):
    parameters: dict[Name, _Tree] = Field(alias="ros__parameters")


class _NodeEntry(Entry):
    type: Literal["node"]
    modes: Annotated[dict[Name, _Settings], _HAS_DEFAULT]


class _SystemEntry(Entry):
    type: Literal["system"]
    parts: Annotated[tuple[_PartName, ...], _SPLIT, Field(min_length=1)]
    modes: Annotated[dict[Name, dict[_PartName, Annotated[Any, AfterValidator(_state)]]], _HAS_DEFAULT]
    rules: Any = None


class _PartEntry(BaseModel):
    fields: _NodeEntry | _SystemEntry = Field(alias="ros__parameters", discriminator="type")


_File = CheckedFile[dict[str, _PartEntry]]


def load_system_modes(path: str | PathLike[str]) -> SystemModes:
    """Read a file of the form ``<name>: {ros__parameters: {type: system | node, parts: ..., modes: ...}}``.

    The parts of a system stand in a list, or bare, one a line. A system's mode says of each part ``inactive``,
    ``active`` or ``active.MODE``; a node's mode has ``ros__parameters`` of its own. Names may begin with a slash.
    ``rules`` for systems whose parts deviate from their mode are passed over: a managed system reports no deviations.

    Args:
        path: the file.

    Raises:
        InputError: if the file is not of that form, a part or mode is not there, or systems contain each other; every
            problem with file, line and hint.
    """
    file = read_yaml_file(path, dict[Name, _PartEntry], "a system modes file", _FORM)
    keys: dict[str, str] = {}
    parts: dict[str, SystemPart | NodePart] = {}
    for key, entry in file.content.items():
        name = key.lstrip("/")
        if name in keys:
            file.refuse(f"'{key}' and '{keys[name]}' are the same part", "merge or rename one", key)
        keys[name] = key
        parts[name] = _part(name, entry.fields)
    for part in parts.values():
        if isinstance(part, SystemPart):
            _check_system(part, keys[part.name], parts, file)
    file.raise_problems()
    _check_depth(parts, keys, file)
    file.raise_problems()
    return SystemModes(parts)


def _part(name: str, entry: _NodeEntry | _SystemEntry) -> SystemPart | NodePart:
    if isinstance(entry, _SystemEntry):
        return SystemPart(name, entry.parts, entry.modes)
    return NodePart(name, {mode: dict(_flat(settings.parameters, "")) for mode, settings in entry.modes.items()})


def _flat(parameters: Mapping[str, _Tree], prefix: str) -> Iterator[tuple[str, ParameterValue]]:
    """Parameters by their full names: ROS writes ``a.b`` for a parameter b of a group a."""
    for key, tree in parameters.items():
        if isinstance(tree.root, dict):
            yield from _flat(tree.root, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", tree.root


def _check_system(system: SystemPart, key: str, parts: Mapping[str, SystemPart | NodePart], file: _File) -> None:
    for name in system.parts:
        if name not in parts:
            hint = nearest(name, parts) or f"there are: {', '.join(parts)}"
            file.refuse(f"'{system.name}' has an unknown part '{name}'", hint, key, "ros__parameters", "parts")
    for mode, states in system.modes.items():
        for name, state in states.items():
            at = (key, "ros__parameters", "modes", mode, name)
            part = parts.get(name)
            if name not in system.parts:
                hint = nearest(name, system.parts) or f"its parts are {', '.join(system.parts)}"
                file.refuse(f"'{name}' is no part of '{system.name}'", hint, *at)
            elif part is not None and state.active and state.mode not in part.modes:
                hint = nearest(state.mode, part.modes) or f"its modes are {', '.join(part.modes)}"
                file.refuse(f"'{name}' has no mode '{state.mode}'", hint, *at)


def _check_depth(parts: Mapping[str, SystemPart | NodePart], keys: Mapping[str, str], file: _File) -> None:
    systems = {part.name: part.parts for part in parts.values() if isinstance(part, SystemPart)}
    depth: dict[str, int] = {}
    try:
        for name in TopologicalSorter(systems).static_order():
            depth[name] = 1 + max((depth[part] for part in systems.get(name, ())), default=0)
            if depth[name] == _DEEPEST + 1:
                file.refuse(f"'{name}' is nested too deeply", f"at most {_DEEPEST} levels", keys[name])
    except CycleError as error:
        first, *others = error.args[1]
        what = f"'{first}' is a part of itself, by way of {', '.join(others)}"
        file.refuse(what, "take it out of one of them", keys[first])
