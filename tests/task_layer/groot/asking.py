"""Asks a publisher as Groot2 does."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterator
from contextlib import contextmanager

import zmq

from tests.hang_limit import HANG_LIMIT

NUMBER = 0x01020304


def free_port() -> int:
    """A port that is free, and so is the next one."""
    while True:
        with socket.socket() as first, socket.socket() as second:
            first.bind(("127.0.0.1", 0))
            port: int = first.getsockname()[1]
            try:
                second.bind(("127.0.0.1", port + 1))
            except (OSError, OverflowError):
                continue
            return port


def header(kind: str, protocol: int = 2) -> bytes:
    return struct.pack("<BBI", protocol, ord(kind), NUMBER)


class Asker:
    """A client that has to get its answers."""

    def __init__(self, port: int) -> None:
        self._context = zmq.Context()
        self._socket = self._context.socket(zmq.REQ)
        self._socket.linger = 0
        self._socket.connect(f"tcp://127.0.0.1:{port}")

    def send(self, *parts: bytes) -> list[bytes]:
        self._socket.send_multipart(parts)
        assert self._socket.poll(int(HANG_LIMIT * 1000)), "no answer"
        return self._socket.recv_multipart()

    def ask(self, kind: str, *more: bytes) -> list[bytes]:
        return self.send(header(kind), *more)

    def statuses(self) -> dict[int, int]:
        """The status of every node by number."""
        payload = self.ask("S")[1]
        return dict(struct.iter_unpack("<HB", payload))

    def close(self) -> None:
        self._socket.close()
        self._context.term()


@contextmanager
def asking(port: int) -> Iterator[Asker]:
    asker = Asker(port)
    try:
        yield asker
    finally:
        asker.close()
