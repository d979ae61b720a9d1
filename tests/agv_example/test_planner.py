"""The co-adaptive planner: the paper's example, and exactness against brute force and networkx."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise, product

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agv_example.corridors import Corridor, CorridorMap, Drive, MeasuredDrives, Place
from agv_example.drive_configurations import DriveConfiguration, DriveOptions
from agv_example.grids import grid_map
from agv_example.planning import (
    CoAdaptivePlanner,
    Costs,
    Criterion,
    Objective,
    Position,
    Route,
    TooManyRoutesError,
    drive_costs,
)
from agv_example.planning.costs import StartUp, permits
from rosa_core import InputError, InvalidValueError
from tests.agv_example.maps import agv_kb, configurations, options_on, paper_corridors, small_maps

ENERGY, TIME, RISK = (Objective.cheapest(name) for name in ("energy", "time", "risk"))
OBJECTIVES = (ENERGY, TIME, RISK, Objective.weighted({"energy": 0.3, "time": 1.0, "risk": 50.0}))
START_UP = StartUp(time=0.7, energy=0.4)
Assignment = list[tuple[Corridor, str, int]]


def planner(corridors: CorridorMap, failed: tuple[str, ...] = ()) -> CoAdaptivePlanner:
    return CoAdaptivePlanner(corridors, options_on(corridors, agv_kb(failed)), START_UP)


def route(corridors: CorridorMap, objective: Objective = ENERGY, *, failed: tuple[str, ...] = ()) -> Route:
    found = planner(corridors, failed).route("A", "B", objective)
    assert found is not None
    return found


# the paper's example


def test_with_everything_working_the_robot_goes_directly_with_kinect_and_amcl() -> None:
    (leg,) = route(paper_corridors()).legs
    assert (leg.corridor, leg.configuration.name) == ("C1", "kinect + amcl, high speed")


def test_without_the_kinect_it_goes_round_with_the_lidar() -> None:
    found = route(paper_corridors(), failed=("kinect",))
    assert found.corridors == ("C4", "C3", "C2")
    assert {leg.configuration.designs[0] for leg in found.legs} == {"lidar + amcl"}


def test_without_obstacles_it_goes_directly_with_the_lidar_all_the_same() -> None:
    found = route(paper_corridors(obstacles=0, accuracy=0.0), failed=("kinect",))
    assert [leg.configuration.designs[0] for leg in found.legs] == ["lidar + amcl"]


def test_a_closed_corridor_is_gone_round() -> None:
    assert route(paper_corridors(closed=True)).corridors == ("C4", "C3", "C2")


def test_in_a_dark_corridor_the_camera_needs_the_lamp_and_only_there() -> None:
    dark = paper_corridors().changing(Corridor("C3", "C", "D", 20.0, light=0.2))
    designs = [leg.configuration.designs[0] for leg in route(dark, failed=("kinect", "lidar")).legs]
    assert designs == ["camera + aruco", "camera + aruco + lamp", "camera + aruco"]


def test_it_keeps_to_speed_limits_corridor_by_corridor() -> None:
    slow = paper_corridors(closed=True).changing(Corridor("C3", "C", "D", 20.0, speed_limit=0.35))
    assert [leg.configuration.speed for leg in route(slow, TIME).legs] == [0.68, 0.35, 0.68]


def test_the_least_risk_is_not_to_pass_obstacles_and_among_those_the_slowest_is_safest() -> None:
    assert route(paper_corridors(), RISK).corridors == ("C4", "C3", "C2")
    only_way = CorridorMap(paper_corridors().places, paper_corridors().corridors[:1])
    assert route(only_way, RISK).legs[0].configuration.name == "kinect + amcl, safe speed"


def test_reconfiguring_costs_so_that_a_short_corridor_is_not_worth_a_change() -> None:
    """Aruco draws more than AMCL, but to start the Kinect and AMCL for one metre costs more than that saves."""
    short = CorridorMap((Place("A", 0, 0), Place("B", 1, 0)), (Corridor("C1", "A", "B", 1.0),))
    running = frozenset({"camera", "aruco", "move_base"})
    found = CoAdaptivePlanner(short, options_on(short, agv_kb()), START_UP).route("A", "B", ENERGY, running)
    assert found is not None
    assert found.legs[0].configuration.designs[0] == "camera + aruco"
    long = CorridorMap(short.places, (Corridor("C1", "A", "B", 100.0),))
    found = CoAdaptivePlanner(long, options_on(long, agv_kb()), START_UP).route("A", "B", ENERGY, running)
    assert found is not None
    assert found.legs[0].configuration.designs[0] == "kinect + amcl"


def test_there_is_no_route_where_there_is_no_way() -> None:
    assert planner(paper_corridors(closed=True)).route("A", "B", ENERGY) is not None
    assert planner(paper_corridors(), failed=("kinect", "lidar", "camera")).route("A", "B", ENERGY) is None
    island = CorridorMap((*paper_corridors().places, Place("Z", 50, 50)), paper_corridors().corridors)
    assert planner(island).route("A", "Z", ENERGY) is None
    assert planner(island).pareto("A", "Z") == []


def test_who_is_there_already_needs_no_legs() -> None:
    assert planner(paper_corridors()).route("B", "B", ENERGY) == Route("B", ())
    assert planner(paper_corridors()).pareto("B", "B") == [Route("B", ())]


@pytest.mark.parametrize("where", [("A", "X"), ("X", "B")])
def test_an_unknown_place_is_named(where: tuple[str, str]) -> None:
    with pytest.raises(InputError, match=r"no place 'X'.*there are: A, B, C, D"):
        planner(paper_corridors()).route(*where, ENERGY)


# in the middle of a corridor


def test_half_way_without_the_kinect_it_turns_round() -> None:
    found = planner(paper_corridors(), ("kinect",)).route(Position("A", "C1", 8.0), "B", ENERGY)
    assert found is not None
    assert found.corridors == ("C1", "C4", "C3", "C2")
    assert found.legs[0].back
    assert found.legs[0].end == "A"
    assert found.legs[0].costs.time == pytest.approx(8.0 / 0.68 + 3 * 0.7)


def test_half_way_it_goes_on_if_it_can() -> None:
    found = planner(paper_corridors()).route(Position("A", "C1", 8.0), "B", ENERGY)
    assert found is not None
    assert [(leg.corridor, leg.end, leg.back) for leg in found.legs] == [("C1", "B", False)]
    assert found.costs.risk == pytest.approx(2 * 0.6 * 0.25**2.75)


def test_out_of_a_corridor_that_has_been_closed_it_goes_back() -> None:
    found = planner(paper_corridors(closed=True)).route(Position("A", "C1", 19.0), "B", ENERGY)
    assert found is not None
    assert found.legs[0].back


# exactness


def ways(corridors: CorridorMap, start: str, goal: str) -> Iterator[list[tuple[Corridor, str]]]:
    """Every way that visits no place twice."""

    def go_on(place: str, seen: tuple[str, ...]) -> Iterator[list[tuple[Corridor, str]]]:
        if place == goal:
            yield []
            return
        for corridor in corridors.corridors:
            other = corridor.other_end(place)
            if place in corridor.origins() and other not in seen:
                for rest in go_on(other, (*seen, other)):
                    yield [(corridor, place), *rest]

    yield from go_on(start, (start,))


def usable(corridor: Corridor, options: DriveOptions, number: int) -> bool:
    return number in options.in_light(corridor.light) and permits(corridor, options.configurations[number])


def total(way: list[tuple[Corridor, str]], several: tuple[DriveConfiguration, ...]) -> Costs:
    costs, running = Costs(), frozenset[str]()
    for (corridor, origin), configuration in zip(way, several, strict=True):
        driving = drive_costs(corridor, origin, configuration)
        assert driving is not None
        costs += driving + START_UP.costs(running, configuration.components)
        running = configuration.components
    return costs


def all_routes(corridors: CorridorMap, options: DriveOptions) -> Iterator[Costs]:
    """The costs of every way in every configuration of every corridor."""
    for way in ways(corridors, corridors.places[0].name, corridors.places[-1].name):
        columns = [
            [one for number, one in enumerate(options.configurations) if usable(corridor, options, number)]
            for corridor, _ in way
        ]
        for several in product(*columns):
            yield total(way, several)


def fewer(options: DriveOptions, numbers: tuple[int, ...]) -> DriveOptions:
    """Only some of the configurations, so that brute force comes to an end."""
    kept = [n for n in numbers if n < len(options.configurations)]
    lit = {case: frozenset(kept.index(n) for n in several if n in kept) for case, several in options.lit.items()}
    return DriveOptions(tuple(options.configurations[n] for n in kept), options.limits, lit)


@settings(max_examples=150, deadline=None)
@given(small_maps(), configurations(), st.sampled_from(OBJECTIVES))
def test_no_other_route_is_cheaper(corridors: CorridorMap, numbers: tuple[int, ...], objective: Objective) -> None:
    options = fewer(options_on(corridors, KB), numbers)
    found = CoAdaptivePlanner(corridors, options, START_UP).route(
        corridors.places[0].name, corridors.places[-1].name, objective
    )
    best = min((objective.values(costs) for costs in all_routes(corridors, options)), default=None)
    if best is None:
        assert found is None
    else:
        assert found is not None
        assert objective.values(found.costs) == pytest.approx(best, abs=1e-3)
        check_that_it_can_be_driven(corridors, options, found)


@settings(max_examples=60, deadline=None)
@given(small_maps(), configurations(), st.permutations(list(Criterion)))
def test_in_an_order_of_criteria_the_later_decide_only_ties(
    corridors: CorridorMap, numbers: tuple[int, ...], order: list[Criterion]
) -> None:
    options = fewer(options_on(corridors, KB), numbers)
    objective = Objective.in_order(order)
    found = CoAdaptivePlanner(corridors, options, START_UP).route(
        corridors.places[0].name, corridors.places[-1].name, objective
    )
    several = [objective.values(costs) for costs in all_routes(corridors, options)]
    best = min((tuple(round(value, 5) for value in values) for values in several), default=None)
    assert (found is None) == (best is None)
    if found is not None:
        assert objective.values(found.costs) == pytest.approx(best, abs=1e-3)


@settings(max_examples=60, deadline=None)
@given(small_maps(), configurations())
def test_pareto_routes_are_all_that_nothing_betters(corridors: CorridorMap, numbers: tuple[int, ...]) -> None:
    options = fewer(options_on(corridors, KB), numbers)
    start, goal = corridors.places[0].name, corridors.places[-1].name
    found = CoAdaptivePlanner(corridors, options, START_UP).pareto(start, goal)
    for one in found:
        check_that_it_can_be_driven(corridors, options, one)
    several = {rounded(costs) for costs in all_routes(corridors, options)}
    front = {one for one in several if not any(other != one and dominates(other, one) for other in several)}
    assert {rounded(one.costs) for one in found} == front
    assert len(found) == len(front)


def rounded(costs: Costs) -> tuple[float, float, float]:
    return (round(costs.energy, 4), round(costs.time, 4), round(costs.risk, 4))


def dominates(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return all(a <= b for a, b in zip(one, other, strict=True))


def check_that_it_can_be_driven(corridors: CorridorMap, options: DriveOptions, found: Route) -> None:
    """The legs hang together, each is allowed, and their costs are what driving them costs."""
    way = [(corridors.corridor(leg.corridor), leg.start) for leg in found.legs]
    assert way[0][1] == corridors.places[0].name
    assert found.legs[-1].end == found.goal
    for one, other in pairwise(found.legs):
        assert one.end == other.start
    for leg in found.legs:
        corridor = corridors.corridor(leg.corridor)
        assert leg.start in corridor.origins()
        assert leg.end == corridor.other_end(leg.start)
        assert usable(corridor, options, options.configurations.index(leg.configuration))
    assert found.costs == total(way, tuple(leg.configuration for leg in found.legs))


KB = agv_kb()


@pytest.mark.parametrize("objective", OBJECTIVES, ids=str)
@pytest.mark.parametrize("seed", range(4))
def test_on_larger_maps_networkx_finds_nothing_cheaper(seed: int, objective: Objective) -> None:
    """All configurations, on a graph in which every place is there once for each of them."""
    corridors = grid_map(7, 6, seed)
    options = options_on(corridors, KB)
    several = options.configurations
    graph = nx.DiGraph()
    for number, one in enumerate(several):
        ready = START_UP.costs(frozenset(), one.components)
        graph.add_edge("start", ("p0_0", number), weight=objective.values(ready)[0])
        graph.add_edge(("p6_5", number), "goal", weight=0.0)
        for place, (to, other) in product(corridors.places, enumerate(several)):
            change = START_UP.costs(one.components, other.components)
            graph.add_edge((place.name, number), (place.name, to), weight=objective.values(change)[0])
    for corridor, (number, one) in product(corridors.corridors, enumerate(several)):
        for origin in corridor.origins() if usable(corridor, options, number) else ():
            costs = drive_costs(corridor, origin, one)
            assert costs is not None
            graph.add_edge((origin, number), (corridor.other_end(origin), number), weight=objective.values(costs)[0])
    found = CoAdaptivePlanner(corridors, options, START_UP).route("p0_0", "p6_5", objective)
    assert found is not None
    best = nx.dijkstra_path_length(graph, "start", "goal")
    assert objective.values(found.costs)[0] == pytest.approx(best, abs=1e-3)


def test_the_same_question_has_the_same_answer() -> None:
    corridors = grid_map(6, 6, 3)
    first, second = (planner(corridors).route("p0_0", "p5_5", TIME) for _ in range(2))
    assert first == second


def test_a_pareto_search_that_gets_out_of_hand_says_so() -> None:
    with pytest.raises(TooManyRoutesError, match="more than 5 partial routes"):
        planner(grid_map(6, 6, 1)).pareto("p0_0", "p5_5", most=5)


# measured corridors


def test_a_measured_corridor_costs_what_was_measured_and_is_driven_only_as_measured() -> None:
    parts = frozenset({"kinect", "lidar", "camera", "amcl", "mrpt", "aruco", "lamp"})
    lidar, kinect = frozenset({"lidar", "mrpt"}), frozenset({"kinect", "amcl"})
    measured = MeasuredDrives({(lidar, None): Drive(9.0, 0.5), (kinect, 0.35): Drive(12.0, 0.0)}, parts)
    corridors = CorridorMap(
        (Place("A", 0, 0), Place("B", 20, 0)), (Corridor("C1", "A", "B", 20.0, measured={"A": measured}),)
    )
    fastest, safest = route(corridors, TIME).legs[0], route(corridors, RISK).legs[0]
    assert fastest.configuration.designs[0] == "lidar + mrpt"
    assert fastest.costs.time == pytest.approx(9.0 + 3 * START_UP.time)
    assert fastest.costs.risk == 0.5
    assert safest.configuration.name == "kinect + amcl, normal speed"
    back = planner(corridors).route("B", "A", TIME)
    assert back is not None
    assert back.legs[0].costs.time == pytest.approx(20.0 / 0.68 + 3 * START_UP.time), "nothing was measured that way"


# objectives


@pytest.mark.parametrize("weights", [{}, {"energy": 0.0}, {"energy": -1.0}, {"energy": math.nan}, {"energie": 1.0}])
def test_objectives_that_make_no_sense_are_refused(weights: dict[str, float]) -> None:
    with pytest.raises(InvalidValueError):
        Objective.weighted(weights)


def test_objectives_say_what_they_are() -> None:
    assert str(Objective.weighted({"energy": 1.0, "risk": 20.0})) == "energy + 20 * risk"
    assert str(Objective.first("time")) == "time, then energy, then risk"
    with pytest.raises(InvalidValueError, match="needs a criterion"):
        Objective.in_order(())
