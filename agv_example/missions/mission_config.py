"""Mission files: where to go on which map, what to be best in, and what goes wrong.

::

    map: paper.yaml            # a map file, next to this one or one of ours, or the map itself
    start: A
    goals: [B, A]
    minimise: energy           # or {energy: 1, risk: 200}, or in order of importance [risk, time]
    battery: 1000              # units of draw times second
    start_up: {time: 0.5, energy: 0.5}
    time_limit: 300            # s
    models: [agv_published_draws.yaml]     # more knowledge
    events:
      - {at: 12, fails: kinect}
      - {at: [20, 40], works: [kinect, lidar]}     # when, and which of them, is drawn by the seed
      - {at: 30, closes: C2}
      - {at: 50, opens: C2}
      - {at: 10, dims: C3, light: 0.1}
"""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from agv_example.corridors import CorridorMap
from agv_example.map_formats import load_map, read_map
from agv_example.map_formats.own_format import AboveZero, FromZero, Part
from agv_example.planning import Objective
from agv_example.planning.costs import StartUp
from rosa_core.errors import Problem
from rosa_core.formats.checked_file import CheckedFile, Entry, Name, Names, Number, checked_part, within
from rosa_core.formats.misfits import MisfitError
from rosa_core.formats.yaml_source import YamlSource
from rosa_core.paths import is_file

KINDS = ("fails", "works", "closes", "opens", "dims")
COMPONENTS = ("lidar", "kinect", "camera", "lamp", "amcl", "mrpt", "aruco")


@dataclass(frozen=True, slots=True)
class Disturbance:
    """Something that happens to the robot or its map.

    Args:
        earliest, latest: s from the beginning; when in between, the seed draws.
        kind: fails, works (components), closes, opens, dims (corridors).
        subjects: one of them, the seed draws which.
        light: what a corridor is dimmed to.
    """

    earliest: float
    latest: float
    kind: str
    subjects: tuple[str, ...]
    light: float = 1.0

    def problem_on(self, corridors: CorridorMap) -> Problem | None:
        """The first of its subjects that there is not, on this map."""
        of_robot = self.kind in ("fails", "works")
        known = COMPONENTS if of_robot else [corridor.name for corridor in corridors.corridors]
        missing = next((subject for subject in self.subjects if subject not in known), None)
        if missing is None:
            return None
        what = "component that can fail" if of_robot else "corridor"
        return Problem(f"there is no {what} '{missing}'", hint=f"there are: {', '.join(known[:12])}")


@dataclass(frozen=True, slots=True)
class DrawnDisturbance:
    """A disturbance as it was drawn: at a time, s from the beginning, to one subject."""

    time: float
    kind: str
    subject: str
    light: float = 1.0


@dataclass(frozen=True)
class MissionConfig:
    """A mission. Times in s, energy in units of draw times second."""

    corridors: CorridorMap
    start: str
    goals: tuple[str, ...]
    objective: Objective = field(default_factory=lambda: Objective.first("energy"))
    battery: float = 1000.0
    start_up: StartUp = field(default_factory=StartUp)
    time_limit: float = 300.0
    models: tuple[Path, ...] = ()
    disturbances: tuple[Disturbance, ...] = ()
    reflexes: bool = False
    """Whether the bumper is a reflex."""

    def draw(self, rng: np.random.Generator) -> tuple[DrawnDisturbance, ...]:
        """The disturbances of one run, in order of time."""
        drawn = []
        for one in self.disturbances:
            time = round(float(rng.uniform(one.earliest, one.latest)), 1)
            subject = one.subjects[int(rng.integers(len(one.subjects)))]
            drawn.append(DrawnDisturbance(time, one.kind, subject, one.light))
        return tuple(sorted(drawn, key=lambda one: one.time))

    @property
    def lights(self) -> frozenset[float]:
        """All lights that there are or will be on the map."""
        dimmed = {one.light for one in self.disturbances if one.kind == "dims"}
        return frozenset({corridor.light for corridor in self.corridors.corridors} | dimmed | {1.0})


def default_mission() -> Path:
    """The file of the paper's example."""
    return Path(str(files("agv_example.missions"))) / "crossing.yaml"


def _twice(time: object) -> object:
    return time if isinstance(time, list) else [time, time]


def _earliest_and_latest(times: tuple[float, ...]) -> tuple[float, ...]:
    if len(times) != 2:
        raise ValueError("a time is a number, or two to draw it from: write 'at: [5, 20]'")
    if times[1] < times[0]:
        raise ValueError("the latest time is before the earliest: swap them")
    return times


_Subjects = Annotated[Names, Field(min_length=1)]


class _EventEntry(Entry):
    at: Annotated[tuple[FromZero, ...], BeforeValidator(_twice), AfterValidator(_earliest_and_latest)]
    fails: _Subjects | None = None
    works: _Subjects | None = None
    closes: _Subjects | None = None
    opens: _Subjects | None = None
    dims: _Subjects | None = None
    light: Part | None = None

    @model_validator(mode="after")
    def _one_thing_happens(self) -> _EventEntry:
        if sum(getattr(self, kind) is not None for kind in KINDS) != 1:
            hint = f"write one of {', '.join(KINDS)}, as in '{{at: 12, fails: kinect}}'"
            raise MisfitError("what happens?", hint)
        if (self.light is None) is not (self.dims is None):
            raise MisfitError("'light' belongs to 'dims'", "write '{at: 10, dims: C3, light: 0.1}'")
        return self

    def disturbance(self) -> Disturbance:
        kind = next(kind for kind in KINDS if getattr(self, kind) is not None)
        earliest, latest = self.at
        return Disturbance(earliest, latest, kind, getattr(self, kind), 1.0 if self.light is None else self.light)


class _StartUpEntry(Entry):
    time: FromZero = 0.5
    energy: FromZero = 0.5


class _MissionEntry(Entry):
    map: Name | dict[str | int, Any]
    start: Name
    goals: tuple[Name, ...] = ()
    minimise: Name | tuple[Name, ...] | dict[Name, FromZero] = "energy"
    battery: AboveZero = 1000.0
    start_up: _StartUpEntry = _StartUpEntry()
    time_limit: Annotated[Number, within(1.0, 1e6)] = 300.0
    models: tuple[Name, ...] = ()
    events: tuple[_EventEntry, ...] = ()


def load_mission(path: str | PathLike[str]) -> MissionConfig:
    """Read a mission file.

    Args:
        path: a file in the form that the head of this module shows.

    Raises:
        InputError: with file, line and hint for everything that is wrong with it or with the map that it names.
    """
    source = YamlSource(path)
    file = checked_part(
        source, (), _MissionEntry, "a mission", "it looks like 'map: paper.yaml', 'start: A', 'goals: [B]'"
    )
    entry, folder = file.content, Path(path).parent
    corridors = _map(file, source, folder)
    if not entry.goals:
        file.refuse("there is nowhere to go", "write 'goals: [B]'", "goals")
    for at, name in [(("start",), entry.start), *((("goals", i), name) for i, name in enumerate(entry.goals))]:
        with file.refusing(*at):
            corridors.place(name)
    objective = Objective.first("energy")
    with file.refusing("minimise"):
        objective = _objective(entry.minimise)
    disturbances = tuple(event.disturbance() for event in entry.events)
    for index, disturbance in enumerate(disturbances):
        problem = disturbance.problem_on(corridors)
        if problem is not None:
            file.refuse(problem.what, problem.hint, "events", index, disturbance.kind)
    models = [_found(file, name, folder, "models", "models", index) for index, name in enumerate(entry.models)]
    file.raise_problems()
    return MissionConfig(
        corridors,
        entry.start,
        entry.goals,
        objective=objective,
        battery=entry.battery,
        start_up=StartUp(entry.start_up.time, entry.start_up.energy),
        time_limit=entry.time_limit,
        models=tuple(filter(None, models)),
        disturbances=disturbances,
    )


def _map(file: CheckedFile[_MissionEntry], source: YamlSource, folder: Path) -> CorridorMap:
    if not isinstance(file.content.map, str):
        return read_map(source, ("map",))
    path = _found(file, file.content.map, folder, "maps", "map")
    file.raise_problems()
    return load_map(folder if path is None else path)


def _found(file: CheckedFile[Any], name: str, folder: Path, ours: str, *at: str | int) -> Path | None:
    """The file of that name next to the mission's, or among those that come with the example."""
    several = [folder / name, Path(str(files(f"agv_example.{ours}"))) / name]
    found = next((path for path in several if is_file(path)), None)
    if found is None:
        file.refuse(f"there is no file '{name}'", f"give its path from {folder}", *at)
    return found


def _objective(minimise: str | tuple[str, ...] | dict[str, float]) -> Objective:
    if isinstance(minimise, dict):
        return Objective.weighted(minimise)
    return Objective.first(minimise) if isinstance(minimise, str) else Objective.in_order(minimise)
