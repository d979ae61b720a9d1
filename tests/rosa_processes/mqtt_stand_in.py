"""A broker of MQTT 3.1.1 for tests: retained messages, last wills, quality of service up to 1, no wildcards."""

from __future__ import annotations

import socketserver
import struct
import threading

_CONNECT, _PUBLISH, _PUBACK, _SUBSCRIBE, _PINGREQ, _DISCONNECT = 1, 3, 4, 8, 12, 14


class Broker(socketserver.ThreadingTCPServer):
    """Serves on a port of this computer from its making on."""

    daemon_threads = True
    block_on_close = False
    allow_reuse_address = True

    def __init__(self, port: int = 0) -> None:
        super().__init__(("127.0.0.1", port), _Connection)
        self.port: int = self.server_address[1]
        self.lock = threading.RLock()
        self.retained: dict[str, bytes] = {}
        self.connections: set[_Connection] = set()
        threading.Thread(target=self.serve_forever, kwargs={"poll_interval": 0.01}, daemon=True).start()

    def publish(self, topic: str, payload: bytes, *, retain: bool = False) -> None:
        with self.lock:
            if retain:
                self.retained[topic] = payload
            for connection in self.connections:
                if topic in connection.topics:
                    connection.send_message(topic, payload)

    def stop(self) -> None:
        self.shutdown()
        self.server_close()
        with self.lock:
            for connection in list(self.connections):
                connection.request.shutdown(2)


class _Connection(socketserver.StreamRequestHandler):
    server: Broker

    def setup(self) -> None:
        super().setup()
        self.topics: set[str] = set()
        self.will: tuple[str, bytes, bool] | None = None

    def handle(self) -> None:
        with self.server.lock:
            self.server.connections.add(self)
        try:
            while self._packet():
                pass
        except (OSError, EOFError):
            pass
        finally:
            with self.server.lock:
                self.server.connections.discard(self)
            if self.will is not None:
                topic, payload, retain = self.will
                self.server.publish(topic, payload, retain=retain)

    def send_message(self, topic: str, payload: bytes) -> None:
        self._send(_PUBLISH << 4, _text(topic) + payload)

    def _packet(self) -> bool:
        first = self._read(1)[0]
        length = shift = 0
        while True:
            byte = self._read(1)[0]
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
        body = self._read(length)
        kind = first >> 4
        if kind == _CONNECT:
            self._connect(body)
        elif kind == _PUBLISH:
            topic, rest = _take(body)
            number, rest = (rest[:2], rest[2:]) if first & 6 else (None, rest)
            self.server.publish(topic.decode(), rest, retain=bool(first & 1))
            if number is not None:
                self._send(_PUBACK << 4, number)
        elif kind == _SUBSCRIBE:
            self._subscribe(body)
        elif kind == _PINGREQ:
            self._send(0xD0, b"")
        elif kind == _DISCONNECT:
            self.will = None
            return False
        return True

    def _connect(self, body: bytes) -> None:
        _, rest = _take(body)
        flags, rest = rest[1], rest[4:]
        _, rest = _take(rest)
        if flags & 4:
            topic, rest = _take(rest)
            payload, _ = _take(rest)
            self.will = (topic.decode(), payload, bool(flags & 32))
        self._send(0x20, b"\0\0")

    def _subscribe(self, body: bytes) -> None:
        number, rest, granted = body[:2], body[2:], b""
        with self.server.lock:
            topics = []
            while rest:
                topic, rest = _take(rest)
                granted, rest = granted + rest[:1], rest[1:]
                topics.append(topic.decode())
            self._send(0x90, number + granted)
            self.topics.update(topics)
            for topic in topics:
                if topic in self.server.retained:
                    self.send_message(topic, self.server.retained[topic])

    def _send(self, first: int, body: bytes) -> None:
        length, size = b"", len(body)
        while True:
            size, low = divmod(size, 128)
            length += bytes([low | (128 if size else 0)])
            if not size:
                break
        self.request.sendall(bytes([first]) + length + body)

    def _read(self, count: int) -> bytes:
        data = self.rfile.read(count)
        if len(data) != count:
            raise EOFError
        return data


def _text(text: str) -> bytes:
    return struct.pack(">H", len(text.encode())) + text.encode()


def _take(data: bytes) -> tuple[bytes, bytes]:
    (length,) = struct.unpack(">H", data[:2])
    return data[2 : 2 + length], data[2 + length :]
