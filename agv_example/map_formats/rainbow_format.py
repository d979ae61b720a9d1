"""The maps of the CMU BRASS exemplar (Camara, Schmerl and Garlan, SEAMS 2020; Rainbow), in JSON, read unchanged.

``map`` lists places with ``node-id``, ``coords`` (m) and ``connected-to``. ``time`` and ``hitrate`` list corridors by
``from`` and ``to`` with an entry for each configuration that was tried, such as ``amcl-kinect`` (at any speed),
``mrpt-lidar-35`` (at 0.35 m/s) or ``aruco-camera-headlamp-68``: ``mean`` seconds, ``hitrate`` per drive. ``obstacles``
names corridors with obstacles. Of what else there is, ``min_illuminance`` says how dark a corridor gets (``mean``, 0
to 255; what lies outside was not measured).

- A corridor is listed in one direction or in both; a direction that is not listed is as the other one.
- A configuration without an entry was not tried, and is not used in that corridor. In a corridor that is not listed at
  all, time follows from the length.
- A place may be connected to nothing: it is on the map, and there is no way to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from pydantic import BaseModel, ConfigDict, Field

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Drive, MeasuredDrives, Place, distance
from agv_example.map_formats.own_format import Figure, FromZero
from rosa_core import InputError
from rosa_core.formats.checked_file import CheckedFile, Name, value_reader

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


class _Point(BaseModel):
    x: Figure
    y: Figure


class _PlaceEntry(BaseModel):
    name: Name = Field(alias="node-id")
    coords: _Point
    connected: tuple[Name, ...] = Field((), alias="connected-to")


class _CorridorEntry(BaseModel):
    """A direction of a corridor, and whatever else there is: what was measured, by configuration."""

    model_config = ConfigDict(extra="allow")
    start: Name = Field(alias="from")
    end: Name = Field(alias="to")


class _LightEntry(_CorridorEntry):
    mean: Figure = -1.0


class RainbowEntry(BaseModel):
    """A map file of the exemplar; what it has beside this is passed over."""

    places: tuple[_PlaceEntry, ...] = Field(alias="map")
    time: tuple[_CorridorEntry, ...] = ()
    hitrate: tuple[_CorridorEntry, ...] = ()
    obstacles: tuple[_CorridorEntry, ...] = ()
    min_illuminance: tuple[_LightEntry, ...] = ()


def rainbow_map(file: CheckedFile[RainbowEntry]) -> CorridorMap:
    """The map.

    Raises:
        InputError: if what is listed does not go together, or was not measured in numbers.
    """
    entry = file.content
    places: dict[str, Place] = {}
    connected: dict[_Way, tuple[int, int]] = {}
    for index, place in enumerate(entry.places):
        if place.name in places:
            file.refuse(f"place '{place.name}' is there twice", "remove one", "map", index)
        places[place.name] = Place(place.name, place.coords.x, place.coords.y)
        for number, neighbour in enumerate(place.connected):
            connected[place.name, neighbour] = index, number
    corridors = []
    for (one, other), (index, number) in connected.items():
        if other not in places:
            what = f"'{one}' is connected to '{other}', which is no place"
            file.refuse(what, None, "map", index, "connected-to", number)
        elif (other, one) not in connected or one < other:
            one_way = (other, one) not in connected
            length = distance(places[one], places[other])
            corridors.append(Corridor(f"{one}-{other}", one, other, max(length, 1e-3), one_way=one_way))
    times, hits = _measured(file, "time", "mean"), _measured(file, "hitrate", "hitrate")
    file.raise_problems()
    obstacles = [(way.start, way.end) for way in entry.obstacles]
    lights = {(way.start, way.end): way.mean for way in entry.min_illuminance}
    with_measurements = [
        replace(
            corridor,
            obstacles=sum(obstacles.count(way) for way in _both(corridor)),
            light=_light(corridor, lights),
            measured=_measured_drives(corridor, times, hits),
        )
        for corridor in corridors
    ]
    with file.refusing():
        return CorridorMap(tuple(places.values()), tuple(with_measurements), "BRASS map")
    raise InputError(file.problems)


_from_zero = value_reader(FromZero)


def _measured(file: CheckedFile[RainbowEntry], what: str, figure: str) -> dict[_Way, dict[_Configuration, float]]:
    """By way and configuration, what was measured; entries that do not name a configuration are passed over."""
    found: dict[_Way, dict[_Configuration, float]] = {}
    for index, way in enumerate(getattr(file.content, what)):
        measured = found.setdefault((way.start, way.end), {})
        for key, value in way.model_extra.items():
            configuration = _configuration(key)
            if configuration is not None:
                given = value.get(figure) if isinstance(value, dict) else None
                try:
                    measured[configuration] = _from_zero(given)
                except ValueError as error:
                    file.refuse(f"{figure} of {key} is {given!r}", str(error), what, index, key, figure)
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


def _measured_drives(
    corridor: Corridor,
    times: Mapping[_Way, Mapping[_Configuration, float]],
    hits: Mapping[_Way, Mapping[_Configuration, float]],
) -> dict[str, MeasuredDrives]:
    there, back = _both(corridor)
    found: dict[str, MeasuredDrives] = {}
    for way, other in ((there, back), (back, there)):
        time = times.get(way) or times.get(other)
        if time:
            hit = hits.get(way) or hits.get(other)
            tried = {one: seconds for one, seconds in time.items() if seconds > 0.0 and (not hit or one in hit)}
            drives = {one: Drive(seconds, hit[one] if hit else 0.0) for one, seconds in tried.items()}
            found[way[0]] = MeasuredDrives(drives, PARTS)
    return found


def _light(corridor: Corridor, lights: Mapping[_Way, float]) -> float:
    known = [lights[way] for way in _both(corridor) if 0.0 <= lights.get(way, -1.0) <= _BRIGHTEST]
    return min(known) / _BRIGHTEST if known else FULL_LIGHT
