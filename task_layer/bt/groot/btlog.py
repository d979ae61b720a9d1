"""Writes and reads BehaviorTree.CPP's log of a tree (``.btlog``, FileLogger2), which Groot2 opens.

The file holds a magic word and a version, the tree's XML with the numbers of its nodes, the start time, and 9 bytes for
every change of a status.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import TracebackType

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import Clock, InputError, WallClock
from rosa_core.errors import Location, Problem
from task_layer.bt.engine.status_changes import watch_statuses
from task_layer.bt.groot.nodes import list_nodes
from task_layer.bt.groot.transition import CODES, TRANSITION, StatusCode, microseconds, transition_record
from task_layer.bt.xml.saver import tree_xml

MAGIC = b"BTCPP4-FileLogger2"
VERSION = 1
_LENGTH = struct.Struct("<i")
_START = struct.Struct("<q")


class BtLogWriter:
    """Writes every change of a status to a log, until it is closed.

    Every change is in the file at once, so that the log is complete even if the process dies.

    Args:
        path: the file, which is replaced if it exists.
        root: the top of the tree.
        clock: the source of the times; by default the wall clock.

    Raises:
        InputError: if the file cannot be written, or the tree has too many nodes to number.
    """

    def __init__(self, path: str | PathLike[str], root: Behaviour, clock: Clock | None = None) -> None:
        self._path = str(path)
        self._clock: Clock = clock or WallClock()
        nodes = list_nodes(root)
        self._uids = {id(node): uid for node, uid in nodes}
        xml = tree_xml(root, identified=True).encode()
        self._failure: OSError | None = None
        self._start = microseconds(self._clock)
        try:
            self._file = Path(path).open("wb", buffering=0)  # noqa: SIM115 - closed by close()
        except (OSError, ValueError) as error:
            raise self._cannot_write(error) from None
        self._write(MAGIC + bytes([VERSION]) + _LENGTH.pack(len(xml)) + xml + _START.pack(self._start))
        self._unwatch = watch_statuses(root, self._changed)

    def close(self) -> None:
        """Close the file.

        Raises:
            InputError: if a change could not be written (the disk is full, say), which did not disturb the tree.
        """
        self._unwatch()
        self._file.close()
        if self._failure is not None:
            failure, self._failure = self._failure, None
            raise self._cannot_write(failure)

    def __enter__(self) -> BtLogWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _changed(self, behaviour: Behaviour, _old: Status, new: Status) -> None:
        after = microseconds(self._clock) - self._start
        self._write(transition_record(after, self._uids[id(behaviour)], CODES[new]))

    def _write(self, data: bytes) -> None:
        if self._failure is None:
            try:
                self._file.write(data)
            except OSError as error:
                self._failure = error

    def _cannot_write(self, error: Exception) -> InputError:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        return InputError(Problem(f"cannot write the log: {reason}", Location(self._path)))


@dataclass(frozen=True, slots=True)
class Transition:
    """A change of a node's status.

    Attributes:
        time_s: when it happened, s after the start of the log.
        uid: the node's number.
        status: its status from then on.
    """

    time_s: float
    uid: int
    status: StatusCode


@dataclass(frozen=True, slots=True)
class BtLog:
    """The content of a log.

    Attributes:
        xml: the tree; each node has its number in the attribute ``_uid``.
        start_s: the start time, in s of the writer's clock (BehaviorTree.CPP's: since 1970).
        transitions: the changes of statuses, in order.
    """

    xml: str
    start_s: float
    transitions: tuple[Transition, ...]


def read_btlog(path: str | PathLike[str]) -> BtLog:
    """Read a log of :class:`BtLogWriter` or BehaviorTree.CPP.

    Raises:
        InputError: if the file cannot be read, or it is no log, one of another version, incomplete or damaged.
    """
    where = Location(str(path))
    try:
        data = Path(path).read_bytes()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(Problem(f"cannot read it: {reason}", where)) from None
    if not data.startswith(MAGIC):
        hint = "a log of rosa run --btlog, or of BehaviorTree.CPP's FileLogger2, begins with " + MAGIC.decode()
        raise InputError(Problem("this is not a log of a behaviour tree", where, hint))
    xml, start, first = _header(data, where)
    return BtLog(xml, start / 1e6, tuple(_transitions(memoryview(data)[first:], where)))


def _header(data: bytes, where: Location) -> tuple[str, int, int]:
    """The XML, the start time in µs, and the offset of the first transition."""
    place = len(MAGIC) + 1
    if len(data) > len(MAGIC) and data[len(MAGIC)] != VERSION:
        raise InputError(Problem(f"this log is of version {data[len(MAGIC)]}; only {VERSION} can be read", where))
    length = _LENGTH.unpack_from(data, place)[0] if len(data) >= place + _LENGTH.size else -1
    place += _LENGTH.size
    first = place + length + _START.size
    if length < 0 or len(data) < first:
        raise InputError(Problem("the log ends before its first transition", where, "it was cut off; write it again"))
    try:
        xml = data[place : place + length].decode()
    except UnicodeDecodeError:
        raise InputError(Problem("the tree in the log is not text", where, "the log is damaged")) from None
    return xml, _START.unpack_from(data, place + length)[0], first


def _transitions(data: memoryview, where: Location) -> Iterator[Transition]:
    whole, rest = divmod(len(data), TRANSITION.size)
    if rest:
        hint = f"it was cut off; without its last {rest} bytes it can be read"
        raise InputError(Problem(f"the log ends within its transition {whole + 1}", where, hint))
    for number, (low, high, uid, status) in enumerate(TRANSITION.iter_unpack(data), start=1):
        if status > max(StatusCode):
            problem = f"transition {number} is to status {status}, which there is not"
            raise InputError(Problem(problem, where, "the log is damaged"))
        yield Transition((low + (high << 32)) / 1e6, uid, StatusCode(status))
