"""Transformations, targets, units and settings in YAML."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

from rosa_core.errors import Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource
from rosa_streams.environment import ParameterValue, Unit
from rosa_streams.errors import StreamError
from rosa_streams.specification.drafts import PortDraft, TargetDraft, TransformationDraft
from rosa_streams.specification.numbers import not_negative
from rosa_streams.tags.loading import SECTIONS, axioms_from_yaml
from rosa_streams.tags.ontology import Axioms

_TOP = ("ontology", *SECTIONS, "transformations", "targets", "units", "planning")
_TRANSFORMATION = ("source", "parameters", "inputs", "outputs", "quality", "labor", "upkeep")
_TARGET = ("tag", "channel")
_UNIT = ("transformation", "inputs", "outputs")
_PLANNING = ("horizon", "max_cost", "quality_weight")


@dataclass
class YamlSpecification:
    """What one YAML file says."""

    axioms: Axioms = field(default_factory=Axioms)
    drafts: list[TransformationDraft | TargetDraft] = field(default_factory=list)
    units: list[Unit] = field(default_factory=list)
    planning: dict[str, float] = field(default_factory=dict)


def read_yaml(file: str | PathLike[str]) -> YamlSpecification:
    """Read a YAML file with any of an ontology, transformations, targets, units and settings for planning.

    Raises:
        StreamError: with every problem that was found, each with its line.
    """
    source = YamlSource(file)
    reader = _Reader(source)
    specification = reader.whole(source.data)
    if reader.problems:
        raise StreamError(reader.problems)
    return specification


class _Reader:
    """Reads sections and collects what is wrong."""

    def __init__(self, source: YamlSource) -> None:
        self.problems: list[Problem] = []
        self._source = source

    def whole(self, data: Any) -> YamlSpecification:
        top = self._mapping(data, _TOP, ())
        result = YamlSpecification()
        if "ontology" in top:
            result.axioms = axioms_from_yaml(
                self._source, self._mapping(top["ontology"], SECTIONS, ("ontology",)), ("ontology",)
            )
        flat = {section: top[section] for section in SECTIONS if section in top}
        result.axioms = result.axioms.merged(axioms_from_yaml(self._source, flat, ()))
        for name, entry, path in self._entries(top, "transformations"):
            result.drafts.append(self._transformation(name, entry, path))
        for name, entry, path in self._entries(top, "targets"):
            result.drafts.append(self._target(name, entry, path))
        for name, entry, path in self._entries(top, "units"):
            result.units.append(self._unit(name, entry, path))
        planning = self._mapping(top.get("planning") or {}, _PLANNING, ("planning",))
        for key, value in planning.items():
            number = self._number(value, ("planning", key))
            if number is not None:
                result.planning[key] = number
        return result

    def _entries(self, top: dict[Any, Any], section: str) -> Iterable[tuple[str, Any, KeyPath]]:
        entries = top.get(section) or {}
        if not isinstance(entries, dict):
            self._problem(f"'{section}' is a mapping from names", (section,))
            return
        for name, entry in entries.items():
            yield str(name), entry, (section, name)

    def _transformation(self, name: str, entry: Any, path: KeyPath) -> TransformationDraft:
        entry = self._mapping(entry, _TRANSFORMATION, path)
        return TransformationDraft(
            name,
            self._text(entry, "source", path, default=name),
            self._ports(entry, "inputs", path),
            self._ports(entry, "outputs", path),
            self._parameters(entry, path),
            self._source.location(path),
            self._optional_number(entry, "quality", path) or 0.0,
            self._optional_number(entry, "labor", path),
            self._optional_number(entry, "upkeep", path),
        )

    def _target(self, name: str, entry: Any, path: KeyPath) -> TargetDraft:
        entry = self._mapping(entry, _TARGET, path)
        tag = self._text(entry, "tag", path)
        return TargetDraft(name, tag, self._text(entry, "channel", path), self._source.location((*path, "tag")))

    def _unit(self, name: str, entry: Any, path: KeyPath) -> Unit:
        entry = self._mapping(entry, _UNIT, path)
        connected: list[dict[str, Any]] = []
        for key in ("inputs", "outputs"):
            ports = entry.get(key) or {}
            if not isinstance(ports, dict) or not all(isinstance(each, str | None) for each in ports.values()):
                self._problem(f"'{key}' is a mapping from ports to channels", (*path, key))
                ports = {}
            connected.append({str(port): channel for port, channel in ports.items()})
        return Unit.of(name, self._text(entry, "transformation", path), *connected)

    def _ports(self, entry: dict[Any, Any], key: str, path: KeyPath) -> tuple[PortDraft, ...]:
        ports = entry.get(key) or {}
        if not isinstance(ports, dict):
            self._problem(f"'{key}' is a mapping from ports to tags", (*path, key))
            return ()
        drafts = []
        for port, tag in ports.items():
            if not isinstance(tag, str):
                self._problem(f"the tag of '{port}' is a text", (*path, key, port), "put it in quotes")
                continue
            drafts.append(PortDraft(str(port), tag, self._source.location((*path, key, port))))
        return tuple(drafts)

    def _parameters(self, entry: dict[Any, Any], path: KeyPath) -> tuple[tuple[str, ParameterValue], ...]:
        parameters = entry.get("parameters") or {}
        if not isinstance(parameters, dict):
            self._problem("'parameters' is a mapping", (*path, "parameters"))
            return ()
        for name, value in parameters.items():
            if not isinstance(value, str | int | float | bool):
                self._problem(f"the parameter '{name}' is a text, a number, true or false", (*path, "parameters", name))
        return tuple((str(name), value) for name, value in parameters.items())

    def _text(self, entry: dict[Any, Any], key: str, path: KeyPath, default: str | None = None) -> str:
        value = entry.get(key, default)
        if not isinstance(value, str) or not value:
            self._problem(f"'{key}' is missing" if value is None else f"'{key}' is a text", (*path, key))
            return ""
        return value

    def _optional_number(self, entry: dict[Any, Any], key: str, path: KeyPath) -> float | None:
        return self._number(entry[key], (*path, key)) if entry.get(key) is not None else None

    def _number(self, value: Any, path: KeyPath) -> float | None:
        number = not_negative(value)
        if number is None:
            self._problem(f"'{path[-1]}' is a number of at least 0, not {value!r}", path)
        return number

    def _mapping(self, entry: Any, known: tuple[str, ...], path: KeyPath) -> dict[Any, Any]:
        if not isinstance(entry, dict):
            self._problem(f"expected a mapping with {', '.join(known)}", path)
            return {}
        for key in entry:
            if key not in known:
                hint = nearest(str(key), known) or f"known are {', '.join(known)}"
                self._problem(f"unknown key '{key}'", (*path, key), hint)
        return entry

    def _problem(self, what: str, path: KeyPath, hint: str | None = None) -> None:
        self.problems.append(Problem(what, self._source.location(path), hint))
