"""The blackboards of a tree and its subtrees (BehaviorTree.CPP v4)."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

from rosa_core import RosaError
from task_layer.bt.ports.conversion import ConversionError, converted, type_name


class BlackboardError(RosaError, LookupError):
    """An entry of a blackboard that does not exist, or cannot hold a value."""


class _Empty:
    """The value of an entry that was declared and not yet written."""

    def __repr__(self) -> str:
        return "EMPTY"


EMPTY: Final = _Empty()


class Entry:
    """One value, shared by all blackboards that it is remapped to.

    Attributes:
        value: the value; :data:`EMPTY` before the first write. It is changed by :meth:`write`.
        type: the type that a port or :meth:`Blackboard.set` has declared; ``object`` for any.
        writes: how often it was written.
        text: of a number that was given to a SubTree, its text in the XML.
    """

    __slots__ = ("text", "type", "value", "writes")

    def __init__(self, type: Any = object, value: object = EMPTY, text: str | None = None) -> None:  # noqa: A002
        self.type = type
        self.value = value
        self.writes = 0 if value is EMPTY else 1
        self.text = text

    def write(self, value: object) -> None:
        """Give it a value; also the same value counts as an update."""
        self.value = value
        self.writes += 1
        self.text = None


class Blackboard:
    """The values that the nodes of one tree share.

    Each SubTree has its own blackboard. An entry that is remapped belongs to the blackboard above; with ``autoremap``
    so do all others, except those whose names begin with ``_``. ``@key`` is the entry ``key`` of the topmost
    blackboard.

    Args:
        parent: the blackboard of the tree above.
        remapped: names of entries here, and the names of the same entries in ``parent``.
        autoremap: whether all other entries are the parent's as well.
        constants: entries that belong to this blackboard in any case: by name the value, a number or a text, and its
            text in the XML.

    >>> blackboard = Blackboard()
    >>> blackboard.set("level", 0.5)
    >>> blackboard.set("level", 1)
    >>> Blackboard(blackboard, {"battery": "level"}).get("battery")
    1.0
    """

    def __init__(
        self,
        parent: Blackboard | None = None,
        remapped: Mapping[str, str] = MappingProxyType({}),
        autoremap: bool = False,
        constants: Mapping[str, tuple[int | float | str, str]] = MappingProxyType({}),
    ) -> None:
        self.parent = parent
        self._remapped = dict(remapped)
        self._autoremap = autoremap
        self._entries = {
            key: Entry(str, text) if isinstance(value, str) else Entry(object, value, text)
            for key, (value, text) in constants.items()
        }

    @property
    def root(self) -> Blackboard:
        """The topmost blackboard."""
        blackboard = self
        while blackboard.parent is not None:
            blackboard = blackboard.parent
        return blackboard

    def entry(self, key: str) -> Entry | None:
        """The entry of that name, if there is one."""
        blackboard, key = self._owner(key)
        return blackboard._entries.get(key)

    def create(self, key: str, type: Any = object) -> Entry:  # noqa: A002
        """The entry of that name, which is created if there is none.

        Args:
            key: the entry's name.
            type: its type; ``object`` leaves the type that it has.

        Raises:
            BlackboardError: if it was declared with another type.
        """
        blackboard, own_key = self._owner(key)
        entry = blackboard._entries.setdefault(own_key, Entry(type))
        if entry.type is object:
            entry.type = type
            if type is str and entry.text is not None:
                entry.value = entry.text  # as it was written, not as the number would be
        elif type not in (object, entry.type) and entry.type is not str:
            raise BlackboardError(f"the entry '{key}' is {type_name(entry.type)} and cannot be {type_name(type)} too")
        return entry

    def get(self, key: str) -> Any:
        """The value of an entry.

        Raises:
            BlackboardError: if there is no such entry, or it was not written yet.
        """
        entry = self.entry(key)
        if entry is None or entry.value is EMPTY:
            state = "there is no entry" if entry is None else "nothing was written to the entry"
            raise BlackboardError(f"{state} '{key}' on the blackboard")
        return entry.value

    def set(self, key: str, value: object) -> None:
        """Write an entry, which is created if there is none.

        Args:
            key: the entry's name.
            value: the value; it is converted to the type that the first write or a port has given the entry.

        Raises:
            BlackboardError: if the value is of another type and cannot be converted without loss.
        """
        entry = self.create(key)
        if entry.type is object:
            entry.type = type(value)
            entry.write(value)
            return
        try:
            entry.write(converted(value, entry.type))
        except ConversionError as error:
            raise BlackboardError(f"the entry '{key}' is {type_name(entry.type)}: {error}") from None

    def unset(self, key: str) -> None:
        """Remove an entry of this blackboard; an entry of a blackboard above stays unless it is written ``@key``."""
        blackboard, own_key = self._owner(key)
        if blackboard is self or key.startswith("@"):
            blackboard._entries.pop(own_key, None)

    def names(self) -> list[str]:
        """The names of this blackboard's own entries, sorted."""
        return sorted(self._entries)

    def __contains__(self, key: str) -> bool:
        entry = self.entry(key)
        return entry is not None and entry.value is not EMPTY

    def _owner(self, key: str) -> tuple[Blackboard, str]:
        """The blackboard that holds an entry, and its name there."""
        blackboard = self
        while True:
            if key.startswith("@"):
                return blackboard.root, key.lstrip("@")
            if blackboard.parent is None:
                return blackboard, key
            if key in blackboard._remapped:
                key = blackboard._remapped[key]
            elif not blackboard._autoremap or key.startswith("_") or key in blackboard._entries:
                return blackboard, key
            blackboard = blackboard.parent
