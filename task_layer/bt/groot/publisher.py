"""Serves a running tree to Groot2, over ZeroMQ."""

from __future__ import annotations

import threading
from importlib import import_module
from types import ModuleType, TracebackType

import py_trees
from py_trees.behaviour import Behaviour

from rosa_core import Clock, InputError, WallClock
from rosa_core.errors import Problem
from task_layer.bt.groot.blackboards import dump_blackboards, named_blackboards
from task_layer.bt.groot.nodes import list_nodes
from task_layer.bt.groot.protocol import RequestHandler
from task_layer.bt.groot.status_board import StatusBoard
from task_layer.bt.xml.saver import tree_xml

DEFAULT_PORT = 1667
_LAST_PORT = 65534
_POLL_MS = 50
_LARGEST_REQUEST = 1 << 20


class GrootPublisher:
    """Replies to Groot2's requests about a tree, in a thread, as BehaviorTree.CPP's Groot2Publisher does.

    The thread never touches the tree: every change of a status is recorded when it happens, and the record is sent.
    Replies go over ``port``; ``port`` + 1 is bound as well, because Groot2 listens there.

    Args:
        tree: a root behaviour, or a py_trees ``BehaviourTree``.
        port: the port that Groot2 connects to.
        host: the network address to listen on; ``*`` for all of them. Whoever can connect can read the tree and its
            blackboards, and can change nothing.
        clock: the source of the times of transitions; by default the wall clock.

    Raises:
        InputError: if the port is taken or not valid, the tree has too many nodes to number, or pyzmq and msgpack
            are not installed.
    """

    def __init__(
        self,
        tree: Behaviour | py_trees.trees.BehaviourTree,
        port: int = DEFAULT_PORT,
        *,
        host: str = "127.0.0.1",
        clock: Clock | None = None,
    ) -> None:
        root = tree.root if isinstance(tree, py_trees.trees.BehaviourTree) else tree
        nodes = list_nodes(root)
        xml = tree_xml(root, identified=True)
        blackboards = named_blackboards(root, xml)
        self._sockets = _Sockets(host, port)
        board = StatusBoard(nodes, clock or WallClock())
        self._unwatch = board.close
        self._handler = RequestHandler(xml.encode(), board, lambda names: dump_blackboards(blackboards, names))
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="groot", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop the thread, and free the ports."""
        if not self._closing.is_set():
            self._closing.set()
            self._thread.join()
            self._unwatch()

    def __enter__(self) -> GrootPublisher:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _serve(self) -> None:
        try:
            while not self._closing.is_set():
                request = self._sockets.receive()
                if request is not None:
                    self._sockets.send(self._handler.handle(request))
        finally:
            self._sockets.close()


class _Sockets:
    """The two sockets, which may move from one thread to another but not be shared."""

    def __init__(self, host: str, port: int) -> None:
        _needed("msgpack")
        zmq = _needed("zmq")
        if not 1 <= port <= _LAST_PORT:
            raise InputError(Problem(f"{port} is not a port for Groot2", None, f"choose one from 1 to {_LAST_PORT}"))
        self._context = zmq.Context()
        self._server = self._context.socket(zmq.REP)
        self._publisher = self._context.socket(zmq.PUB)
        for socket, its_port in ((self._server, port), (self._publisher, port + 1)):
            socket.linger = 0
            socket.maxmsgsize = _LARGEST_REQUEST
            try:
                socket.bind(f"tcp://{host}:{its_port}")
            except zmq.ZMQError as error:
                self.close()
                hint = f"choose another; {port} and {port + 1} are needed"
                raise InputError(Problem(f"cannot listen at {host}:{its_port}: {error.strerror}", None, hint)) from None

    def receive(self) -> list[bytes] | None:
        """The parts of the next request; None if none arrives within 50 ms."""
        parts: list[bytes] | None = self._server.recv_multipart() if self._server.poll(_POLL_MS) else None
        return parts

    def send(self, parts: list[bytes]) -> None:
        """Send a reply, which is lost if the client is gone."""
        self._server.send_multipart(parts)

    def close(self) -> None:
        """Free the ports."""
        self._server.close()
        self._publisher.close()
        self._context.term()


def _needed(name: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError:
        hint = "pip install 'rosa-coadaptation[groot]'"
        raise InputError(Problem(f"Groot2's protocol needs {name}, which is not installed", None, hint)) from None
