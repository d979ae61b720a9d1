"""Writes maps in the JSON of the CMU BRASS exemplar, as large as that one is, with its gaps."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

CONFIGURATIONS = [
    f"{pair}-{speed}"
    for pair in ("amcl-kinect", "amcl-lidar", "mrpt-kinect", "mrpt-lidar", "aruco-camera", "aruco-camera-headlamp")
    for speed in (24, 35, 68)
]


def brass_document(columns: int = 8, rows: int = 7, seed: int = 0) -> dict[str, Any]:
    """A grid of places l1, l2, ...; one place more is connected to nothing, and some corridors lack entries."""
    chance = random.Random(seed)
    ways = []
    places: dict[tuple[int, int], dict[str, Any]] = {}
    for y in range(rows):
        for x in range(columns):
            name = f"l{y * columns + x + 1}"
            places[x, y] = {"node-id": name, "coords": {"x": x * 9.0, "y": y * 7.5}, "connected-to": []}
    for (x, y), place in places.items():
        for neighbour in ((x + 1, y), (x, y + 1)):
            if neighbour in places:
                other = places[neighbour]
                place["connected-to"].append(other["node-id"])
                other["connected-to"].append(place["node-id"])
                ways.append({"from": place["node-id"], "to": other["node-id"]})
    lonely = {"node-id": f"l{columns * rows + 1}", "coords": {"x": -5, "y": -5}, "connected-to": []}
    tried = {id(way): [one for one in CONFIGURATIONS if chance.random() > 0.05] for way in ways}
    return {
        "mpr": 18.5,
        "origin": {"x": 56.6, "y": 42.2},
        "map": [*places.values(), lonely],
        "time": [
            {
                **way,
                **{one: {"mean": round(chance.uniform(15, 60), 3), "stdev": 0.4} for one in tried[id(way)]},
                "mean": 3,
            }
            for way in ways[2:]
        ],
        "hitrate": [
            {**way, **{one: {"hitrate": round(chance.choice([0.0, 0.0, 0.1]), 3)} for one in tried[id(way)]}, "prob": 0}
            for way in ways[2:]
        ],
        "successrate": [{**way, "amcl-kinect-68": {"successrate": 1.0}} for way in ways],
        "min_illuminance": [{**way, "mean": chance.choice([-1210.0, 12.0, 255.0]), "stdev": 1.0} for way in ways],
        "max_illuminance": [{**way, "mean": 255.0, "stdev": 0.0} for way in ways],
        "obstacles": [{"id": "o1", "from": "l1", "to": "l2"}],
        "lights": [{"light-id": "light0", "coord": {"x": 0, "y": 0}}],
        "walls": [{"p1": {"x": 0, "y": 0}, "p2": {"x": 1, "y": 0}}],
    }


def write_brass_map(path: Path, **options: int) -> Path:
    """Write one to a file."""
    path.write_text(json.dumps(brass_document(**options), indent=4), encoding="utf-8")
    return path
