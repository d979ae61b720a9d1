"""Reflexes written in YAML. What is wrong in a file is reported with file, line and hint, all of it at once."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Annotated

from pydantic import Field

from rosa_core.errors import nearest
from rosa_core.formats.checked_file import CheckedFile, Entry, Name, Number, Text, read_yaml_file, within
from rosa_reflexes.commands import Bounds, Command
from rosa_reflexes.config import GateConfig, fault_reflex
from rosa_reflexes.gate import DELIBERATION_SILENT, Watchdog
from rosa_reflexes.reflex import Reflex
from rosa_reflexes.rules import Rule, RuleError, parse_rule
from rosa_reflexes.sensors import SensorLimits

_FORM = "it looks like 'reflexes: {keep clear: {rule: range.front < 0.35 -> stop}}'"
_NAME = re.compile(r"[A-Za-z_]\w*(\.\w+)*")
_RESERVED = frozenset({"and", "or", "not", "release", "for", "faulty", "s", "min", "max", "abs"})

Seconds = Annotated[Number, within(0.0)]
"""A time from 0 up, s."""


class SensorEntry(Entry):
    """A sensor: its range in its own unit, the times after which it is faulty, and what is commanded then."""

    lowest: Number | None = None
    highest: Number | None = None
    silent_after: Seconds | None = None
    stuck_after: Seconds | None = None
    on_fault: Name | None = None
    works_again_after: Seconds = 0.0


class BoundsEntry(Entry):
    """What a channel may be commanded, and by how much that may change in a second."""

    lowest: Number | None = None
    highest: Number | None = None
    rate: Number | None = None


class ReflexEntry(Entry):
    """A reflex: its rule in one line; of several that have fired, the one with the greatest priority commands."""

    rule: Text
    priority: Number = 0.0
    dwell: Seconds = 0.0


class WatchdogEntry(Entry):
    """What is commanded when deliberation has submitted nothing for so many seconds."""

    silent_after: Seconds
    command: Name


class ReflexFile(Entry):
    """A file of reflexes."""

    sensors: dict[Name, SensorEntry]
    commands: dict[Name, dict[Name, Number]]
    reflexes: dict[Name, ReflexEntry]
    safe_command: Name
    parameters: dict[Name, Number] = Field(default_factory=dict)
    bounds: dict[Name, BoundsEntry] = Field(default_factory=dict)
    watchdog: WatchdogEntry | None = None


def read_reflexes(path: str | PathLike[str]) -> GateConfig:
    """Read a file of reflexes.

    Args:
        path: the file, YAML or JSON.

    Raises:
        InputError: if it cannot be read or does not hold together; with file, line and hint for all that is wrong.
    """
    file = read_yaml_file(path, ReflexFile, "a file of reflexes", _FORM)
    _check_names(file)
    commands = _commands(file)
    sensors = _sensors(file)
    bounds = _bounds(file)
    _check_within(file, commands, bounds)
    reflexes = [*_fault_reflexes(file, commands), *_rule_reflexes(file, commands)]
    safe_command = _command(file, commands, file.content.safe_command, "safe_command")
    watchdog = _watchdog(file, commands)
    file.raise_problems()
    return GateConfig(
        sensors=tuple(sensors),
        reflexes=tuple(reflexes),
        safe_command=safe_command,
        commands=commands,
        parameters=file.content.parameters,
        bounds=bounds,
        watchdog=watchdog,
    )


def _check_names(file: CheckedFile[ReflexFile]) -> None:
    content = file.content
    for section, names in (
        ("sensors", content.sensors),
        ("parameters", content.parameters),
        ("commands", content.commands),
    ):
        for name in names:
            if name in _RESERVED:
                file.refuse(f"'{name}' has a meaning of its own in rules", "give it another name", section, name)
            elif _NAME.fullmatch(name) is None:
                hint = "letters, digits, _ and dots, as in range.front"
                file.refuse(f"no rule could name '{name}'", hint, section, name)
    for name in content.parameters:
        if name in content.sensors:
            file.refuse(f"'{name}' is a sensor as well", "give the parameter another name", "parameters", name)
    for name in content.reflexes:
        if name == DELIBERATION_SILENT or name in {f"{sensor} faulty" for sensor in content.sensors}:
            file.refuse(f"the gate itself has a reflex '{name}'", "give it another name", "reflexes", name)


def _commands(file: CheckedFile[ReflexFile]) -> dict[str, Command]:
    """The commands; each must give every channel, or the others would keep what was commanded before."""
    commands = file.content.commands
    channels = dict.fromkeys(channel for command in commands.values() for channel in command)
    for name, command in commands.items():
        missing = [channel for channel in channels if channel not in command]
        if missing or not command:
            what = f"the command '{name}' gives no value for {', '.join(missing) or 'any channel'}"
            file.refuse(what, "every command gives all channels", "commands", name)
    return {name: dict(command) for name, command in commands.items()}


def _sensors(file: CheckedFile[ReflexFile]) -> list[SensorLimits]:
    sensors = []
    for name, entry in file.content.sensors.items():
        with file.refusing("sensors", name):
            sensors.append(
                SensorLimits(
                    name,
                    _or(entry.lowest, -math.inf),
                    _or(entry.highest, math.inf),
                    _or(entry.silent_after, math.inf),
                    _or(entry.stuck_after, math.inf),
                )
            )
    return sensors


def _bounds(file: CheckedFile[ReflexFile]) -> dict[str, Bounds]:
    channels = {channel for command in file.content.commands.values() for channel in command}
    bounds = {}
    for name, entry in file.content.bounds.items():
        if name not in channels:
            file.refuse(f"no command has a channel '{name}'", nearest(name, channels), "bounds", name)
        with file.refusing("bounds", name):
            bounds[name] = Bounds(_or(entry.lowest, -math.inf), _or(entry.highest, math.inf), _or(entry.rate, math.inf))
    return bounds


def _check_within(file: CheckedFile[ReflexFile], commands: Mapping[str, Command], bounds: Mapping[str, Bounds]) -> None:
    for name, command in commands.items():
        for channel, value in command.items():
            if channel in bounds and bounds[channel].hold(value) != value:
                one = bounds[channel]
                what = f"{channel} may be from {one.lowest:g} to {one.highest:g}, not {value:g}"
                file.refuse(what, None, "commands", name, channel)


def _fault_reflexes(file: CheckedFile[ReflexFile], commands: Mapping[str, Command]) -> Iterable[Reflex]:
    for name, entry in file.content.sensors.items():
        if entry.on_fault is not None:
            command = _command(file, commands, entry.on_fault, "sensors", name, "on_fault")
            yield fault_reflex(name, command, release_after=entry.works_again_after)


def _rule_reflexes(file: CheckedFile[ReflexFile], commands: Mapping[str, Command]) -> Iterable[Reflex]:
    for name, entry in file.content.reflexes.items():
        at = ("reflexes", name, "rule")
        try:
            rule = parse_rule(entry.rule)
        except RuleError as error:
            file.refuse(str(error), "a rule looks like 'range.front < 0.35 -> stop; release > 0.5 for 0.3 s'", *at)
            continue
        _check_rule(file, rule, at)
        yield Reflex(
            name,
            rule.names,
            rule.trigger,
            _command(file, commands, rule.command, *at),
            rule.release,
            release_after=rule.release_after,
            dwell=entry.dwell,
            priority=entry.priority,
            describe=rule.trigger_text,
        )


def _check_rule(file: CheckedFile[ReflexFile], rule: Rule, at: tuple[str, ...]) -> None:
    sensors, parameters = file.content.sensors, file.content.parameters
    for name in rule.names:
        if name not in sensors and name not in parameters:
            known = (*sensors, *parameters)
            file.refuse(f"there is no sensor or parameter '{name}'", nearest(name, known) or _those(known), *at)
        elif name in rule.sensors and name not in sensors:
            file.refuse(f"'{name}' is a parameter, which has no faults", None, *at)
    if rule.names and all(name in parameters for name in rule.names):
        file.refuse("it reads no sensor", "compare a sensor with something", *at)


def _watchdog(file: CheckedFile[ReflexFile], commands: Mapping[str, Command]) -> Watchdog | None:
    entry = file.content.watchdog
    if entry is None:
        return None
    return Watchdog(entry.silent_after, _command(file, commands, entry.command, "watchdog", "command"))


def _command(file: CheckedFile[ReflexFile], commands: Mapping[str, Command], name: str, *at: str) -> Command:
    if name not in commands:
        file.refuse(f"there is no command '{name}'", nearest(name, commands) or _those(commands), *at)
    return commands.get(name, {})


def _those(names: Iterable[str]) -> str:
    return f"there are: {', '.join(names) or 'none'}"


def _or(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value
