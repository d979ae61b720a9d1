"""What an environment is (definitions 1 to 7 of the paper): facts that never change, and the update that makes new
ones.

A stream is an unbounded sequence of samples over a channel. A transformation says what streams it makes of what others;
a unit is a running instance of one; a target wishes for a stream by its meaning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, TypeAlias

from rosa_streams.errors import StreamError
from rosa_streams.tags import Concept, Ontology, Similarity

ParameterValue: TypeAlias = str | int | float | bool


class Sample(NamedTuple):
    """One element of a stream (definition 1): the value of a variable at a time, in seconds of the clock."""

    variable: str
    value: Any
    time: float


@dataclass(frozen=True, slots=True)
class Port:
    """A named input or output of a transformation, and the meaning of its stream."""

    name: str
    tag: Concept


@dataclass(frozen=True, slots=True)
class Transformation:
    """A stream-generating function with its tags (definition 2).

    With several outputs it stands for as many transformations with the same inputs, performed by one unit (section
    IV-A).

    Attributes:
        tid: its unique name (the label of the specification).
        source: names the implementation; see :class:`rosa_streams.runtime.Sources`.
        parameters: handed to the implementation, in order.
        quality: how good its streams are, for objectives that weigh quality; any scale.
        labor, upkeep: what is declared of its costs: processor seconds to start a unit, and per second of running one.
            None leaves them to the estimators.
    """

    tid: str
    source: str
    inputs: tuple[Port, ...] = ()
    outputs: tuple[Port, ...] = ()
    parameters: tuple[tuple[str, ParameterValue], ...] = ()
    quality: float = 0.0
    labor: float | None = None
    upkeep: float | None = None

    def __post_init__(self) -> None:
        names = [port.name for port in (*self.inputs, *self.outputs)]
        for name in names:
            if names.count(name) > 1:
                raise StreamError(f"the transformation '{self.tid}' has two ports '{name}'")

    def input(self, name: str) -> Port:
        """The input port of that name. Raises: KeyError."""
        return _port(self.inputs, name)

    def output(self, name: str) -> Port:
        """The output port of that name. Raises: KeyError."""
        return _port(self.outputs, name)


def _port(ports: tuple[Port, ...], name: str) -> Port:
    for port in ports:
        if port.name == name:
            return port
    raise KeyError(name)


@dataclass(frozen=True, slots=True)
class Unit:
    """A computation unit: a running instance of a transformation (definition 3).

    Attributes:
        cid: its unique name, such as ``segmenter.1``.
        tid: the transformation that it is an instance of.
        inputs: the channel that each input port subscribes to, or None.
        outputs: the channels that each output port writes to: none, one, or one for each target that it serves.
        state: what its state is at the beginning; while it runs, the state is the implementation's.
        parameters: in place of the transformation's parameters of the same names.
    """

    cid: str
    tid: str
    inputs: tuple[tuple[str, str | None], ...] = ()
    outputs: tuple[tuple[str, tuple[str, ...]], ...] = ()
    state: tuple[tuple[str, Any], ...] = ()
    parameters: tuple[tuple[str, ParameterValue], ...] = ()

    @classmethod
    def of(
        cls,
        cid: str,
        tid: str,
        inputs: Mapping[str, str | None] | None = None,
        outputs: Mapping[str, str | tuple[str, ...] | None] | None = None,
    ) -> Unit:
        """A unit from mappings of ports to channels.

        >>> Unit.of("cam.1", "cam", outputs={"image": "/image"}).channels()
        ('/image',)
        """
        written = tuple(
            (port, () if channels is None else (channels,) if isinstance(channels, str) else channels)
            for port, channels in (outputs or {}).items()
        )
        return cls(cid, tid, tuple((inputs or {}).items()), written)

    def subscription(self, port: str) -> str | None:
        """The channel that an input port subscribes to."""
        return dict(self.inputs).get(port)

    def channels(self) -> tuple[str, ...]:
        """The channels that it writes to."""
        return tuple(channel for _, channels in self.outputs for channel in channels)


@dataclass(frozen=True, slots=True)
class Target:
    """A wish for a stream by its meaning (definition 4), on a channel that clients subscribe to."""

    qid: str
    tag: Concept
    channel: str


@dataclass(frozen=True)
class Environment:
    """Computation graph, library, goal and the similarity of tags (definition 5)."""

    units: frozenset[Unit] = frozenset()
    transformations: frozenset[Transformation] = frozenset()
    targets: frozenset[Target] = frozenset()
    similarity: Similarity = field(default_factory=Ontology, compare=False)

    def library(self) -> dict[str, Transformation]:
        """The transformations by tid, in order."""
        return {each.tid: each for each in sorted(self.transformations, key=lambda each: each.tid)}

    def graph(self) -> dict[str, Unit]:
        """The units by cid, in order."""
        return {unit.cid: unit for unit in sorted(self.units, key=unit_order)}

    def goal(self) -> dict[str, Target]:
        """The targets by qid, in order."""
        return {target.qid: target for target in sorted(self.targets, key=lambda each: each.qid)}

    def writers(self) -> dict[str, list[tuple[Unit, str]]]:
        """For each channel, the units and ports that write to it."""
        found: dict[str, list[tuple[Unit, str]]] = {}
        for unit in sorted(self.units, key=unit_order):
            for port, channels in unit.outputs:
                for channel in channels:
                    found.setdefault(channel, []).append((unit, port))
        return found


@dataclass(frozen=True, slots=True)
class Change:
    """A change set (definition 6): additions and removals of units, transformations and targets.

    A unit that is reconfigured stands in both: as it was among the removals, as it is to be among the additions.
    """

    units_added: frozenset[Unit] = frozenset()
    units_removed: frozenset[Unit] = frozenset()
    transformations_added: frozenset[Transformation] = frozenset()
    transformations_removed: frozenset[Transformation] = frozenset()
    targets_added: frozenset[Target] = frozenset()
    targets_removed: frozenset[Target] = frozenset()

    def __bool__(self) -> bool:
        return any((
            self.units_added, self.units_removed, self.transformations_added, self.transformations_removed,
            self.targets_added, self.targets_removed,
        ))  # fmt: skip

    def created(self) -> tuple[Unit, ...]:
        """The units that are new, in order."""
        before = {unit.cid for unit in self.units_removed}
        return in_order(unit for unit in self.units_added if unit.cid not in before)

    def reconfigured(self) -> tuple[Unit, ...]:
        """The units that stay and are connected anew, as they are to be, in order."""
        before = {unit.cid for unit in self.units_removed}
        return in_order(unit for unit in self.units_added if unit.cid in before)

    def unloaded(self) -> tuple[Unit, ...]:
        """The units that go, in order."""
        after = {unit.cid for unit in self.units_added}
        return in_order(unit for unit in self.units_removed if unit.cid not in after)


def update(environment: Environment, change: Change) -> Environment:
    """The environment after a change: additions first, then removals (definition 7). Pure.

    >>> unit = Unit("a.1", "a")
    >>> update(Environment(), Change(units_added=frozenset({unit}), units_removed=frozenset({unit}))).units
    frozenset()
    """
    return Environment(
        (environment.units | change.units_added) - change.units_removed,
        (environment.transformations | change.transformations_added) - change.transformations_removed,
        (environment.targets | change.targets_added) - change.targets_removed,
        environment.similarity,
    )


def in_order(units: Iterable[Unit]) -> tuple[Unit, ...]:
    """Units in the order of their names, numbers counted as numbers."""
    return tuple(sorted(units, key=unit_order))


def unit_order(unit: Unit) -> tuple[str, int]:
    """What units are sorted by: ``segmenter.10`` comes after ``segmenter.9``."""
    base, _, number = unit.cid.rpartition(".")
    return (base, int(number)) if base and number.isdecimal() else (unit.cid, 0)


def subscriptions(environment: Environment) -> Iterator[tuple[Unit, str, str | None]]:
    """Every unit, input port of its transformation, and channel subscribed to (or None)."""
    library = environment.library()
    for unit in in_order(environment.units):
        transformation = library.get(unit.tid)
        ports = [port.name for port in transformation.inputs] if transformation else [name for name, _ in unit.inputs]
        connected = dict(unit.inputs)
        for port in ports:
            yield unit, port, connected.get(port)
