"""Diagnostics from other programs: one JSON document in a line, from standard input or a socket."""

from __future__ import annotations

import json
import logging
import os
import socketserver
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, BinaryIO

from rosa_core.errors import KnowledgeBaseError
from rosa_core.mape import DiagnosticsMonitor

logger = logging.getLogger(__name__)

LONGEST_LINE = 1 << 16
"""The most bytes that a line may have; longer ones are not read."""


def as_diagnostics(document: Any) -> Any:
    """What a line says, as a diagnostic array; short forms for one measurement and one component are written out.

    >>> as_diagnostics({"measure": "battery", "value": 0.5})["status"][0]["values"]
    [{'key': 'battery', 'value': '0.5'}]
    >>> as_diagnostics({"component": "camera", "status": "FALSE"})["status"][0]["message"]
    'Component status'

    Raises:
        ValueError: if it is neither.
    """
    if isinstance(document, dict) and "measure" in document and "value" in document:
        return _array(document, "QA measurement", document["measure"], document["value"])
    if isinstance(document, dict) and "component" in document and "status" in document:
        return _array(document, "Component status", document["component"], document["status"])
    if isinstance(document, dict) and isinstance(document.get("status"), list):
        return document
    raise ValueError("neither a diagnostic array nor a measure with a value nor a component with a status")


def _array(document: dict[str, Any], message: str, key: object, value: object) -> dict[str, Any]:
    status = {"message": message, "values": [{"key": str(key), "value": str(value)}]}
    return {"header": {"stamp": document.get("time")}, "status": [status]}


def read_lines(stream: BinaryIO, monitor: DiagnosticsMonitor) -> None:
    """Write to the knowledge base what the lines of a stream say, until it ends; what cannot be used is logged."""
    while line := stream.readline(LONGEST_LINE):
        if not line.endswith(b"\n") and len(line) == LONGEST_LINE:
            logger.warning("a line with more than %d bytes is not read", LONGEST_LINE)
            while (rest := stream.readline(LONGEST_LINE)) and not rest.endswith(b"\n"):
                pass
            continue
        if not line.strip():
            continue
        try:
            monitor.update(as_diagnostics(json.loads(line)))
        except KnowledgeBaseError as error:
            logger.warning("a diagnostic is refused: %s", error)
        except (ValueError, RecursionError) as error:
            logger.warning("a line is no diagnostic: %s", str(error)[:200])


class MonitorInput:
    """Reads diagnostics in threads of its own, until it is closed.

    Args:
        monitor: writes them.
        stdin: the descriptor of a stream to be read, if any.
        socket: a Unix socket at which other programs connect, if any; one left over by a manager that died is replaced.
        port: a TCP port of this computer at which they do, if any; 0: any that is free.

    Raises:
        OSError: if the socket or port cannot be had.
    """

    def __init__(
        self,
        monitor: DiagnosticsMonitor,
        *,
        stdin: int | None = None,
        socket: Path | None = None,
        port: int | None = None,
    ) -> None:
        self._servers: list[socketserver.BaseServer] = []
        self._socket = socket
        handler = _handler(monitor)
        if socket is not None:
            socket.unlink(missing_ok=True)
            server = _UnixServer(str(socket), handler)
            os.chmod(socket, 0o600)  # noqa: PTH101
            self._serve(server)
        self.port: int | None = None
        """The TCP port, if there is one."""
        if port is not None:
            tcp = _TcpServer(("127.0.0.1", port), handler)
            self.port = int(tcp.server_address[1])
            self._serve(tcp)
        if stdin is not None:
            # A daemon, since nobody can wake it from reading; on a reader of its own, since the interpreter wants the
            # lock of the usual one when it ends.
            own = open(os.dup(stdin), "rb")  # noqa: PTH123, SIM115  # closed with the process
            threading.Thread(target=read_lines, args=(own, monitor), name="rosa stdin", daemon=True).start()

    def close(self) -> None:
        """Accept no more."""
        for server in self._servers:
            server.shutdown()
            server.server_close()
        if self._socket is not None:
            self._socket.unlink(missing_ok=True)

    def _serve(self, server: socketserver.BaseServer) -> None:
        self._servers.append(server)
        serve: Callable[[], None] = server.serve_forever
        threading.Thread(target=serve, name="rosa monitors", daemon=True).start()


class _UnixServer(socketserver.ThreadingUnixStreamServer):
    daemon_threads = True
    block_on_close = False


class _TcpServer(socketserver.ThreadingTCPServer):
    daemon_threads = True
    block_on_close = False
    allow_reuse_address = True


def _handler(monitor: DiagnosticsMonitor) -> type[socketserver.StreamRequestHandler]:
    class Handler(socketserver.StreamRequestHandler):
        def handle(self) -> None:
            try:
                read_lines(self.rfile, monitor)  # type: ignore[arg-type]
            except ConnectionError as error:
                logger.info("a monitor has gone: %s", error)

    return Handler
