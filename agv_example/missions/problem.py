"""The mission as a PDDL problem, made from the map."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from agv_example.corridors import CorridorMap
from agv_example.missions.mission_config import MissionConfig

ROBOT, ACTION, DEPARTURE = "agv1", "navigate", "departure"


@dataclass(frozen=True)
class PddlProblem:
    """A problem for ``agv_domain.pddl``.

    Attributes:
        text: as a file has it.
        places, corridors: the map's names by those of the objects, in lower case.
        stops: the names of the stops in their order.
    """

    text: str
    places: dict[str, str]
    corridors: dict[str, str]
    stops: tuple[str, ...]

    def place(self, name: str) -> str:
        """The place that an object stands for; by default the one of that name."""
        return self.places.get(name.lower(), name)


def mission_problem(config: MissionConfig) -> PddlProblem:
    """The stops of a mission in turn on its map."""
    stops = tuple(f"stop{number}" for number, _ in enumerate(config.goals, 1))
    taken = {ROBOT, ACTION, DEPARTURE, *stops}
    corridors = config.corridors
    places = _named((place.name for place in corridors.places), taken, "p")
    ways = _named((corridor.name for corridor in corridors.corridors), taken, "c")
    init = [f"(robot_at {ROBOT} {places[config.start]})", f"(navigate_action {ACTION})", f"(reached {DEPARTURE})"]
    for stop, before, goal in zip(stops, (DEPARTURE, *stops), config.goals, strict=False):
        init += [f"(stop_at {stop} {places[goal]})", f"(after {stop} {before})"]
    init += _connections(corridors, places, ways)
    lines = [
        "(define (problem agv_problem)",
        "  (:domain agv)",
        "",
        "  (:objects",
        f"    {ROBOT} - robot",
        f"    {ACTION} - action",
        f"    {' '.join((DEPARTURE, *stops))} - stop",
        f"    {' '.join(places.values())} - place",
        *([f"    {' '.join(ways.values())} - corridor"] if ways else []),
        "  )",
        "",
        "  (:init",
        *(f"    {fact}" for fact in init),
        "  )",
        "",
        f"  (:goal (reached {stops[-1]})))",
    ]
    return PddlProblem("\n".join(lines) + "\n", _by_object(places), _by_object(ways), stops)


def _connections(corridors: CorridorMap, places: dict[str, str], ways: dict[str, str]) -> Iterator[str]:
    """What leads where; that a corridor is closed now is nothing that stays."""
    for corridor in corridors.corridors:
        start, end = places[corridor.start], places[corridor.end]
        yield f"(connected {ways[corridor.name]} {start} {end})"
        if not corridor.one_way:
            yield f"(connected {ways[corridor.name]} {end} {start})"


def _named(names: Iterable[str], taken: set[str], prefix: str) -> dict[str, str]:
    """For each name one that PDDL can have and that nothing else has; PDDL has no upper case."""
    found: dict[str, str] = {}
    for name in names:
        word = re.sub(r"[^A-Za-z0-9_]", "_", name)
        stem = word if re.match(r"[A-Za-z]", word) else f"{prefix}{word}"
        number, free = 1, stem
        while free.lower() in taken:
            number += 1
            free = f"{stem}_{number}"
        taken.add(free.lower())
        found[name] = free
    return found


def _by_object(objects: dict[str, str]) -> dict[str, str]:
    return {pddl.lower(): name for name, pddl in objects.items()}
