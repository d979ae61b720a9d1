"""Hears every change of status in a tree at the moment when it happens, within a tick and between ticks."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import new_class
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

OnChange = Callable[[Behaviour, Status, Status], None]
"""Called with the behaviour, its old status and its new one, in the thread that ticks."""

_HEARERS = "_status_hearers"


def watch_statuses(root: Behaviour, on_change: OnChange) -> Callable[[], None]:
    """Hear every change of status of the behaviours that are in the tree now, until the function returned is called.

    While somebody watches, each behaviour is of a subclass of its own class, in which ``status`` tells of its
    changes; afterwards it is of its own class again. So a tree that nobody watches is not slower by anything, and no
    class of py_trees or of the user is altered. Several may watch the same tree.

    Begin and end between ticks. Behaviours that are added to the tree later are not heard.

    Args:
        root: the top of the tree.
        on_change: must be quick, and must neither raise nor tick.
    """
    behaviours = list(root.iterate())
    for behaviour in behaviours:
        heard = behaviour.__dict__
        if _HEARERS not in heard:
            behaviour.__class__ = _watched(type(behaviour))
        heard[_HEARERS] = (*heard.get(_HEARERS, ()), on_change)

    def unwatch() -> None:
        while behaviours:
            _reset(behaviours.pop(), on_change)

    return unwatch


def own_class(behaviour: Behaviour) -> type[Behaviour]:
    """The class that the behaviour was made of, whether it is watched or not."""
    kind = type(behaviour)
    base = kind.__base__
    return base if _HEARERS in behaviour.__dict__ and base is not None else kind


def _reset(behaviour: Behaviour, on_change: OnChange) -> None:
    heard = behaviour.__dict__
    others = list(heard[_HEARERS])
    others.remove(on_change)
    if others:
        heard[_HEARERS] = tuple(others)
    else:
        behaviour.__class__ = own_class(behaviour)
        del heard[_HEARERS]


class _WatchedStatus:
    """Keeps the status where py_trees keeps it, and tells of every change."""

    def __get__(self, behaviour: Behaviour | None, kind: type[Behaviour]) -> Any:
        return self if behaviour is None else behaviour.__dict__["status"]

    def __set__(self, behaviour: Behaviour, new: Status) -> None:
        known = behaviour.__dict__
        old = known["status"]
        known["status"] = new
        if new is not old:
            for on_change in known[_HEARERS]:
                on_change(behaviour, old, new)


@cache
def _watched(kind: type[Behaviour]) -> type[Behaviour]:
    """The subclass whose ``status`` tells of its changes; its name is the class's own."""
    body: dict[str, Any] = {name: getattr(kind, name) for name in ("__module__", "__qualname__", "__doc__")}
    body |= {"__slots__": (), "status": _WatchedStatus()}
    return new_class(kind.__name__, (kind,), exec_body=lambda names: names.update(body))
