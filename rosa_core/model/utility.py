"""What makes one configuration better than another: weights on estimated measures, and hard limits to them.

A required action may name a *preference* measure (ROSA paper, table 4) or give a whole utility; a preference is the
utility with weight 1 on that measure. More is better: what costs, such as energy, has a negative weight.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rosa_core.errors import InvalidValueError
from rosa_core.model.elements import ConstraintOperator
from rosa_core.model.numbers import finite


@dataclass(frozen=True, slots=True)
class Limit:
    """``measure operator value`` must hold for the estimate of a complete configuration.

    Args:
        measure: its name.
        operator: ``<``, ``<=``, ``>`` or ``>=``; the text will do.
        value: in the measure's unit.

    Raises:
        InvalidValueError: if there is no such operator, or the value is not a finite number.
    """

    measure: str
    operator: ConstraintOperator
    value: float

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "operator", ConstraintOperator(self.operator))
        except ValueError:
            known = " ".join(ConstraintOperator)
            raise InvalidValueError(f"'{self.operator}' in a limit on {self.measure} is not one of: {known}") from None
        object.__setattr__(self, "value", finite(self.value, f"the limit on {self.measure}"))

    def __str__(self) -> str:
        return f"{self.measure} {self.operator} {self.value:g}"

    @classmethod
    def parse(cls, text: str) -> Limit:
        """A limit as written.

        Args:
            text: ``measure operator number``; the operator is ``<``, ``<=``, ``>`` or ``>=``.

        Raises:
            InvalidValueError: if the text is not ``measure operator number``.

        Example:
            >>> Limit.parse("energy <= 3")
            Limit(measure='energy', operator=<ConstraintOperator.LESS_OR_EQUAL: '<='>, value=3.0)
        """
        parts = re.fullmatch(r"\s*(.*?[^<>=\s])\s*(<=|>=|<|>)\s*(\S+)\s*", text)
        try:
            if parts:
                return cls(parts[1], ConstraintOperator(parts[2]), float(parts[3]))
        except ValueError:
            pass
        raise InvalidValueError(f"'{text}' is not a limit; write it as 'energy <= 3'")


@dataclass(frozen=True)
class Utility:
    """How good a configuration is, from its estimated measures: the sum of weight times estimate; more is better.

    Args:
        weights: by measure; a measure that is not named counts nothing.
        limits: what the estimates must satisfy; :class:`Limit`, or tuples of measure, operator and value.

    Raises:
        InvalidValueError: if a weight or limit is not a finite number, or an operator is none of ``< <= > >=``.

    Example:
        >>> str(Utility({"accuracy": 1.0, "energy": -0.5}, (("energy", "<=", 3.0),)))
        'accuracy - 0.5 * energy with energy <= 3'
    """

    weights: Mapping[str, float] = field(default_factory=dict)
    limits: tuple[Limit, ...] = ()

    def __post_init__(self) -> None:
        weights = {measure: finite(weight, f"the weight of {measure}") for measure, weight in self.weights.items()}
        limits = tuple(limit if isinstance(limit, Limit) else _limit(limit) for limit in self.limits)
        object.__setattr__(self, "weights", weights)
        object.__setattr__(self, "limits", limits)

    def __hash__(self) -> int:
        return hash((frozenset(self.weights.items()), self.limits))

    def __str__(self) -> str:
        terms = [measure if weight == 1.0 else f"{weight:g} * {measure}" for measure, weight in self.weights.items()]
        limits = f" with {' and '.join(map(str, self.limits))}" if self.limits else ""
        return (" + ".join(terms).replace("+ -", "- ") or "priorities") + limits

    @classmethod
    def preferring(cls, measure: str) -> Utility:
        """The utility that a preference stands for: as much of the measure as there can be.

        Args:
            measure: its name; it gets the weight 1.
        """
        return cls({measure: 1.0})

    @property
    def measures(self) -> tuple[str, ...]:
        """The measures that it names, each once."""
        return tuple(dict.fromkeys((*self.weights, *(limit.measure for limit in self.limits))))


def _limit(parts: Iterable[object]) -> Limit:
    try:
        measure, operator, value = parts
    except (TypeError, ValueError):
        raise InvalidValueError(f"{parts!r} is not a limit; give measure, operator and value") from None
    return Limit(measure, operator, value)  # type: ignore[arg-type]
