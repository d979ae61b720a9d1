"""The assignments ``:=``, ``=``, ``+=``, ``-=``, ``*=`` and ``/=`` to entries of the blackboard."""

from __future__ import annotations

from task_layer.bt.ports.blackboard import EMPTY, Entry
from task_layer.bt.ports.conversion import is_number, parse, to_float, to_int
from task_layer.bt.scripting.operators import arithmetic, number_in_text
from task_layer.bt.scripting.scope import Evaluate, Scope, ScriptError


def assignment(name: str, symbol: str, value: Evaluate) -> Evaluate:
    """An expression that writes an entry and evaluates to its new value.

    ``:=`` creates an entry if there is none; the other assignments fail then. A whole number stays a whole number, and
    a text stays a text.
    """

    def evaluate(scope: Scope) -> object:
        entry = scope.blackboard.entry(name)
        if entry is None and symbol != ":=":
            raise ScriptError(f"there is no entry '{name}' on the blackboard (':=' would make one)")
        assigned = value(scope)
        if entry is None:
            entry = scope.blackboard.create(name)
        if symbol in (":=", "="):
            _assign(name, entry, assigned, scope)
        else:
            _change(name, entry, symbol[0], assigned)
        return entry.value

    return evaluate


def _assign(name: str, entry: Entry, value: object, scope: Scope) -> None:
    if entry.value is EMPTY and entry.type is object:
        entry.write(value)
    elif isinstance(value, str) and not isinstance(entry.value, str):
        entry.write(_from_text(name, entry, value, scope))
    else:
        _put(name, entry, value)


def _from_text(name: str, entry: Entry, text: str, scope: Scope) -> object:
    if entry.type is not object:
        return parse(text, entry.type)
    if is_number(entry.value):
        return number_in_text(text, scope.enums)
    raise ScriptError(f"the entry '{name}' holds a {type(entry.value).__name__}, not a text")


def _change(name: str, entry: Entry, symbol: str, value: object) -> None:
    held = entry.value
    if held is EMPTY:
        raise ScriptError(f"nothing was written to the entry '{name}' yet")
    if isinstance(held, str) and isinstance(value, str):
        if symbol != "+":
            raise ScriptError(f"'{symbol}=' cannot be applied to texts")
        entry.write(held + value)
    elif is_number(held) and is_number(value):
        _put(name, entry, arithmetic(symbol, held, value))
    else:
        raise ScriptError(f"'{symbol}=' cannot be applied to '{name}': a text and a number do not mix")


def _put(name: str, entry: Entry, value: object) -> None:
    """Write a value of the kind that the entry holds already."""
    held = entry.value
    if held is EMPTY or (isinstance(held, str) and isinstance(value, str)):
        entry.write(value)
    elif isinstance(held, int) and is_number(value):
        entry.write(to_int(value))
    elif isinstance(held, float) and is_number(value):
        entry.write(to_float(value))
    elif not isinstance(held, str | int | float) and isinstance(value, type(held)):
        entry.write(value)
    else:
        raise ScriptError(f"the entry '{name}' holds a {_kind(held)} and cannot hold a {_kind(value)}")


def _kind(value: object) -> str:
    if isinstance(value, str):
        return "text"
    return "number" if is_number(value) else type(value).__name__
