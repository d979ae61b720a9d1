"""Components that are programs on other computers and talk MQTT (extra: mqtt).

Under its topic ``T`` a component publishes its state to ``T/state``, retained: ``active`` or ``inactive``, whenever it
changes and in answer to every command; its last will there is ``absent``, which the broker publishes when it has died.
It listens at ``T/command`` for ``activate`` and ``deactivate``, and at ``T/parameters`` for a JSON object, retained.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

from rosa_core.errors import InputError, Problem
from rosa_core.mape import ComponentState
from rosa_core.model.elements import ParameterValue
from rosa_processes.declarations import BrokerEntry, MqttEntry
from rosa_processes.parameter_files import as_json_line

if TYPE_CHECKING:
    from paho.mqtt.client import Client, MQTTMessage

logger = logging.getLogger(__name__)

_AT_LEAST_ONCE = 1
_STATES = {
    b"active": ComponentState.ACTIVE,
    b"inactive": ComponentState.INACTIVE,
    b"absent": ComponentState.ABSENT,
}


class MqttSystem:
    """Starts and stops components by messages; their state is what they, or their last wills, say.

    Before the first word of a component, while it has not answered a command, and while there is no connection to the
    broker, its state is unknown: it may be well.

    Args:
        entries: how components are reached.
        broker: where the broker is.

    Raises:
        InputError: if ``paho-mqtt`` is not installed, or the broker cannot be reached.
    """

    def __init__(self, entries: Mapping[str, MqttEntry], broker: BrokerEntry) -> None:
        try:
            from paho.mqtt.client import Client
            from paho.mqtt.enums import CallbackAPIVersion
        except ImportError:
            hint = "pip install 'rosa-coadaptation[mqtt]'"
            raise InputError(Problem("components by MQTT need paho-mqtt", hint=hint)) from None
        self._topics = {name: entry.mqtt for name, entry in entries.items()}
        self._components = {f"{topic}/state": name for name, topic in self._topics.items()}
        self._states: dict[str, ComponentState] = {}
        self._lock = threading.Lock()
        self._listeners: tuple[Callable[[str], None], ...] = ()
        self._answers: dict[int, Future[bool | None]] = {}
        self._client: Client = Client(CallbackAPIVersion.VERSION2)
        self._client.on_connect = self._on_connect
        self._client.on_disconnect = self._on_disconnect
        self._client.on_message = self._on_message
        self._client.on_publish = self._on_publish
        self._client.reconnect_delay_set(1, 10)
        try:
            self._client.connect(broker.host, broker.port, keepalive=broker.keepalive)
        except OSError as error:
            what = f"the MQTT broker at {broker.host}:{broker.port} cannot be reached: {error}"
            raise InputError(Problem(what, hint="is it running?")) from error
        self._client.loop_start()

    def activate(self, component: str) -> None:
        """Tell a component to begin."""
        self._command(component, "activate")

    def deactivate(self, component: str) -> None:
        """Tell a component to stop."""
        self._command(component, "deactivate")

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Future[bool | None]:
        """Send a component its parameters; the future says when the broker has them."""
        answer: Future[bool | None] = Future()
        with self._lock:
            topic = f"{self._topics[component]}/parameters"
            info = self._client.publish(topic, as_json_line(parameters).strip(), _AT_LEAST_ONCE, retain=True)
            self._answers[info.mid] = answer
        return answer

    def state(self, component: str) -> ComponentState:
        """What a component does, by its own word."""
        with self._lock:
            return self._states.get(component, ComponentState.UNKNOWN)

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Call a function with the name of every component that has said something."""
        with self._lock:
            self._listeners = (*self._listeners, on_change)

        def unsubscribe() -> None:
            with self._lock:
                self._listeners = tuple(known for known in self._listeners if known is not on_change)

        return unsubscribe

    def close(self) -> None:
        """Leave the broker; the components stay as they are."""
        self._client.disconnect()
        self._client.loop_stop()

    def _command(self, component: str, word: str) -> None:
        with self._lock:
            self._states[component] = ComponentState.UNKNOWN
        self._client.publish(f"{self._topics[component]}/command", word, _AT_LEAST_ONCE)

    # -- in the client's thread --

    def _on_connect(self, client: Client, *_: Any) -> None:
        client.subscribe([(topic, _AT_LEAST_ONCE) for topic in self._components])

    def _on_disconnect(self, *_: Any) -> None:
        with self._lock:
            self._states.clear()
        for component in self._topics:
            self._announce(component)

    def _on_message(self, _client: Client, _data: object, message: MQTTMessage) -> None:
        component, state = self._components.get(message.topic), _STATES.get(bytes(message.payload))
        if component is None or state is None:
            logger.warning("%s: %r is no state", message.topic, message.payload[:40])
            return
        with self._lock:
            self._states[component] = state
        self._announce(component)

    def _on_publish(self, _client: Client, _data: object, mid: int, *_: Any) -> None:
        with self._lock:
            answer = self._answers.pop(mid, None)
        if answer is not None:
            answer.set_result(True)

    def _announce(self, component: str) -> None:
        for listener in self._listeners:
            listener(component)
