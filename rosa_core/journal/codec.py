"""How facts and status changes are written down: short JSON arrays that begin with the kind of fact.

``["measurement","battery_level",0.24,150.0]`` is a measurement. Values stand in the order of the dataclass's fields;
those inside a value are dicts without what is default, so that a later version may add fields.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterable, Sequence
from dataclasses import fields
from functools import cache
from typing import Any

from rosa_core.model.canonical import plain
from rosa_core.model.elements import ElementKind
from rosa_core.model.facts import (
    ComponentActive,
    ComponentFailure,
    ConfigurationApplied,
    Fact,
    FailedPlan,
    ModelChange,
    PendingPlan,
    PlanCount,
    PlanEnded,
    Selection,
)
from rosa_core.model.records import Measurement, RequiredAction, StatusChange
from rosa_core.model.status import Status

_NAMES: dict[type, str] = {
    Measurement: "measurement",
    RequiredAction: "required_action",
    ComponentFailure: "component_failure",
    ComponentActive: "component_active",
    Selection: "selection",
    ConfigurationApplied: "configuration_applied",
    PendingPlan: "plan_made",
    PlanEnded: "plan_ended",
    FailedPlan: "failed_plan",
    PlanCount: "plans_made",
    ModelChange: "model_change",
}
_TYPES = {name: kind for kind, name in _NAMES.items()}
_KINDS: dict[str, ElementKind] = {kind.value: kind for kind in ElementKind}
_STATUSES: dict[str, Status] = {status.value: status for status in Status}
_FIELDS = {kind: tuple(field.name for field in fields(kind)) for kind in _NAMES}

# One encoder for all: json.dumps makes a new one for each call with other than its default settings.
_encode = json.JSONEncoder(separators=(",", ":"), default=plain).encode


class UnreadableRecordError(ValueError):
    """A record that this version did not write."""


def facts_to_text(facts: Iterable[Fact]) -> str:
    """Facts as a JSON array of arrays, in ASCII."""
    return _encode([[_NAMES[type(fact)], *[getattr(fact, name) for name in _FIELDS[type(fact)]]] for fact in facts])


def facts_from_text(text: str) -> tuple[Fact, ...]:
    """The facts of such an array.

    Raises:
        UnreadableRecordError: if it is not one.
    """
    try:
        return tuple(_fact(record) for record in json.loads(text))
    except (ValueError, TypeError, LookupError) as error:
        raise UnreadableRecordError(f"not a list of facts: {error}") from error


def fact_document(fact: Fact) -> dict[str, Any]:
    """A fact as a dict with named fields, for people and other programs."""
    return {"fact": _NAMES[type(fact)], **{name: plain(getattr(fact, name)) for name in _FIELDS[type(fact)]}}


def changes_to_text(changes: Sequence[StatusChange]) -> str | None:
    """Status changes as a JSON array of ``[kind, name, old, new]``; None if there are none."""
    return _encode([[c.kind, c.name, c.old, c.new] for c in changes]) if changes else None


def changes_from_text(text: str | None) -> tuple[StatusChange, ...]:
    """The status changes of such an array.

    Raises:
        UnreadableRecordError: if it is not one.
    """
    if text is None:
        return ()
    try:
        return tuple(
            StatusChange(_KINDS[kind], name, _STATUSES[old], _STATUSES[new])
            for kind, name, old, new in json.loads(text)
        )
    except (ValueError, TypeError, LookupError) as error:
        raise UnreadableRecordError(f"not a list of status changes: {error}") from error


def checksum(*columns: object) -> int:
    """CRC-32 over the columns of a row."""
    return zlib.crc32("|".join(map(repr, columns)).encode("ascii", "backslashreplace"))


def _fact(record: list[Any]) -> Fact:
    kind = _TYPES[record[0]]
    if kind is Measurement:
        # By far the most frequent; the checksum of its row vouches for the types.
        return Measurement(*record[1:])
    fact: Fact = _adapter(kind).validate_python(dict(zip(_FIELDS[kind], record[1:], strict=False)))
    return fact


@cache
def _adapter(kind: type) -> Any:
    from pydantic import TypeAdapter

    return TypeAdapter(kind)
