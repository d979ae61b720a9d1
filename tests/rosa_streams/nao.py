"""The case study's robots for tests: specifications from the data directory, computations that only count."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path

from rosa_core.clock import SimulationClock
from rosa_streams.costs import LearnedCosts, Objective
from rosa_streams.environment import Transformation
from rosa_streams.manager import Manager
from rosa_streams.runtime import Function, Sources
from rosa_streams.specification import load_specification
from rosa_streams.tags import Ontology, load_ontology

DATA = Path(__file__).parent / "data"
BALL = "Position ⊓ ∃hasSource.Ball"
FUSED = "FusedPosition ⊓ ∃hasSource.Ball"
FIELD = DATA / "piff_and_puff.yaml"


def field() -> Ontology:
    """Two robots, and what a fused position is."""
    return load_ontology(FIELD)


def robot(name: str) -> list[Transformation]:
    """The transformations that a robot registers."""
    environment = load_specification(DATA / "table1.xml", DATA / "pose.xml", FIELD).environment
    return [each for each in environment.library().values() if f"({name})" in each.tid]


def fusion() -> list[Transformation]:
    """The transformation that fuses two positions."""
    return list(load_specification(DATA / "fuse.xml", FIELD).environment.transformations)


def sources() -> Sources:
    """Computations that pass a frame's number on."""
    known = Sources()
    resolutions = [
        f"{channel}{size}" for channel in "yuv" for size in ("640x480", "320x240", "160x120", "80x60", "40x30")
    ]

    @known.factory("nao/BottomCamera")
    def camera(parameters: Mapping[str, object]) -> Function:
        frames = itertools.count()
        return Function(lambda now: next(frames), (), ("image",), period=0.1)

    @known.factory("nao/Subsampler")
    def subsampler(parameters: Mapping[str, object]) -> Function:
        return Function(lambda image: dict.fromkeys(resolutions, image), ("image",), resolutions)

    known.function("nao/Segmenter", lambda y, v: ("hull", y), when="all")
    known.function("nao/BallDetector", lambda hull, *images: images[0], when="all")
    known.function("nao/BallLocalization", lambda ball, pose: {"frame": ball, "robot": pose})
    known.function("nao/FuseBallPositions", lambda first, second: {"first": first, "second": second})

    @known.factory("nao/Pose")
    def pose(parameters: Mapping[str, object]) -> Function:
        return Function(lambda now: "pose", (), ("pose",), period=0.5)

    return known


def manager(clock: SimulationClock | None = None, **options: object) -> Manager:
    """A manager in simulated time; every measured call takes a millisecond of processor time."""
    seconds = itertools.count()
    settings = {"costs": LearnedCosts(), "objective": Objective(horizon=60.0), **options}
    return Manager(
        clock or SimulationClock(),
        sources(),
        field(),
        cpu_time=lambda: next(seconds) / 1000,
        **settings,  # type: ignore[arg-type]
    )
