"""How likely components are to fail: a YAML file beside the knowledge model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Annotated

from rosa_core.errors import nearest
from rosa_core.formats.checked_file import CheckedFile, Entry, Number, read_yaml_file, within
from rosa_core.model.elements import ElementKind
from rosa_core.model.knowledge_model import KnowledgeModel


@dataclass(frozen=True, slots=True)
class Reliability:
    """How likely components are to have failed, each independently of the others.

    Args:
        probabilities: by component, from 0 to 1; components that are absent never fail.
        rates: by component, failures per second, for those that were stated so.
    """

    probabilities: Mapping[str, float]
    rates: Mapping[str, float]


class _Failure(Entry):
    probability: Annotated[Number, within(0, 1)] | None = None
    rate: Annotated[Number, within(0)] | None = None


class _File(Entry):
    time: Annotated[Number, within(0)] | None = None
    reliability: dict[str, _Failure]


def read_reliability(path: str | PathLike[str], model: KnowledgeModel) -> Reliability:
    """Read how likely the components of a model are to fail.

    The file has a mapping ``reliability``: for each component a ``probability`` of having failed by the end of the
    mission, or a ``rate`` in failures per second. With rates, ``time`` is how long the mission takes in seconds: a
    component fails within it with the probability 1 - exp(-rate * time).

    Args:
        path: the file.
        model: whose components it is about.

    Raises:
        InputError: if it cannot be read, or does not fit the model; with file, line and hint for all that is wrong.
    """
    file = read_yaml_file(
        path, _File, "a reliability file", "it looks like 'reliability: {lidar: {probability: 0.01}}'"
    )
    known = model.names[ElementKind.COMPONENT]
    probabilities: dict[str, float] = {}
    for component, failure in file.content.reliability.items():
        if component not in known:
            file.refuse(f"no component '{component}' in the model", nearest(component, known), "reliability", component)
        elif (probability := _probability(file, component, failure)) is not None:
            probabilities[component] = probability
    file.raise_problems()
    rates = {c: failure.rate for c, failure in file.content.reliability.items() if failure.rate is not None}
    return Reliability(probabilities, rates)


def _probability(file: CheckedFile[_File], component: str, failure: _Failure) -> float | None:
    where = ("reliability", component)
    if (failure.probability is None) == (failure.rate is None):
        file.refuse(f"'{component}' needs either a probability or a rate", "write {probability: 0.01}", *where)
        return None
    if failure.rate is None:
        return failure.probability
    if file.content.time is None:
        file.refuse(f"'{component}' has a rate, and the file has no time", "add 'time: 3600' for an hour", *where)
        return None
    return -math.expm1(-failure.rate * file.content.time)
