"""How a component is a process or a unit of systemd: what a robot's file says under ``managed:``."""

from __future__ import annotations

import signal
import string
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from rosa_core.formats.checked_file import Entry, Flag, Name, Number, Text, Whole, within
from rosa_core.formats.misfits import MisfitError
from rosa_core.mape import Limits

Seconds = Annotated[Number, within(0.001, 1e6)]


def _command(value: object) -> object:
    if isinstance(value, str):
        raise MisfitError("a command is a list, not one text", "write it as [program, argument, argument]")
    return value


def _signal(value: str) -> str:
    if not hasattr(signal, f"SIG{value}"):
        raise MisfitError(f"there is no signal {value}", "such as TERM, INT or HUP")
    return value


Signal = Annotated[Text, AfterValidator(_signal)]
Command = Annotated[tuple[Name, ...], BeforeValidator(_command), Field(min_length=1)]


def signal_number(name: str) -> signal.Signals:
    """The signal of a name such as TERM."""
    return signal.Signals[f"SIG{name}"]


class ReadyEntry(Entry):
    """How a process shows that it is ready: exactly one of these.

    Attributes:
        line: a text that is part of a line of its output.
        file: a file that it makes; removed before it starts.
        port: a TCP port of this computer at which it listens.
        probe: a command that ends with 0.
    """

    line: Text | None = None
    file: Path | None = None
    port: Annotated[Whole, within(1, 65535)] | None = None
    probe: Command | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(value is not None for value in (self.line, self.file, self.port, self.probe)) != 1:
            raise MisfitError("a process is ready by one of line, file, port and probe", "give exactly one of them")
        return self


class StopEntry(Entry):
    """How a process is stopped: by a signal to its process group, and killed if it still runs after so many seconds."""

    signal: Signal = "TERM"
    within: Seconds = 5.0


def _argument(value: str) -> str:
    try:
        fields = {name for _, name, spec, conversion in string.Formatter().parse(value) if name is not None}
        value.format(key="", value="")
    except (ValueError, LookupError, AttributeError):
        fields = set()
    if fields != {"key", "value"}:
        raise MisfitError(f"{value!r} does not say how an argument is written", 'such as "--{key}={value}"')
    return value


class ParametersEntry(Entry):
    """How a process takes its parameters: exactly one of file, argument and stdin.

    Attributes:
        file: they are written there as a JSON object, before it starts and when they change.
        signal: sent to it when the file has changed while it runs; without one it is left to notice it.
        argument: each is an argument of this form; when they change while it runs, it is started again.
        stdin: ``json``: a JSON object in one line, when it starts and when they change.
    """

    file: Path | None = None
    signal: Signal | None = None
    argument: Annotated[Text, AfterValidator(_argument)] | None = None
    stdin: Literal["json"] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if sum(value is not None for value in (self.file, self.argument, self.stdin)) != 1:
            raise MisfitError("parameters are given by one of file, argument and stdin", "give exactly one of them")
        if self.signal is not None and self.file is None:
            raise MisfitError("a signal goes with a file of parameters", "leave it out, or give a file")
        return self


class LimitsEntry(Entry):
    """See :class:`rosa_core.mape.Limits`; what is left out is as usual."""

    activation: Seconds | None = None
    deactivation: Seconds | None = None
    parameters: Seconds | None = None
    attempts: Annotated[Whole, within(1, 1000)] | None = None
    restarts: Annotated[Whole, within(0, 1000)] | None = None
    restarts_within: Seconds | None = None
    recovery: Seconds | None = None

    def limits(self) -> Limits:
        """The limits that these are."""
        return Limits(**self.model_dump(exclude_none=True))


class ProcessEntry(Entry):
    """A component that is a program.

    Attributes:
        command: the program and its arguments.
        env: what its environment has besides the manager's.
        folder: where it works; relative to the robot's file, whose folder it is by default.
        ready: how it shows that it is ready; by default it is as soon as it runs.
        stop: how it is stopped.
        parameters: how it takes parameters, if it has any.
        limits: how much time and how many attempts it gets.
        log: a file to which its output is added.
        standby: whether it is started with the robot and waits: then activating and deactivating it is only said to it,
            by a line ``{"active": true}`` or ``{"active": false}`` on its standard input.
    """

    command: Command
    env: dict[Name, Name] = Field(default_factory=dict)
    folder: Path = Path()
    ready: ReadyEntry | None = None
    stop: StopEntry = StopEntry()
    parameters: ParametersEntry | None = None
    limits: LimitsEntry = LimitsEntry()
    log: Path | None = None
    standby: Flag = False


class UnitParametersEntry(Entry):
    """How a unit takes its parameters.

    Attributes:
        file: they are written there as lines ``KEY=VALUE``, for the unit's ``EnvironmentFile``.
        apply: what is done with a unit that runs when they have changed.
    """

    file: Path
    apply: Literal["restart", "reload"] = "restart"


class UnitEntry(Entry):
    """A component that is a unit of systemd.

    Attributes:
        unit: its name, with its suffix, such as ``camera.service``.
        scope: whose systemd runs it: the user's or the system's.
        parameters: how it takes parameters, if it has any.
        limits: how much time and how many attempts it gets.
    """

    unit: Annotated[Text, Field(pattern=r"^[A-Za-z0-9:_.\\@-]+\.[a-z]+$")]
    scope: Literal["user", "system"] = "user"
    parameters: UnitParametersEntry | None = None
    limits: LimitsEntry = LimitsEntry()


class MqttEntry(Entry):
    """A component that is reached by MQTT.

    Attributes:
        mqtt: the topic under which it has its state, commands and parameters.
        limits: how much time and how many attempts it gets.
    """

    mqtt: Annotated[Text, Field(pattern=r"^[^+#/\x00][^+#\x00]*[^+#/\x00]$")]
    limits: LimitsEntry = LimitsEntry()


class BrokerEntry(Entry):
    """Where the MQTT broker is.

    Attributes:
        host: its name or address.
        port: its port.
        keepalive: the longest silence, in s, after which a connection counts as lost.
    """

    host: Text = "127.0.0.1"
    port: Annotated[Whole, within(1, 65535)] = 1883
    keepalive: Annotated[Whole, within(1, 3600)] = 5


ManagedEntry = ProcessEntry | UnitEntry | MqttEntry


def entry_type(declared: Any) -> type[ProcessEntry] | type[UnitEntry] | type[MqttEntry]:
    """Which kind of entry something under ``managed:`` is meant to be."""
    keys = declared if isinstance(declared, dict) else ()
    return UnitEntry if "unit" in keys else MqttEntry if "mqtt" in keys else ProcessEntry
