"""The map: places, and corridors between them that each ask something of the robot that is to drive there."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from rosa_core import InputError
from rosa_core.errors import Problem, nearest

FULL_LIGHT = 1.0


@dataclass(frozen=True, slots=True)
class Place:
    """Somewhere the robot can be; ``x`` and ``y`` in m."""

    name: str
    x: float
    y: float


@dataclass(frozen=True, slots=True)
class Drive:
    """What driving a corridor was measured to be like: seconds, and how often something was hit on average."""

    time: float
    hits: float


@dataclass(frozen=True, slots=True)
class MeasuredDrives:
    """What was measured in one direction of a corridor; it is driven only in ways that were.

    Args:
        drives: by the components in use and their speed (m/s; None: at whatever speed).
        parts: the components that make a difference.
    """

    drives: Mapping[tuple[frozenset[str], float | None], Drive]
    parts: frozenset[str]

    def drive(self, components: frozenset[str], speed: float) -> Drive | None:
        """What was measured with these components, others besides them not counting; None if nothing was.

        Args:
            components: those in use; those that make no difference here do not count.
            speed: m/s.

        Returns:
            what was measured at that speed, else at whatever speed; None if nothing was.
        """
        used = components & self.parts
        return self.drives.get((used, speed)) or self.drives.get((used, None))


@dataclass(frozen=True, slots=True)
class Corridor:
    """A way between two places.

    Args:
        name: what it is called.
        start, end: its places.
        length: in m.
        obstacles: how many there are to be passed.
        accuracy: the least estimated accuracy that is asked for.
        light: from 0, dark, to 1.
        speed_limit: in m/s; None: no limit.
        one_way: only from start to end.
        closed: nobody may drive there.
        measured: what driving it was measured to be like, by the place where the drive begins.
    """

    name: str
    start: str
    end: str
    length: float
    obstacles: int = 0
    accuracy: float = 0.0
    light: float = FULL_LIGHT
    speed_limit: float | None = None
    one_way: bool = False
    closed: bool = False
    measured: Mapping[str, MeasuredDrives] = field(default_factory=dict)

    def other_end(self, place: str) -> str:
        """The end that ``place`` is not."""
        return self.end if place == self.start else self.start

    def origins(self) -> tuple[str, ...]:
        """The ends from which it may be entered now."""
        if self.closed:
            return ()
        return (self.start,) if self.one_way else (self.start, self.end)


@dataclass(frozen=True)
class CorridorMap:
    """Places and corridors, in a fixed order.

    Raises:
        InputError: if two have the same name, a corridor leads from or to where there is no place, or a number makes
            no sense.
    """

    places: tuple[Place, ...]
    corridors: tuple[Corridor, ...]
    name: str = "map"

    def __post_init__(self) -> None:
        problems = list(_problems(self))
        if problems:
            raise InputError(problems)

    @cached_property
    def place_index(self) -> Mapping[str, int]:
        """The number of each place."""
        return {place.name: number for number, place in enumerate(self.places)}

    @cached_property
    def _corridor_index(self) -> Mapping[str, int]:
        return {corridor.name: number for number, corridor in enumerate(self.corridors)}

    def place(self, name: str) -> Place:
        """The place of that name.

        Raises:
            InputError: if there is none.
        """
        if name not in self.place_index:
            hint = _known(name, self.place_index)
            raise InputError(Problem(f"there is no place '{name}' on the {self.name}", hint=hint))
        return self.places[self.place_index[name]]

    def corridor(self, name: str) -> Corridor:
        """The corridor of that name.

        Raises:
            InputError: if there is none.
        """
        if name not in self._corridor_index:
            hint = _known(name, self._corridor_index)
            raise InputError(Problem(f"there is no corridor '{name}' on the {self.name}", hint=hint))
        return self.corridors[self._corridor_index[name]]

    def changing(self, changed: Corridor) -> CorridorMap:
        """The map with one corridor as it is now; its name and its ends stay."""
        self.corridor(changed.name)
        corridors = list(self.corridors)
        corridors[self._corridor_index[changed.name]] = changed
        return replace(self, corridors=tuple(corridors))


def distance(one: Place, other: Place) -> float:
    """The straight distance.

    Args:
        one: a place.
        other: another.

    Returns:
        m.

    Example:
        >>> distance(Place("dock", 0.0, 0.0), Place("shelf", 3.0, 4.0))
        5.0
    """
    return math.hypot(one.x - other.x, one.y - other.y)


def _known(name: str, names: Iterable[str]) -> str:
    some = sorted(names)
    return nearest(name, some) or f"there are: {', '.join(some[:12])}{', ...' if len(some) > 12 else ''}"


def _problems(a_map: CorridorMap) -> Iterable[Problem]:
    kinds = {"place": [place.name for place in a_map.places], "corridor": [c.name for c in a_map.corridors]}
    for kind, names in kinds.items():
        for name, number in Counter(names).items():
            if number > 1:
                yield Problem(f"there are two {kind}s '{name}'", hint="rename one")
    if not a_map.places:
        yield Problem("the map has no places", hint="name at least one under 'places:'")
    for place in a_map.places:
        if not (math.isfinite(place.x) and math.isfinite(place.y)):
            yield Problem(f"place '{place.name}' is nowhere", hint="give x and y in m")
    for corridor in a_map.corridors:
        yield from _corridor_problems(corridor, a_map.place_index)


def _corridor_problems(corridor: Corridor, places: Mapping[str, int]) -> Iterable[Problem]:
    what = f"corridor '{corridor.name}'"
    for end in (corridor.start, corridor.end):
        if end not in places:
            yield Problem(f"{what}: there is no place '{end}'", hint=_known(end, places))
    if corridor.start == corridor.end:
        yield Problem(f"{what} leads from '{corridor.start}' to itself", hint="remove it")
    if not 0.0 < corridor.length < math.inf:
        yield Problem(f"{what} is {corridor.length:g} m long", hint="give a length above 0")
    if corridor.obstacles < 0 or not math.isfinite(corridor.accuracy):
        yield Problem(f"{what} cannot ask for that", hint="obstacles are at least 0, accuracy is a number")
    if not 0.0 <= corridor.light <= FULL_LIGHT:
        yield Problem(f"{what}: light is {corridor.light:g}", hint="from 0, dark, to 1")
    if corridor.speed_limit is not None and not 0.0 < corridor.speed_limit < math.inf:
        yield Problem(f"{what}: the speed limit is {corridor.speed_limit:g} m/s", hint="above 0")
