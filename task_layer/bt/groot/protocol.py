"""Groot2's live protocol: requests and replies as bytes, without sockets.

A request is a header of 6 bytes (protocol, kind, the client's number) and for some kinds a second part. The reply
repeats the header, adds the 16 bytes that identify the tree, and has at most one further part; or it is two parts,
``error`` and a message. Both are BehaviorTree.CPP's, byte by byte, except that breakpoints are refused.
"""

from __future__ import annotations

import hashlib
import json
import logging
import struct
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from task_layer.bt.groot.status_board import StatusBoard

_log = logging.getLogger(__name__)

PROTOCOL = 2
_HEADER = struct.Struct("<BcI")

Parts = list[bytes]


class RefusedError(Exception):
    """A request that gets an error as its reply."""


@dataclass(frozen=True, slots=True)
class RequestHandler:
    """Handles requests about one tree.

    Attributes:
        xml: the tree, with the numbers of its nodes.
        board: the statuses of its nodes.
        blackboards: returns the blackboards of some names, in MessagePack.
    """

    xml: bytes
    board: StatusBoard
    blackboards: Callable[[list[str]], bytes]

    def handle(self, request: Parts) -> Parts:
        """The parts of the reply; never raises, so that the next request is handled as well."""
        try:
            return self._handle(request)
        except RefusedError as error:
            return [b"error", str(error).encode()]
        except Exception as error:
            _log.exception("a request of Groot2 could not be answered")
            return [b"error", f"{type(error).__name__} while answering".encode()]

    def _handle(self, request: Parts) -> Parts:
        if not request or len(request[0]) != _HEADER.size:
            raise RefusedError("wrong request header")
        _, kind, number = _HEADER.unpack(request[0])
        if kind not in _KINDS:
            raise RefusedError("Request not recognized")
        payload = _KINDS[kind](self, request)
        header = _HEADER.pack(PROTOCOL, kind, number) + tree_id(self.xml)
        return [header] if payload is None else [header, payload]


def tree_id(xml: bytes) -> bytes:
    """The identifier of a tree: it depends on nothing but its XML."""
    return uuid.UUID(bytes=hashlib.sha256(xml).digest()[:16], version=4).bytes


def _full_tree(handler: RequestHandler, _request: Parts) -> bytes:
    return handler.xml


def _status(handler: RequestHandler, _request: Parts) -> bytes:
    return handler.board.statuses()


def _blackboards(handler: RequestHandler, request: Parts) -> bytes:
    names = _second_part(request).decode(errors="replace").split(";")
    return handler.blackboards([name for name in names if name])


def _toggle_recording(handler: RequestHandler, request: Parts) -> bytes | None:
    wish = _second_part(request)
    if wish == b"start":
        return str(handler.board.start_recording()).encode()
    if wish == b"stop":
        handler.board.stop_recording()
    return None


def _transitions(handler: RequestHandler, _request: Parts) -> bytes:
    return handler.board.take_transitions()


def _insert_hook(_handler: RequestHandler, request: Parts) -> bytes:
    _check_hook(_second_part(request))
    raise RefusedError("breakpoints are not supported")


def _which_hook(_handler: RequestHandler, request: Parts) -> bytes:
    _check_hook(_second_part(request))
    raise RefusedError("Node ID not found")


def _no_hooks(_handler: RequestHandler, _request: Parts) -> bytes:
    return b"[]"


def _done(_handler: RequestHandler, _request: Parts) -> None:
    """Nothing to do: there are no hooks to remove or to disable."""


def _second_part(request: Parts) -> bytes:
    if len(request) != 2:
        raise RefusedError("must be 2 parts message")
    return request[1]


def _check_hook(text: bytes) -> None:
    try:
        json.loads(text)
    except (ValueError, RecursionError):
        raise RefusedError("the second part must be JSON") from None


_KINDS: Mapping[bytes, Callable[[RequestHandler, Parts], bytes | None]] = {
    b"T": _full_tree,
    b"S": _status,
    b"B": _blackboards,
    b"r": _toggle_recording,
    b"t": _transitions,
    b"I": _insert_hook,
    b"R": _which_hook,
    b"U": _which_hook,
    b"D": _no_hooks,
    b"A": _done,
    b"X": _done,
}
