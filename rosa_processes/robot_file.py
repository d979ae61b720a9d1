"""The file that a real robot is described in: its model, how its components are managed, its mission and monitors."""

from __future__ import annotations

import pkgutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field

from rosa_core import KnowledgeModel
from rosa_core.errors import InputError, InvalidValueError, Problem, nearest
from rosa_core.formats.checked_file import (
    CheckedFile,
    Entry,
    Flag,
    Name,
    Names,
    Number,
    Text,
    checked_part,
    read_yaml_file,
    within,
)
from rosa_core.formats.misfits import MisfitError
from rosa_core.formats.yaml_source import YamlSource
from rosa_core.mape import Limits
from rosa_core.model.utility import Limit
from rosa_processes.declarations import BrokerEntry, ManagedEntry, MqttEntry, Seconds, entry_type

_FORM = "it looks like 'model: robot_model.yaml' and 'managed:' with a line for each component"


def _several_files(value: object) -> object:
    return value if isinstance(value, list) else [value]


def _limit(value: str) -> str:
    try:
        Limit.parse(value)
    except InvalidValueError as error:
        raise MisfitError(str(error), "such as 'battery >= 0.9'") from None
    return value


class PddlEntry(Entry):
    """A mission in PDDL."""

    domain: Path
    problem: Path


class ActionEntry(Entry):
    """How an action is carried out beyond what its components do; without any of these it goes on until it is stopped.

    Attributes:
        duration: it is done after so many seconds.
        until: it is done when a measure is so, such as ``battery >= 0.9``.
        skill: it is done as this says, ``module:name``: a :class:`task_layer.skill.Skill`, the class or an instance.
    """

    duration: Seconds | None = None
    until: Annotated[Text, AfterValidator(_limit)] | None = None
    skill: Annotated[Text, Field(pattern=r"^[\w.]+:[\w.]+$")] | None = None


class MonitorsEntry(Entry):
    """Where diagnostics come from, as lines of JSON.

    Attributes:
        stdin: whether they come on standard input.
        socket: a Unix socket at which monitors connect.
        port: a TCP port of this computer at which they do.
    """

    stdin: Flag = False
    socket: Path | None = None
    port: Annotated[int, within(0, 65535)] | None = None


class _RobotEntry(Entry):
    model: Annotated[tuple[Path, ...], BeforeValidator(_several_files), Field(min_length=1)]
    managed: dict[Name, Any]
    mission: Path | PddlEntry | None = None
    require: Names = ()
    actions: dict[Name, ActionEntry] = Field(default_factory=dict)
    journal: Path | None = None
    broker: BrokerEntry = BrokerEntry()
    monitors: MonitorsEntry = MonitorsEntry()
    watch_period: Annotated[Number, within(0.01, 3600)] = 1.0
    tick_period: Annotated[Number, within(0.001, 3600)] = 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotDescription:
    """A real robot as its file describes it.

    Attributes:
        folder: what paths in entries are relative to.
        model: the knowledge model.
        managed: how its nodes are managed, by component.
        mission: its mission, if it has one: a tree in XML, or PDDL.
        require: the actions that are required as long as it is up.
        actions: how actions are carried out.
        journal: where it keeps its knowledge, if it does.
        broker: where the MQTT broker is, for components that are reached by it.
        monitors: where diagnostics come from.
        watch_period: how often all components are looked at, in s.
        tick_period: the longest time between two ticks of the mission, in s.
    """

    folder: Path
    model: KnowledgeModel
    managed: Mapping[str, ManagedEntry]
    mission: Path | PddlEntry | None
    require: tuple[str, ...]
    actions: Mapping[str, ActionEntry]
    journal: Path | None
    broker: BrokerEntry
    monitors: MonitorsEntry
    watch_period: float
    tick_period: float

    @property
    def limits(self) -> dict[str, Limits]:
        """The limits of its components."""
        return {name: entry.limits.limits() for name, entry in self.managed.items()}


def read_robot(path: str | PathLike[str]) -> RobotDescription:
    """Read a robot's file, and the model that it names.

    Args:
        path: the file, in YAML; paths in it are relative to its folder.

    Raises:
        InputError: with file, line and hint for everything that is wrong.
    """
    file = read_yaml_file(path, _RobotEntry, "a robot", _FORM)
    folder, entry = Path(path).absolute().parent, file.content
    model = KnowledgeModel.load(*(folder / part for part in entry.model))
    managed = _managed(file, YamlSource(path))
    _check_components(file, model, managed)
    _check_actions(file, model)
    if entry.mission is not None and entry.require:
        file.refuse(
            "a robot has a mission, or actions that are required throughout", "leave one of them out", "require"
        )
    file.raise_problems()
    mission = entry.mission
    if isinstance(mission, PddlEntry):
        mission = PddlEntry(domain=folder / mission.domain, problem=folder / mission.problem)
    elif mission is not None:
        mission = folder / mission
    return RobotDescription(
        folder=folder,
        model=model,
        managed=managed,
        mission=mission,
        require=entry.require,
        actions=entry.actions,
        journal=None if entry.journal is None else folder / entry.journal,
        broker=entry.broker,
        monitors=entry.monitors,
        watch_period=entry.watch_period,
        tick_period=entry.tick_period,
    )


def with_mission(description: RobotDescription, files: Sequence[Path]) -> RobotDescription:
    """The same robot with another mission.

    Args:
        description: the robot.
        files: a tree in XML, or a PDDL domain and problem.

    Raises:
        InputError: if they are neither.
    """
    if len(files) == 1 and files[0].suffix.lower() != ".pddl":
        return replace(description, mission=files[0], require=())
    if len(files) == 2:
        return replace(description, mission=PddlEntry(domain=files[0], problem=files[1]), require=())
    hint = "--mission TREE.xml, or --mission DOMAIN.pddl --mission PROBLEM.pddl"
    raise InputError(Problem("a mission is a tree, or a domain and a problem", hint=hint))


def _managed(file: CheckedFile[_RobotEntry], source: YamlSource) -> dict[str, ManagedEntry]:
    """Each entry by itself, since what may stand in it depends on what it is."""
    managed: dict[str, ManagedEntry] = {}
    for key, declared in source.part(("managed",)).items():
        try:
            kind: Any = entry_type(declared)
            form = "it looks like 'command: [program, argument]', 'unit: name.service' or 'mqtt: topic'"
            managed[str(key)] = checked_part(source, ("managed", key), kind, "a managed component", form).content
        except InputError as error:
            file.problems += error.problems
    return managed


def _check_components(
    file: CheckedFile[_RobotEntry], model: KnowledgeModel, managed: Mapping[str, ManagedEntry]
) -> None:
    nodes = [component.name for component in model.components if component.type.is_node]
    others = {component.name for component in model.components} - set(nodes)
    for name in file.content.managed:
        if name in others:
            hint = f"give it 'type: ros_node' in the model, as what can be started and stopped, or leave '{name}' out"
            file.refuse(f"'{name}' is not a node", hint, "managed", name)
        elif name not in nodes:
            file.refuse(f"the model has no component '{name}'", nearest(name, nodes), "managed", name)
    for name in nodes:
        if name not in file.content.managed:
            file.refuse(f"it is not said how component '{name}' is managed", f"add '{name}:' with a command", "managed")
    with_parameters = {c.component for c in model.component_configurations if c.parameters}
    for name in sorted(with_parameters & managed.keys()):
        declared = managed[name]
        if not isinstance(declared, MqttEntry) and declared.parameters is None:
            hint = "add 'parameters:' with a file, an argument or stdin"
            file.refuse(f"it is not said how '{name}' takes its parameters", hint, "managed", name)


def _check_actions(file: CheckedFile[_RobotEntry], model: KnowledgeModel) -> None:
    known = [action.name for action in model.actions]
    measures = [measure.name for measure in model.measures]
    for name in file.content.require:
        if name not in known:
            file.refuse(f"the model has no action '{name}'", nearest(name, known), "require")
    for name, entry in file.content.actions.items():
        if name not in known:
            file.refuse(f"the model has no action '{name}'", nearest(name, known), "actions", name)
        if sum(value is not None for value in (entry.duration, entry.until, entry.skill)) > 1:
            what = f"'{name}' is done by one of duration, until and skill"
            file.refuse(what, "give at most one of them", "actions", name)
        if entry.until is not None and (measure := Limit.parse(entry.until).measure) not in measures:
            file.refuse(f"the model has no measure '{measure}'", nearest(measure, measures), "actions", name, "until")
        if entry.skill is not None:
            try:
                pkgutil.resolve_name(entry.skill)
            except (ImportError, AttributeError) as error:
                file.refuse(f"there is no '{entry.skill}': {error}", "module:name", "actions", name, "skill")
