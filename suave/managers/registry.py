"""Which managing systems there are: those of this package, and those that other packages bring along."""

from __future__ import annotations

from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING

from rosa_core import InputError
from rosa_core.errors import Problem

if TYPE_CHECKING:
    from suave.managers.manager import Manager

PLAIN = "rosa.suave_managers"
EXTENDED = "rosa.suave_extended_managers"
"""The groups of entry points in which a package names managers for the plain and for the extended mission."""

_BUILT_IN = {
    PLAIN: {
        "rosa": "suave.managers.rosa:rosa_manager",
        "bt": "suave.managers.bt:bt_manager",
        "metacontrol": "suave.managers.metacontrol:metacontrol_manager",
        "random": "suave.managers.random_modes:random_manager",
        "none": "suave.managers.none:no_manager",
    },
    EXTENDED: {
        "rosa": "suave.managers.rosa:rosa_manager",
        "bt": "suave.managers.bt:bt_manager",
        "none": "suave.managers.none:no_manager",
    },
}


def manager_names(group: str) -> tuple[str, ...]:
    """The managers that are there for a mission; none of them is imported."""
    return tuple(_entries(group))


def load_manager(group: str, name: str) -> Manager:
    """Import a manager that is there.

    Raises:
        InputError: if it cannot be imported, which is the fault of the package that named it.
    """
    entry = _entries(group)[name]
    try:
        manager: Manager = entry.load()
    except (ImportError, AttributeError) as error:
        hint = f"hint the entry point '{entry.name} = {entry.value}' of the group {group}"
        raise InputError(Problem(f"the manager '{name}' cannot be loaded: {error}", hint=hint)) from error
    return manager


def _entries(group: str) -> dict[str, EntryPoint]:
    """By name: first our own, which no other package can replace, then the others in order of name."""
    entries = {name: EntryPoint(name, value, group) for name, value in _BUILT_IN[group].items()}
    for entry in sorted(entry_points(group=group), key=lambda entry: (entry.name, entry.value)):
        entries.setdefault(entry.name, entry)
    return entries
