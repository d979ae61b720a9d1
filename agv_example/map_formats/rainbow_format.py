"""The maps of the CMU BRASS exemplar (Camara, Schmerl and Garlan, SEAMS 2020; Rainbow), in JSON, read unchanged.

``map`` lists places with ``node-id``, ``coords`` (m) and ``connected-to``. ``time`` and ``hitrate`` list corridors by
``from`` and ``to`` with an entry for each configuration that was tried, such as ``amcl-kinect`` (at any speed),
``mrpt-lidar-35`` (at 0.35 m/s) or ``aruco-camera-headlamp-68``: ``mean`` seconds, ``hitrate`` per drive. ``obstacles``
names corridors with obstacles. Of what else there is, ``min_illuminance`` tells how dark a corridor gets (``mean``, 0
to 255; what lies outside was not measured).

- A corridor is listed in one direction or in both; a direction that is not listed is as the other one.
- A configuration without an entry was not tried, and is not used in that corridor. In a corridor that is not listed at
  all, time follows from the length.
- A place may be connected to nothing: it is on the map, and there is no way to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Drive, Place, Survey, distance
from agv_example.map_formats.checked import Checked

_COMPONENTS = {
    "amcl": "amcl",
    "mrpt": "mrpt",
    "aruco": "aruco",
    "lidar": "lidar",
    "kinect": "kinect",
    "camera": "camera",
    "headlamp": "lamp",
}
PARTS = frozenset(_COMPONENTS.values())
_BRIGHTEST = 255.0
_Way = tuple[str, str]
_Configuration = tuple[frozenset[str], float | None]


def is_rainbow_map(data: Checked) -> bool:
    """Whether it looks like one."""
    return isinstance(data.value, Mapping) and isinstance(data.value.get("map"), list)


def read_rainbow_map(data: Checked) -> CorridorMap | None:
    """The map; None if something is wrong, which ``data`` then has complained of."""
    places: dict[str, Place] = {}
    connected: dict[_Way, Checked] = {}
    for entry in data["map"].entries():
        name = entry["node-id"].text()
        if name in places:
            entry.complain(f"place '{name}' is there twice", "remove one")
        places[name] = Place(name, entry["coords"]["x"].number(), entry["coords"]["y"].number())
        for neighbour in entry["connected-to"].entries():
            connected[name, neighbour.text()] = neighbour
    corridors = []
    for (one, other), connection in connected.items():
        if other not in places:
            connection.complain(f"'{one}' is connected to '{other}', which is no place")
        elif (other, one) not in connected or one < other:
            one_way = (other, one) not in connected
            length = distance(places[one], places[other])
            corridors.append(Corridor(f"{one}-{other}", one, other, max(length, 1e-3), one_way=one_way))
    times, hits = _listed(data["time"], "mean", 0.0), _listed(data["hitrate"], "hitrate", 0.0)
    obstacles = [(entry["from"].text(), entry["to"].text()) for entry in data["obstacles"].entries()]
    lights = {way: entry["mean"].number(-1.0) for way, entry in _ways(data["min_illuminance"])}
    if data.problems:
        return None
    surveyed = [
        replace(
            corridor,
            obstacles=sum(obstacles.count(way) for way in _both(corridor)),
            light=_light(corridor, lights),
            surveys=_surveys(corridor, times, hits),
        )
        for corridor in corridors
    ]
    return CorridorMap(tuple(places.values()), tuple(surveyed), "BRASS map")


def _ways(data: Checked) -> Iterator[tuple[_Way, Checked]]:
    for entry in data.entries():
        yield (entry["from"].text(), entry["to"].text()), entry


def _listed(data: Checked, figure: str, least: float) -> dict[_Way, dict[_Configuration, float]]:
    """By way and configuration, what was measured; entries that do not name a configuration are passed over."""
    found: dict[_Way, dict[_Configuration, float]] = {}
    for way, entry in _ways(data):
        measured = found.setdefault(way, {})
        for key, value in entry.items():
            configuration = _configuration(key)
            if configuration is not None:
                measured[configuration] = value[figure].number(least=least)
    return found


def _configuration(key: str) -> _Configuration | None:
    """What a key such as ``aruco-camera-headlamp-35`` stands for; None if it is no configuration."""
    words = key.split("-")
    speed = None
    if words[-1].isdecimal() and len(words[-1]) < 4:
        speed = int(words.pop()) / 100
    if not words or any(word not in _COMPONENTS for word in words):
        return None
    components = {_COMPONENTS[word] for word in words}
    if "aruco" in components:
        components.add("camera")
    return frozenset(components), speed


def _both(corridor: Corridor) -> tuple[_Way, _Way]:
    return (corridor.start, corridor.end), (corridor.end, corridor.start)


def _surveys(
    corridor: Corridor,
    times: Mapping[_Way, Mapping[_Configuration, float]],
    hits: Mapping[_Way, Mapping[_Configuration, float]],
) -> dict[str, Survey]:
    there, back = _both(corridor)
    surveys: dict[str, Survey] = {}
    for way, other in ((there, back), (back, there)):
        time = times.get(way) or times.get(other)
        if time:
            hit = hits.get(way) or hits.get(other)
            tried = {one: seconds for one, seconds in time.items() if seconds > 0.0 and (not hit or one in hit)}
            drives = {one: Drive(seconds, hit[one] if hit else 0.0) for one, seconds in tried.items()}
            surveys[way[0]] = Survey(drives, PARTS)
    return surveys


def _light(corridor: Corridor, lights: Mapping[_Way, float]) -> float:
    known = [lights[way] for way in _both(corridor) if 0.0 <= lights.get(way, -1.0) <= _BRIGHTEST]
    return min(known) / _BRIGHTEST if known else FULL_LIGHT
