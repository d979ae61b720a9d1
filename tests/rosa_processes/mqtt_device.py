"""A component that talks MQTT: ``python mqtt_device.py PORT TOPIC``."""

import sys

from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion

port, topic = int(sys.argv[1]), sys.argv[2]
client = Client(CallbackAPIVersion.VERSION2)


def connected(*_: object) -> None:
    client.subscribe([(f"{topic}/command", 1), (f"{topic}/parameters", 1)])
    client.publish(f"{topic}/state", "inactive", 1, retain=True)


def heard(_client: Client, _data: object, message: MQTTMessage) -> None:
    if message.topic.endswith("/parameters"):
        client.publish(f"{topic}/echo", message.payload, 1, retain=True)
    else:
        state = "active" if message.payload == b"activate" else "inactive"
        client.publish(f"{topic}/state", state, 1, retain=True)


client.will_set(f"{topic}/state", "absent", 1, retain=True)
client.on_connect, client.on_message = connected, heard
client.connect("127.0.0.1", port)
client.loop_forever()
