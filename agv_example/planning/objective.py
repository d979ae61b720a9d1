"""What the best route is to be best in."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from agv_example.planning.costs import Costs, Criterion
from rosa_core import InvalidValueError
from rosa_core.errors import nearest

Weights = tuple[tuple[Criterion, float], ...]


@dataclass(frozen=True, slots=True)
class Objective:
    """Weighted sums of criteria, the first deciding, each later one only among those that tie in all before it.

    Make one with :meth:`cheapest`, :meth:`weighted` or :meth:`in_order`.

    Attributes:
        stages: for each sum its criteria, with weights above 0.

    Example:
        >>> Objective.in_order(["risk", "time"]).values(Costs(energy=10.0, time=2.0, risk=0.5))
        (0.5, 2.0)
    """

    stages: tuple[Weights, ...]

    @classmethod
    def cheapest(cls, criterion: Criterion | str) -> Objective:
        """As little of one criterion as there can be.

        Args:
            criterion: ``energy``, ``time`` or ``risk``.

        Raises:
            InvalidValueError: if there is no such criterion.
        """
        return cls.weighted({criterion: 1.0})

    @classmethod
    def weighted(cls, weights: Mapping[Criterion | str, float]) -> Objective:
        """As little of the weighted sum as there can be.

        Args:
            weights: per unit of the criterion (see :class:`Costs`); those of 0 are left out.

        Raises:
            InvalidValueError: if a criterion is unknown, a weight is negative, or none is above 0.
        """
        known = tuple((_criterion(name), _weight(name, weight)) for name, weight in weights.items())
        if not any(weight > 0.0 for _, weight in known):
            raise InvalidValueError("an objective needs a weight above 0")
        return cls((tuple(pair for pair in known if pair[1] > 0.0),))

    @classmethod
    def in_order(cls, criteria: Iterable[Criterion | str]) -> Objective:
        """As little of the first as there can be, then of the second, and so on.

        Args:
            criteria: of ``energy``, ``time`` and ``risk``; a repeated one counts where it is first.

        Raises:
            InvalidValueError: if a criterion is unknown or there is none.
        """
        order = dict.fromkeys(_criterion(name) for name in criteria)
        if not order:
            raise InvalidValueError("an objective needs a criterion")
        return cls(tuple(((criterion, 1.0),) for criterion in order))

    @classmethod
    def first(cls, criterion: Criterion | str) -> Objective:
        """As little of one criterion as there can be; among routes that tie, of the others in their order.

        Args:
            criterion: ``energy``, ``time`` or ``risk``.

        Raises:
            InvalidValueError: if there is no such criterion.
        """
        return cls.in_order((criterion, *Criterion))

    def values(self, costs: Costs) -> tuple[float, ...]:
        """What the costs come to, stage by stage.

        Args:
            costs: of a leg or a whole route.

        Returns:
            the weighted sum of each stage; compared as tuples, less is better.
        """
        return tuple(sum(weight * getattr(costs, name.value) for name, weight in stage) for stage in self.stages)

    def __str__(self) -> str:
        return ", then ".join(
            " + ".join(name.value if weight == 1.0 else f"{weight:g} * {name.value}" for name, weight in stage)
            for stage in self.stages
        )


def _criterion(name: Criterion | str) -> Criterion:
    try:
        return Criterion(name)
    except ValueError:
        known = [criterion.value for criterion in Criterion]
        hint = nearest(str(name), known) or f"there are: {', '.join(known)}"
        raise InvalidValueError(f"'{name}' is not a criterion ({hint})") from None


def _weight(name: object, weight: object) -> float:
    if isinstance(weight, bool) or not isinstance(weight, int | float) or not 0.0 <= weight < math.inf:
        raise InvalidValueError(f"the weight of {name} is {weight!r}, not a number from 0 up")
    return float(weight)
