"""A model as text that is the same for the same model, always and everywhere, and its fingerprint."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from typing import Any

from rosa_core.model.knowledge_model import KnowledgeModel


def plain(value: Any) -> Any:
    """A dataclass or enum as what JSON knows: dicts, lists, strings, numbers.

    Fields that have their default value are left out, so that a version of this package in which elements have grown a
    field still writes and recognises the models that do without it.
    """
    if isinstance(value, Enum):
        return value.value
    if is_dataclass(value):
        return {
            name: plain(item)
            for name, default in _defaults(type(value))
            if (item := getattr(value, name)) != default or type(item) is not type(default)
        }
    if isinstance(value, Mapping):
        return {str(plain(key)): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, set | frozenset):
        return [plain(item) for item in sorted(value)]
    return value


def model_to_text(model: KnowledgeModel) -> str:
    """The canonical form of a model: JSON in ASCII. The order of declaration is part of it, since it breaks ties."""
    return json.dumps(plain(model), separators=(",", ":"), sort_keys=True)


def model_from_text(text: str) -> KnowledgeModel:
    """The model of a canonical form.

    Raises:
        ValueError: if the text is not one.
        KnowledgeModelError: if the model does not hold together.
    """
    from pydantic import TypeAdapter

    return TypeAdapter(KnowledgeModel).validate_json(text)


def fingerprint(model: KnowledgeModel) -> str:
    """64 hexadecimal digits that two models share only if they are equal."""
    text = json.dumps(_numbers(plain(model)), separators=(",", ":"), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _numbers(tree: Any) -> Any:
    """Equal numbers in the same spelling: a priority of 1 is the same as one of 1.0."""
    if isinstance(tree, dict):
        return {key: _numbers(value) for key, value in tree.items()}
    if isinstance(tree, list):
        return [_numbers(value) for value in tree]
    return int(tree) if isinstance(tree, float) and tree.is_integer() else tree


_known_defaults: dict[type, tuple[tuple[str, Any], ...]] = {}


def _defaults(kind: type) -> tuple[tuple[str, Any], ...]:
    """The fields of a dataclass with their default values."""
    if kind not in _known_defaults:
        _known_defaults[kind] = tuple((field.name, _default(field)) for field in fields(kind))
    return _known_defaults[kind]


def _default(field: Field[Any]) -> Any:
    if field.default_factory is not MISSING:
        return field.default_factory()
    return field.default
