"""The attributes that an insert states of a thing: what they are called, and whether their values fit."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime

from rosa_core.errors import InputError, nearest
from rosa_core.model.elements import Scalar
from rosa_typeql.matching.facts import Attribute
from rosa_typeql.matching.search import Solution
from rosa_typeql.parsing.problems import Problems
from rosa_typeql.parsing.statements import Has, Variable
from rosa_typeql.schema.table import (
    ATTRIBUTES,
    REMARKS,
    a_or_an,
    attribute_named,
    attributes_of_kind,
    hint_attribute,
    owned,
)
from rosa_typeql.schema.values import fits, plain

Attributes = dict[str, list[tuple[Scalar, int]]]
"""Attributes by label, each value with its line; several values only of remarks."""


def stated_attributes(type_label: str, stated: Iterable[Has], solution: Solution, problems: Problems) -> Attributes:
    """The attributes of a thing.

    Args:
        type_label: what the thing is.
        stated: what the insert says that it has.
        solution: what the variables of the match stand for.
        problems: knows the file.

    Raises:
        InputError: for every attribute that there is not, that the type does not have, or whose value does not fit.
    """
    attributes: Attributes = {}
    wrong = Problems("", [])
    for has in stated:
        with wrong.gathering():
            value = _value(has, solution, problems)
            label = _label(type_label, has, problems)
            checked = _fitting(label, value, has, problems)
            first = attributes.setdefault(label, [(checked, has.line)])[0]
            if label in REMARKS and first != (checked, has.line):
                attributes[label].append((checked, has.line))
            elif first[0] != checked:
                what = f"'{has.label}' is {checked!r} here and {first[0]!r} in line {first[1]}"
                raise problems.error(has.line, what, "keep one of the two")
    if wrong.found:
        raise InputError(wrong.found)
    return attributes


def _value(has: Has, solution: Solution, problems: Problems) -> Scalar | datetime:
    if isinstance(has.value, Variable):
        known = solution.get(has.value.name)
        if isinstance(known, Attribute):
            return known.value
        hint = "give a value, or match it as an attribute"
        raise problems.error(has.line, f"{has.value} has no value here", hint)
    if has.value.operator != "=" or isinstance(has.value.operand, Variable):
        raise problems.error(has.line, "an insert compares nothing", "give one value")
    return has.value.operand


def _label(type_label: str, has: Has, problems: Problems) -> str:
    """What a spelling means for a type: ``value`` of a constraint is its ``attribute-value``."""
    if has.label is None:
        raise problems.error(has.line, "an insert must name the attribute", "such as: has description 'why'")
    known = attribute_named(has.label)
    if known is None:
        hint = hint_attribute(has.label, type_label)
        raise problems.error(has.line, f"unknown attribute '{has.label}'", hint)
    fitting = [label for label in attributes_of_kind(known.label) if label in owned(type_label)]
    if len(fitting) > 1:
        hint = f"say which: {', '.join(label for label in fitting if label not in REMARKS)}"
        raise problems.error(has.line, f"{a_or_an(type_label)} has more than one '{has.label}'", hint)
    if not fitting:
        hint = hint_attribute(has.label, type_label)
        raise problems.error(has.line, f"{a_or_an(type_label)} has no attribute '{has.label}'", hint)
    return fitting[0]


def _fitting(label: str, value: Scalar | datetime, has: Has, problems: Problems) -> Scalar:
    attribute = ATTRIBUTES[label]
    if not fits(attribute.kind, value):
        hint = "write it without quotes" if isinstance(value, str) else "write it in quotes"
        raise problems.error(has.line, f"'{has.label}' is {attribute.kind}, not {value!r}", hint)
    if attribute.allowed and value not in attribute.allowed:
        hint = nearest(str(value), attribute.allowed) or f"one of: {', '.join(attribute.allowed)}"
        raise problems.error(has.line, f"'{has.label}' cannot be {value!r}", hint)
    return plain(value)
