"""Which managing systems there are for a scenario: those of every robot, its own, and those of other packages.

Another package brings a manager along by naming it in its entry points, in the group of the scenario that it is for:
``rosa.suave_managers`` for ``suave``, ``rosa.suave_extended_managers`` for ``suave-extended``, and so on. A manager is
a function that is given a :class:`~rosa_simulation.mission.Mission` and returns its runner.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib.metadata import EntryPoint, entry_points
from typing import TYPE_CHECKING, TypeAlias

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.scenario import choose

if TYPE_CHECKING:
    from rosa_simulation.mission import Mission
    from task_layer.bt import TreeRunner

    Manager: TypeAlias = Callable[[Mission], TreeRunner]
    """A managing system: connects to the mission's robot and makes the runner that performs the mission. The runner's
    ticks, what the robot publishes and :meth:`Mission.call_every` are its occasions to act."""


def manager_group(scenario: str) -> str:
    """The group of entry points in which packages name managers for a scenario.

    Example:
        >>> manager_group("suave-extended")
        'rosa.suave_extended_managers'
    """
    return f"rosa.{scenario.replace('-', '_')}_managers"


def manager_entries(scenario: str, own: Mapping[str, str]) -> dict[str, EntryPoint]:
    """The managers of a scenario by name; none of them is imported.

    Args:
        scenario: its name.
        own: those that only this scenario has, each as ``module:function``.

    Returns:
        first those of our own packages, which no other package can replace, then the others in order of name.
    """
    entries = _built_in(scenario, own)
    for entry in sorted(entry_points(group=manager_group(scenario)), key=lambda entry: (entry.name, entry.value)):
        entries.setdefault(entry.name, entry)
    return entries


def manager_entry(scenario: str, own: Mapping[str, str], name: str) -> EntryPoint:
    """One of the managers of a scenario.

    Args:
        scenario: its name.
        own: those that only this scenario has.
        name: the manager's.

    Raises:
        InputError: if there is no such manager.
    """
    # The entry points of all installed packages are read only for a manager that is not built in.
    built_in = _built_in(scenario, own)
    if name in built_in:
        return built_in[name]
    entries = manager_entries(scenario, own)
    return entries[choose("manager", name, tuple(entries))]


def _built_in(scenario: str, own: Mapping[str, str]) -> dict[str, EntryPoint]:
    values = {
        "rosa": "rosa_simulation.managers.rosa:rosa_manager",
        **own,
        "none": "rosa_simulation.managers.none:no_manager",
    }
    return {name: EntryPoint(name, value, manager_group(scenario)) for name, value in values.items()}


def load_manager(entry: EntryPoint) -> Manager:
    """Import a manager.

    Raises:
        InputError: if it cannot be imported, which is the fault of the package that named it.
    """
    try:
        manager: Manager = entry.load()
    except (ImportError, AttributeError) as error:
        hint = f"correct the entry point '{entry.name} = {entry.value}' of the group {entry.group}"
        raise InputError(Problem(f"the manager '{entry.name}' cannot be loaded: {error}", hint=hint)) from error
    return manager
