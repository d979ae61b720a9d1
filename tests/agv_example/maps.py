"""Maps and knowledge bases for the tests of the AGV."""

from __future__ import annotations

from collections.abc import Iterable
from importlib.resources import files
from itertools import pairwise
from pathlib import Path

from hypothesis import strategies as st

from agv_example.corridors import Corridor, CorridorMap, Place
from agv_example.drive_configurations import DriveOptions, drive_options
from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock

MODELS = Path(str(files("agv_example.models")))
AGV = MODELS / "agv.yaml"
AGV_MOVE = MODELS / "agv_move.yaml"
AGV_MISSION = MODELS / "agv_mission.yaml"


def paper_corridors(**c1: object) -> CorridorMap:
    """A to B directly through C1 with obstacles, or round through C4, C3 and C2 (ROSA paper, section 7.4.1)."""
    places = (Place("A", 0, 0), Place("B", 20, 0), Place("C", 0, 10), Place("D", 20, 10))
    first: dict[str, object] = {"obstacles": 2, "accuracy": 1.6, **c1}
    return CorridorMap(
        places,
        (
            Corridor("C1", "A", "B", 20.0, **first),  # type: ignore[arg-type]
            Corridor("C4", "A", "C", 10.0),
            Corridor("C3", "C", "D", 20.0),
            Corridor("C2", "D", "B", 10.0),
        ),
    )


def agv_kb(failed: Iterable[str] = ()) -> KnowledgeBase:
    """The knowledge base of an AGV that stands somewhere in the light, with these components failed."""
    kb = KnowledgeBase(KnowledgeModel.load(AGV, AGV_MOVE), SimulationClock())
    for component in failed:
        kb.set_component_failure(component)
    return kb


def options_on(corridors: CorridorMap, kb: KnowledgeBase) -> DriveOptions:
    """What the robot can be configured as on this map."""
    return drive_options(kb, {corridor.light for corridor in corridors.corridors})


@st.composite
def small_maps(draw: st.DrawFn) -> CorridorMap:
    """Two to five places in a row, joined by corridors of every kind, and up to three corridors more."""
    names = "ABCDE"[: draw(st.integers(2, 5))]
    places = tuple(Place(name, float(number), float(number % 2)) for number, name in enumerate(names))
    more = draw(st.lists(st.tuples(st.sampled_from(names), st.sampled_from(names)), max_size=3))
    pairs = [*pairwise(names), *((one, other) for one, other in more if one != other)]
    corridors = [
        Corridor(
            name=f"C{number}",
            start=one,
            end=other,
            length=draw(st.sampled_from([1.0, 2.5, 4.0, 7.3])),
            obstacles=draw(st.integers(0, 2)),
            accuracy=draw(st.sampled_from([0.0, 0.0, 1.3, 1.6])),
            light=draw(st.sampled_from([0.5, 0.9, 1.0])),
            speed_limit=draw(st.sampled_from([None, None, 0.3, 0.5])),
            one_way=draw(st.sampled_from([False, False, True])),
            closed=draw(st.sampled_from([False] * 7 + [True])),
        )
        for number, (one, other) in enumerate(pairs)
    ]
    return CorridorMap(places, tuple(corridors))


def configurations() -> st.SearchStrategy[tuple[int, ...]]:
    """Two to four of the 18 configurations, so that brute force comes to an end; slow ones may go everywhere."""
    return st.lists(st.integers(0, 17), min_size=2, max_size=4, unique=True).map(tuple)
