"""Measures inference at growing sizes, each figure with its ratio to the peers."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.inference.reasoner import Reasoner
from rosa_evaluation.bench.recompute import Recompute
from rosa_evaluation.bench.synthetic import many_small_robots, one_measure_for_all

if TYPE_CHECKING:
    from rosa_evaluation.bench.clingo_peer import ClingoPeer


@dataclass(frozen=True, slots=True)
class Timing:
    """How long something takes, s; the peers' figures are None where they cannot do it or are not installed."""

    what: str
    elements: int
    seconds: float
    recompute_s: float | None = None
    clingo_s: float | None = None

    def ratio(self, peer_s: float | None) -> float | None:
        """How many times as long the peer takes."""
        return None if peer_s is None else peer_s / self.seconds


def measure_inference(sizes: tuple[int, ...], *, with_clingo: bool) -> Iterator[Timing]:
    """The figures, size by size, as they are measured.

    Args:
        sizes: of the models, in elements.
        with_clingo: whether clingo is measured as well.
    """
    for size in sizes:
        yield from _at_size(size, with_clingo=with_clingo)


def clingo_is_installed() -> bool:
    """Whether the extra ``bench`` is there."""
    from importlib.util import find_spec

    return find_spec("clingo") is not None


def _at_size(size: int, *, with_clingo: bool) -> Iterator[Timing]:
    model = many_small_robots(size)
    count = count_elements(model)
    yield Timing("load and infer", count, median_seconds(lambda: _load(size), 3))
    recompute = Recompute(model)
    everything = median_seconds(lambda: recompute.statuses({"m0": 1.5}), 3)
    peer = _clingo(model) if with_clingo else None
    solve = None if peer is None else median_seconds(peer.solve, 3)
    yield Timing("infer everything", count, median_seconds(Reasoner(model).infer_everything, 5), everything, solve)

    kb = KnowledgeBase(model, clock=SimulationClock())
    values = cycle((0.5, 1.5))
    ours = median_seconds(lambda: kb.add_measurement("m0", next(values)), 2000)
    theirs = None if peer is None else median_seconds(lambda: peer.measure("m0", next(values)), 4)
    yield Timing("one measurement, small cone", count, ours, everything, theirs)

    ours = median_seconds(lambda: (kb.request_action("a1"), kb.cancel_action("a1")), 500) / 2
    required = cycle((True, False))
    theirs = None if peer is None else median_seconds(lambda: peer.require("a1", next(required)), 4)
    yield Timing("request or cancel an action", count, ours, everything, theirs)
    yield _wide(size, with_clingo=with_clingo)


def _wide(size: int, *, with_clingo: bool) -> Timing:
    model = one_measure_for_all(max(1, size // 6))
    count = count_elements(model)
    kb = KnowledgeBase(model, clock=SimulationClock(), history_length=1)
    values = cycle((0.5, 1.5))
    recompute = Recompute(model)
    ours = median_seconds(lambda: kb.add_measurement("m", next(values)), 5)
    everything = median_seconds(lambda: recompute.statuses({"m": next(values)}), 3)
    peer = _clingo(model) if with_clingo else None
    theirs = None if peer is None else median_seconds(lambda: peer.measure("m", next(values)), 3)
    return Timing("one measurement, everything changes", count, ours, everything, theirs)


def count_elements(model: KnowledgeModel) -> int:
    """Named elements and constraints."""
    return sum(len(names) for names in model.names.values()) + len(model.constraints)


def _load(size: int) -> KnowledgeBase:
    return KnowledgeBase(many_small_robots(size), clock=SimulationClock())


def _clingo(model: KnowledgeModel) -> ClingoPeer:
    from rosa_evaluation.bench.clingo_peer import ClingoPeer

    return ClingoPeer(model)


def median_seconds(call: Callable[[], object], times: int) -> float:
    """Median seconds of so many calls, after one that is not counted; earlier garbage is collected first.

    Args:
        call: what is measured.
        times: how often, at least once.

    Returns:
        wall-clock seconds of one call.
    """
    gc.collect()
    call()
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        call()
        taken.append(time.perf_counter() - began)
    return statistics.median(taken)
