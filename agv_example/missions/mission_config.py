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

import numpy as np

from agv_example.corridors import CorridorMap
from agv_example.map_formats import load_map, read_map
from agv_example.map_formats.checked import Checked
from agv_example.planning import Objective
from agv_example.planning.costs import StartUp
from rosa_core import InputError, InvalidValueError
from rosa_core.errors import Problem
from rosa_core.formats.yaml_source import YamlSource

_KEYS = ("map", "start", "goals", "minimise", "battery", "start_up", "time_limit", "models", "events")
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
class Happening:
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

    def happenings(self, rng: np.random.Generator) -> tuple[Happening, ...]:
        """What is going to happen this time, in order."""
        drawn = []
        for one in self.disturbances:
            time = round(float(rng.uniform(one.earliest, one.latest)), 1)
            subject = one.subjects[int(rng.integers(len(one.subjects)))]
            drawn.append(Happening(time, one.kind, subject, one.light))
        return tuple(sorted(drawn, key=lambda happening: happening.time))

    @property
    def lights(self) -> frozenset[float]:
        """All lights that there are or will be on the map."""
        dimmed = {one.light for one in self.disturbances if one.kind == "dims"}
        return frozenset({corridor.light for corridor in self.corridors.corridors} | dimmed | {1.0})


def default_mission() -> Path:
    """The file of the paper's story."""
    return Path(str(files("agv_example.missions"))) / "crossing.yaml"


def load_mission(path: str | PathLike[str]) -> MissionConfig:
    """Read a mission file.

    Raises:
        InputError: with file, line and hint for everything that is wrong with it or with the map that it names.
    """
    source = YamlSource(path)
    data = Checked(source, source.data)
    if not isinstance(source.data, dict) or not source.data:
        data.complain("not a mission", "it looks like 'map: paper.yaml', 'start: A', 'goals: [B]'")
    data.raise_problems()
    data.only(_KEYS)
    folder = Path(path).parent
    corridors = _map(data["map"], folder)
    start = _place(data["start"], corridors)
    goals = tuple(_place(entry, corridors) for entry in data["goals"].entries())
    if not goals:
        data["goals"].complain("there is nowhere to go", "write 'goals: [B]'")
    start_up = data["start_up"]
    start_up.only(("time", "energy"))
    config = MissionConfig(
        corridors,
        start,
        goals,
        objective=_objective(data["minimise"]),
        battery=data["battery"].number(1000.0, least=1e-3),
        start_up=StartUp(start_up["time"].number(0.5, least=0.0), start_up["energy"].number(0.5, least=0.0)),
        time_limit=data["time_limit"].number(300.0, least=1.0, most=1e6),
        models=tuple(filter(None, (_found(entry, folder, "models") for entry in data["models"].entries()))),
        disturbances=tuple(_disturbance(entry, corridors) for entry in data["events"].entries()),
    )
    data.raise_problems()
    return config


def _map(data: Checked, folder: Path) -> CorridorMap:
    if isinstance(data.value, dict):
        return read_map(data)
    path = _found(data, folder, "maps")
    data.raise_problems()
    return load_map(folder if path is None else path)


def _found(data: Checked, folder: Path, ours: str) -> Path | None:
    """The file of that name next to the mission's, or among those that come with the example."""
    name = data.text()
    several = [folder / name, Path(str(files(f"agv_example.{ours}"))) / name]
    found = next((path for path in several if path.is_file()), None)
    if found is None:
        data.complain(f"there is no file '{name}'", f"give its path from {folder}")
    return found


def _place(data: Checked, corridors: CorridorMap) -> str:
    name = data.text()
    try:
        return corridors.place(name).name if name else name
    except InputError as error:
        data.complain(error.problems[0].what, error.problems[0].hint)
        return name


def _objective(data: Checked) -> Objective:
    try:
        if isinstance(data.value, dict):
            return Objective.weighted({name: entry.number(least=0.0) for name, entry in data.items()})
        if isinstance(data.value, list):
            return Objective.in_order(data.texts())
        return Objective.first(data.text("energy"))
    except InvalidValueError as error:
        data.complain(str(error))
        return Objective.first("energy")


def _disturbance(data: Checked, corridors: CorridorMap) -> Disturbance:
    data.only(("at", "light", *KINDS))
    kinds = [kind for kind in KINDS if kind in data]
    if len(kinds) != 1:
        data.complain("what happens?", f"write one of {', '.join(KINDS)}, as in '{{at: 12, fails: kinect}}'")
        return Disturbance(0.0, 0.0, "fails", ())
    (kind,) = kinds
    earliest, latest = _when(data["at"])
    subjects = data[kind].texts()
    if not subjects:
        data[kind].complain("there is nothing to choose from")
    if ("light" in data) != (kind == "dims"):
        data.complain("'light' belongs to 'dims'", "write '{at: 10, dims: C3, light: 0.1}'")
    found = Disturbance(earliest, latest, kind, subjects, data["light"].number(1.0, least=0.0, most=1.0))
    problem = found.problem_on(corridors)
    if problem is not None:
        data[kind].complain(problem.what, problem.hint)
    return found


def _when(data: Checked) -> tuple[float, float]:
    if not isinstance(data.value, list):
        at = data.number(least=0.0)
        return at, at
    if len(data.value) != 2:
        data.complain("a moment is a number, or two to draw it from", "write 'at: [5, 20]'")
        return 0.0, 0.0
    earliest, latest = data[0].number(least=0.0), data[1].number(least=0.0)
    if latest < earliest:
        data.complain("the latest moment is before the earliest", "swap them")
        return earliest, earliest
    return earliest, latest
