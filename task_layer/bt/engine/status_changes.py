"""Reports every change of status in a tree at the moment when it happens, within a tick and between ticks."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import new_class
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.failing import OWN_CLASS

OnChange = Callable[[Behaviour, Status, Status], None]
"""Called with the behaviour, its old status and its new one, in the thread that ticks."""

_WATCHERS = "_status_watchers"


def watch_statuses(root: Behaviour, on_change: OnChange) -> Callable[[], None]:
    """Call a function at every change of status of the behaviours that are in the tree now.

    While a tree is watched, each behaviour has a subclass of its own class in which ``status`` reports its changes;
    afterwards it has its own class again. A tree that is not watched is therefore not slowed down, and no class of
    py_trees or of the user is altered. Several functions may watch the same tree.

    Begin and end between ticks. Behaviours that are added to the tree later are not watched.

    Args:
        root: the top of the tree.
        on_change: called with the behaviour, its old status and its new one, in the thread that ticks. It must be
            quick, and must neither raise nor tick.

    Returns:
        a function that ends the watching.
    """
    behaviours = list(root.iterate())
    for behaviour in behaviours:
        attributes = behaviour.__dict__
        if _WATCHERS not in attributes:
            behaviour.__class__ = _watched(type(behaviour))
        attributes[_WATCHERS] = (*attributes.get(_WATCHERS, ()), on_change)

    def unwatch() -> None:
        while behaviours:
            _remove(behaviours.pop(), on_change)

    return unwatch


def own_class(behaviour: Behaviour) -> type[Behaviour]:
    """The class that the behaviour was created with, whether it is watched or not."""
    kind = _unwatched_class(behaviour)
    own: type[Behaviour] = kind.__dict__.get(OWN_CLASS, kind)
    return own


def _unwatched_class(behaviour: Behaviour) -> type[Behaviour]:
    kind = type(behaviour)
    base = kind.__base__
    return base if _WATCHERS in behaviour.__dict__ and base is not None else kind


def _remove(behaviour: Behaviour, on_change: OnChange) -> None:
    attributes = behaviour.__dict__
    others = list(attributes[_WATCHERS])
    others.remove(on_change)
    if others:
        attributes[_WATCHERS] = tuple(others)
    else:
        behaviour.__class__ = _unwatched_class(behaviour)
        del attributes[_WATCHERS]


class _WatchedStatus:
    """Keeps the status where py_trees keeps it, and reports every change."""

    def __get__(self, behaviour: Behaviour | None, kind: type[Behaviour]) -> Any:
        return self if behaviour is None else behaviour.__dict__["status"]

    def __set__(self, behaviour: Behaviour, new: Status) -> None:
        attributes = behaviour.__dict__
        old = attributes["status"]
        attributes["status"] = new
        if new is not old:
            for on_change in attributes[_WATCHERS]:
                on_change(behaviour, old, new)


@cache
def _watched(kind: type[Behaviour]) -> type[Behaviour]:
    """The subclass whose ``status`` reports its changes; it has the name of its base class."""
    body: dict[str, Any] = {name: getattr(kind, name) for name in ("__module__", "__qualname__", "__doc__")}
    body |= {"__slots__": (), "status": _WatchedStatus()}
    return new_class(kind.__name__, (kind,), exec_body=lambda names: names.update(body))
