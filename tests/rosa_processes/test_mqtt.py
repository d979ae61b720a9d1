"""Components by MQTT: real programs and a real client, over a stand-in for the broker."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rosa_core import InputError, KnowledgeBase, Status, WallClock
from rosa_core.mape import AdaptationLoop, ComponentState
from rosa_processes import BrokerEntry, MqttEntry
from tests.rosa_core.sample_models import knowledge_model
from tests.rosa_processes.mqtt_stand_in import Broker
from tests.rosa_processes.programs import SOON, Changes, kill
from tests.rosa_processes.test_faults import MODEL

pytest.importorskip("paho.mqtt.client")
from rosa_processes.mqtt_system import MqttSystem

DEVICE = str(Path(__file__).with_name("mqtt_device.py"))
ENTRIES = {name: MqttEntry(mqtt=f"robot/{name}") for name in ("camera", "spare")}


@pytest.fixture
def broker() -> Iterator[Broker]:
    broker = Broker()
    yield broker
    broker.stop()


@pytest.fixture
def system(broker: Broker) -> Iterator[MqttSystem]:
    system = MqttSystem(ENTRIES, BrokerEntry(port=broker.port))
    yield system
    system.close()


@pytest.fixture
def devices(broker: Broker) -> Iterator[dict[str, subprocess.Popen[bytes]]]:
    command = [sys.executable, DEVICE, str(broker.port)]
    started = {name: subprocess.Popen([*command, f"robot/{name}"]) for name in ENTRIES}
    yield started
    for process in started.values():
        process.kill()
        process.wait()


def test_a_device_is_unknown_until_it_says_something_and_absent_when_it_has_died(
    broker: Broker, system: MqttSystem
) -> None:
    changes = Changes(system)  # type: ignore[arg-type]
    assert system.state("camera") is ComponentState.UNKNOWN
    with subprocess.Popen([sys.executable, DEVICE, str(broker.port), "robot/camera"]) as device:
        changes.become("camera", ComponentState.INACTIVE)
        system.activate("camera")
        changes.become("camera", ComponentState.ACTIVE)
        kill(device.pid)
        changes.become("camera", ComponentState.ABSENT)


def test_parameters_reach_a_device(
    broker: Broker, system: MqttSystem, devices: dict[str, subprocess.Popen[bytes]]
) -> None:
    changes = Changes(system)  # type: ignore[arg-type]
    changes.become("camera", ComponentState.INACTIVE)
    assert system.set_parameters("camera", {"rate": 10}).result(SOON)
    assert broker.retained["robot/camera/parameters"] == b'{"rate": 10}'
    system.activate("camera")
    changes.become("camera", ComponentState.ACTIVE)


def test_without_a_broker_nothing_is_known(system: MqttSystem, broker: Broker) -> None:
    changes = Changes(system)  # type: ignore[arg-type]
    broker.publish("robot/camera/state", b"active", retain=True)
    changes.become("camera", ComponentState.ACTIVE)
    broker.publish("robot/camera/state", b"nonsense")
    broker.stop()
    changes.become("camera", ComponentState.UNKNOWN)


def test_a_broker_that_is_not_there_is_bad_input() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(InputError, match="cannot be reached"):
        MqttSystem(ENTRIES, BrokerEntry(port=port))


def test_the_loop_over_devices(system: MqttSystem, devices: dict[str, subprocess.Popen[bytes]]) -> None:
    so = threading.Condition()

    def notify(_: object) -> None:
        with so:
            so.notify_all()

    def runs_alone(name: str, other: str) -> bool:
        return kb.is_component_active(name) and not kb.is_component_active(other)

    model = knowledge_model(MODEL)
    with KnowledgeBase(model, WallClock(), dispatch="threads") as kb, AdaptationLoop(kb, system) as loop:
        assert loop.watch is not None
        threading.Thread(target=loop.watch.run, daemon=True).start()
        kb.subscribe(notify)
        kb.request_action("watch")
        with so:
            assert so.wait_for(lambda: runs_alone("camera", "spare"), SOON)
        kill(devices["camera"].pid)
        with so:
            assert so.wait_for(lambda: runs_alone("spare", "camera"), SOON)
        assert kb.status("component", "camera") is Status.FAILURE
