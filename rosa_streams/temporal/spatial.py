"""Spatial atoms through shapely (extra ``spatial``): inside, distance, and the relations of RCC-8.

RCC-8 (Randell, Cui, Cohn 1992) between regions: disconnected, externally connected, partially overlapping, equal,
tangential and non-tangential proper part, and the inverses of these two.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from rosa_core.errors import Problem
from rosa_streams.errors import FormulaError, StreamError
from rosa_streams.temporal.formula import Distance, Spatial

if TYPE_CHECKING:
    from rosa_streams.temporal.state import Evaluator, State


def geometry(value: Any) -> Any:
    """A geometry of shapely from what a sample or a file may hold.

    Args:
        value: a geometry, a point as two numbers, a polygon as a list of at least three points, or a text in WKT such
            as ``POINT (1 2)``.

    Raises:
        StreamError: if it is none of these, or shapely is missing.
    """
    shapely = _shapely()
    if isinstance(value, shapely.Geometry):
        return value
    try:
        if isinstance(value, str):
            return shapely.from_wkt(value)
        if len(value) == 2 and not hasattr(value[0], "__len__"):
            return shapely.Point(float(value[0]), float(value[1]))
        polygon = shapely.Polygon([(float(x), float(y)) for x, y in value])
    except (shapely.errors.ShapelyError, TypeError, ValueError):
        hint = "write two numbers, a list of at least three points, or WKT such as 'POINT (1 2)'"
        raise StreamError(Problem(f"{str(value)[:80]!r} is no point or region", hint=hint)) from None
    if not polygon.is_valid:
        raise StreamError(Problem(f"the region {str(value)[:80]} crosses itself", hint="give its corners in order"))
    return polygon


def spatial_evaluator(atom: Spatial, regions: Mapping[str, Any]) -> Evaluator:
    """What evaluates a spatial atom at a state."""
    holds = _RELATIONS[atom.relation]
    first, second = _side(atom.first.name, regions), _side(atom.second.name, regions)

    def evaluate(state: State) -> bool | None:
        one, other = first(state), second(state)
        return None if one is None or other is None else bool(holds(one, other))

    return evaluate


def distance_evaluator(term: Distance, regions: Mapping[str, Any]) -> Callable[[State], float | None]:
    """What computes a distance at a state."""
    first, second = _side(term.first.name, regions), _side(term.second.name, regions)

    def evaluate(state: State) -> float | None:
        one, other = first(state), second(state)
        return None if one is None or other is None else float(one.distance(other))

    return evaluate


def _side(name: str, regions: Mapping[str, Any]) -> Callable[[State], Any]:
    if name in regions:
        region = geometry(regions[name])
        return lambda _: region

    def value(state: State) -> Any:
        found = state.get(name)
        if found is None or found == "":
            return None
        try:
            return geometry(found)
        except StreamError as error:
            raise FormulaError(f"'{name}' stands for a point or region: {error}") from None

    _shapely()
    return value


def _shapely() -> Any:
    try:
        import shapely
    except ImportError:
        hint = "pip install 'rosa-coadaptation[spatial]'"
        raise StreamError(Problem("spatial relations need shapely", hint=hint)) from None
    return shapely


def _connected(first: Any, second: Any) -> bool:
    return bool(first.intersects(second))


def _interiors_meet(first: Any, second: Any) -> bool:
    return bool(first.relate_pattern(second, "T********"))


def _proper_part(first: Any, second: Any) -> bool:
    return bool(second.covers(first) and not first.equals(second))


def _tangential(first: Any, second: Any) -> bool:
    return bool(first.boundary.intersects(second.boundary))


_RELATIONS: dict[str, Callable[[Any, Any], bool]] = {
    "inside": lambda first, second: bool(second.covers(first)),
    "DC": lambda first, second: not _connected(first, second),
    "EC": lambda first, second: _connected(first, second) and not _interiors_meet(first, second),
    "EQ": lambda first, second: bool(first.equals(second)),
    "PO": lambda first, second: (
        _interiors_meet(first, second) and not first.covers(second) and not second.covers(first)
    ),
    "TPP": lambda first, second: _proper_part(first, second) and _tangential(first, second),
    "NTPP": lambda first, second: _proper_part(first, second) and not _tangential(first, second),
    "TPPi": lambda first, second: _proper_part(second, first) and _tangential(first, second),
    "NTPPi": lambda first, second: _proper_part(second, first) and not _tangential(first, second),
}
