"""Reads the YAML model files of the ROS 2 package ``system_modes`` as they are."""

from __future__ import annotations

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter
from os import PathLike
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource
from rosa_core.model.elements import ParameterValue
from rosa_simulation.system_modes.model import DEFAULT_MODE, INACTIVE, NodePart, PartState, SystemModes, SystemPart

_PARAMETERS = "ros__parameters"
_FIELDS = {"system": ("type", "parts", "modes", "rules"), "node": ("type", "modes")}
_DEEPEST = 20
_FORM = "it looks like 'NAME: {ros__parameters: {type: node, modes: {__DEFAULT__: {ros__parameters: {KEY: VALUE}}}}}'"


def load_system_modes(path: str | PathLike[str]) -> SystemModes:
    """Read a file of the form ``<name>: {ros__parameters: {type: system | node, parts: ..., modes: ...}}``.

    The parts of a system stand in a list, or bare, one a line. A system's mode says of each part ``inactive``,
    ``active`` or ``active.MODE``; a node's mode has ``ros__parameters`` of its own. Names may begin with a slash.
    ``rules`` for systems whose parts deviate from their mode are passed over: a managed system reports no deviations.

    Raises:
        InputError: if the file is not of that form, a part or mode is not there, or systems contain each other; every
            problem with file, line and hint.
    """
    return _Reader(YamlSource(path)).read()


class _Reader:
    """Collects the parts of one file, and what is wrong with them."""

    def __init__(self, source: YamlSource) -> None:
        self._source = source
        self._problems: list[Problem] = []
        self._parts: dict[str, SystemPart | NodePart] = {}
        self._keys: dict[str, str] = {}

    def read(self) -> SystemModes:
        data = self._source.data
        if not isinstance(data, dict) or not data:
            raise InputError(Problem("not a system modes file", Location(self._source.file, 1), _FORM))
        for key, content in data.items():
            self._part(str(key), content)
        self._raise_problems()
        for part in self._parts.values():
            if isinstance(part, SystemPart):
                self._check_system(part)
        self._raise_problems()
        self._check_depth()
        return SystemModes(self._parts)

    def _raise_problems(self) -> None:
        if self._problems:
            raise InputError(self._problems)

    def _wrong(self, what: str, at: KeyPath, hint: str | None = None) -> None:
        self._problems.append(Problem(what, self._source.location(at), hint))

    def _part(self, key: str, content: object) -> None:
        name = key.lstrip("/")
        at: KeyPath = (key, _PARAMETERS)
        fields = content.get(_PARAMETERS) if isinstance(content, dict) else None
        if not isinstance(fields, dict):
            return self._wrong(f"'{key}' has no '{_PARAMETERS}' mapping", (key,), _FORM)
        kind = fields.get("type")
        if not isinstance(kind, str) or kind not in _FIELDS:
            return self._wrong(f"'{key}' is of type {kind!r}", (*at, "type"), "write 'type: system' or 'type: node'")
        for field in fields:
            if field not in _FIELDS[kind]:
                hint = nearest(str(field), _FIELDS[kind]) or f"a {kind} has {', '.join(_FIELDS[kind])}"
                self._wrong(f"'{field}' means nothing in {kind} '{key}'", (*at, field), hint)
        if name in self._keys:
            return self._wrong(f"'{key}' and '{self._keys[name]}' are the same part", (key,), "merge or rename one")
        self._keys[name] = key
        modes = fields.get("modes")
        if not isinstance(modes, dict) or DEFAULT_MODE not in modes:
            return self._wrong(f"'{key}' has no mode {DEFAULT_MODE}", (*at, "modes"), "every part needs one")
        at = (*at, "modes")
        if kind == "node":
            self._parts[name] = NodePart(name, {str(m): self._settings(c, (*at, m)) for m, c in modes.items()})
        else:
            parts = self._names(fields.get("parts"), (*at[:-1], "parts"))
            states = {str(m): self._states(c, (*at, m)) for m, c in modes.items()}
            self._parts[name] = SystemPart(name, parts, states)
        return None

    def _names(self, raw: object, at: KeyPath) -> tuple[str, ...]:
        # Bare names, one a line, are one scalar with spaces in it.
        names = raw.split() if isinstance(raw, str) else raw
        if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
            self._wrong("a system needs parts", at, "name systems or nodes under 'parts:'")
            return ()
        return tuple(name.lstrip("/") for name in names)

    def _states(self, raw: object, at: KeyPath) -> dict[str, PartState]:
        if not isinstance(raw, dict):
            self._wrong(
                f"mode '{at[-1]}' says nothing about parts", at, "write 'PART: inactive' or 'PART: active.MODE'"
            )
            return {}
        states = {}
        for part, text in raw.items():
            state = _state(text)
            if state is None:
                self._wrong(f"'{part}: {text}' is no state", (*at, part), "write inactive, active or active.MODE")
            else:
                states[str(part).lstrip("/")] = state
        return states

    def _settings(self, raw: object, at: KeyPath) -> dict[str, ParameterValue]:
        parameters = raw.get(_PARAMETERS) if isinstance(raw, dict) else None
        if not isinstance(parameters, dict):
            self._wrong(f"mode '{at[-1]}' has no '{_PARAMETERS}' mapping", at, f"write '{_PARAMETERS}: {{KEY: VALUE}}'")
            return {}
        return dict(self._flat(parameters, (*at, _PARAMETERS), ""))

    def _flat(self, parameters: Mapping[Any, object], at: KeyPath, prefix: str) -> list[tuple[str, ParameterValue]]:
        """Parameters by their full names: ROS writes ``a.b`` for a parameter b of a group a."""
        found: list[tuple[str, ParameterValue]] = []
        for key, raw in parameters.items():
            if isinstance(raw, dict):
                found += self._flat(raw, (*at, key), f"{prefix}{key}.")
                continue
            value = _value(raw)
            if value is None:
                what = f"{prefix}{key} is {raw!r}"
                self._wrong(what, (*at, key), "write a boolean, a number, text, or a list of one of these")
            else:
                found.append((f"{prefix}{key}", value))
        return found

    def _check_system(self, system: SystemPart) -> None:
        at: KeyPath = (self._keys[system.name], _PARAMETERS)
        for name in system.parts:
            if name not in self._parts:
                hint = nearest(name, self._parts) or f"there are: {', '.join(self._parts)}"
                self._wrong(f"'{system.name}' has an unknown part '{name}'", (*at, "parts"), hint)
        for mode, states in system.modes.items():
            for name, state in states.items():
                self._check_state(system, name, state, (*at, "modes", mode, name))

    def _check_state(self, system: SystemPart, name: str, state: PartState, at: KeyPath) -> None:
        part = self._parts.get(name)
        if name not in system.parts:
            hint = nearest(name, system.parts) or f"its parts are {', '.join(system.parts)}"
            self._wrong(f"'{name}' is no part of '{system.name}'", at, hint)
        elif part is not None and state.active and state.mode not in part.modes:
            hint = nearest(state.mode, part.modes) or f"its modes are {', '.join(part.modes)}"
            self._wrong(f"'{name}' has no mode '{state.mode}'", at, hint)

    def _check_depth(self) -> None:
        systems = {part.name: part.parts for part in self._parts.values() if isinstance(part, SystemPart)}
        depth: dict[str, int] = {}
        try:
            for name in TopologicalSorter(systems).static_order():
                depth[name] = 1 + max((depth[part] for part in systems.get(name, ())), default=0)
                if depth[name] > _DEEPEST:
                    at = self._source.location((self._keys[name],))
                    raise InputError(Problem(f"'{name}' is nested too deeply", at, f"at most {_DEEPEST} levels"))
        except CycleError as error:
            first, *others = error.args[1]
            where = self._source.location((self._keys[first],))
            what = f"'{first}' is a part of itself, by way of {', '.join(others)}"
            raise InputError(Problem(what, where, "take it out of one of them")) from None


def _state(text: object) -> PartState | None:
    if text == "inactive":
        return INACTIVE
    if text == "active":
        return PartState(True)
    if isinstance(text, str) and text.startswith("active."):
        return PartState(True, text.removeprefix("active."))
    return None


def _value(raw: object) -> ParameterValue | None:
    if isinstance(raw, bool | int | float | str):
        return raw
    same = isinstance(raw, list) and raw and len({type(item) for item in raw}) == 1
    return tuple(raw) if same and isinstance(raw, list) and isinstance(raw[0], bool | int | float | str) else None
