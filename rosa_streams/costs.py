"""What an update costs (definition 8 of the paper): labor once, upkeep over the horizon, both learned on the way."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from rosa_streams.environment import Change, Environment, Transformation, update
from rosa_streams.errors import StreamError


class Costs(Protocol):
    """Estimates for each transformation."""

    def labor(self, transformation: Transformation) -> float:
        """What it costs to start a unit, in processor seconds (or any unit that upkeep shares)."""
        ...

    def upkeep(self, transformation: Transformation) -> float:
        """What it costs to keep a unit running, per second."""
        ...


@dataclass(frozen=True, slots=True)
class DeclaredCosts:
    """What transformations declare of their costs, and the same for all that declare nothing."""

    default_labor: float = 1.0
    default_upkeep: float = 0.0

    def labor(self, transformation: Transformation) -> float:
        """See :class:`Costs`."""
        return self.default_labor if transformation.labor is None else transformation.labor

    def upkeep(self, transformation: Transformation) -> float:
        """See :class:`Costs`."""
        return self.default_upkeep if transformation.upkeep is None else transformation.upkeep


@dataclass(slots=True)
class Estimator:
    """A quantity estimated by its weighted recent history.

    Args:
        first_guess: the estimate before anything is observed.
        weight: of the newest observation, over 0 and at most 1; the older ones share the rest in the same manner.

    >>> estimator = Estimator(first_guess=100.0, weight=0.5)
    >>> [estimator.observe(value) for value in (4.0, 8.0)]
    [4.0, 6.0]
    """

    first_guess: float
    weight: float = 0.3
    _value: float | None = None

    def __post_init__(self) -> None:
        if not 0 < self.weight <= 1:
            raise StreamError(f"the weight of an observation is over 0 and at most 1, not {self.weight}")

    @property
    def value(self) -> float:
        """The estimate."""
        return self.first_guess if self._value is None else self._value

    @property
    def observed(self) -> bool:
        """Whether anything has been observed."""
        return self._value is not None

    def observe(self, value: float) -> float:
        """Take an observation; the first one replaces the guess. Returns the new estimate."""
        self._value = value if self._value is None else self.weight * value + (1 - self.weight) * self._value
        return self._value


@dataclass
class LearnedCosts:
    """Labor and upkeep learned from observation, by transformation (section IV-C).

    A low first guess makes the manager explore: what was never tried looks cheap. A high one makes it exploit what it
    knows. What a transformation declares takes the place of the guess.
    """

    first_labor: float = 1.0
    first_upkeep: float = 0.0
    weight: float = 0.3
    _labor: dict[str, Estimator] = field(default_factory=dict)
    _upkeep: dict[str, Estimator] = field(default_factory=dict)

    def labor(self, transformation: Transformation) -> float:
        """See :class:`Costs`."""
        known = self._labor.get(transformation.tid)
        return known.value if known else _declared(transformation.labor, self.first_labor)

    def upkeep(self, transformation: Transformation) -> float:
        """See :class:`Costs`."""
        known = self._upkeep.get(transformation.tid)
        return known.value if known else _declared(transformation.upkeep, self.first_upkeep)

    def observe_labor(self, transformation: Transformation, seconds: float) -> None:
        """A unit was started with so many processor seconds."""
        guess = _declared(transformation.labor, self.first_labor)
        self._labor.setdefault(transformation.tid, Estimator(guess, self.weight)).observe(seconds)

    def observe_upkeep(self, transformation: Transformation, per_second: Iterable[float]) -> None:
        """Its units took so much each, per second, over the last cycle; their mean is what counts."""
        values = list(per_second)
        if values:
            guess = _declared(transformation.upkeep, self.first_upkeep)
            estimator = self._upkeep.setdefault(transformation.tid, Estimator(guess, self.weight))
            estimator.observe(sum(values) / len(values))

    def table(self) -> Mapping[str, tuple[float | None, float | None]]:
        """What has been learned: labor and upkeep by transformation; None where nothing was observed."""
        names = sorted({*self._labor, *self._upkeep})
        return {
            name: (
                self._labor[name].value if name in self._labor else None,
                self._upkeep[name].value if name in self._upkeep else None,
            )
            for name in names
        }


def _declared(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


@dataclass(frozen=True, slots=True)
class Objective:
    """What a plan minimises: labor + horizon * upkeep - quality_weight * quality of the streams that targets get.

    Attributes:
        horizon: in seconds.
        max_cost: plans whose labor and upkeep come to more are refused (definition 10).
        quality_weight: what a unit of quality is worth; the paper's objective has 0.
    """

    horizon: float = 60.0
    max_cost: float = math.inf
    quality_weight: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.horizon) and self.horizon >= 0):
            raise StreamError(f"a horizon is a number of seconds of at least 0, not {self.horizon}")
        if not self.max_cost >= 0 or not (math.isfinite(self.quality_weight) and self.quality_weight >= 0):
            raise StreamError("MAX_COST and the weight of quality are numbers of at least 0")


def update_cost(environment: Environment, change: Change, costs: Costs, horizon: float) -> float:
    """The estimated cost of an update: labor of the units that are created, upkeep of all that run after it.

    Units that are reconfigured cost no labor (section IV-D: reuse is free). Units whose transformation is gone count
    nothing.
    """
    after = update(environment, change)
    library = {**environment.library(), **after.library()}
    labor = sum(costs.labor(library[unit.tid]) for unit in change.created() if unit.tid in library)
    upkeep = sum(costs.upkeep(library[unit.tid]) for unit in after.units if unit.tid in library)
    return labor + horizon * upkeep
