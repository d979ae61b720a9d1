"""The algebra of sets of causes: all of several conditions, one of several conditions, by their minimal sets.

A condition is known by its minimal sets: it holds where all causes of one of them do, and none of them can do without
a cause or with a wider region. (Minimal cut sets of a fault tree; prime implicants whose literals are failures and
intervals.) Order is the number of causes of a set. Neither operation makes a set of fewer causes than those it is made
of, so that what is left out beyond an order is missed by nothing up to it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from itertools import combinations, product

from rosa_verification.causes import Cause, CauseSet, Region

Sets = frozenset[CauseSet]

ALWAYS: Sets = frozenset({frozenset()})
NEVER: Sets = frozenset()


class TooManySetsError(Exception):
    """There are more minimal sets than are to be listed."""


def both(one: CauseSet, other: CauseSet) -> CauseSet | None:
    """The causes of two sets together; None if they cannot be: a measure has one value."""
    together = one | other
    regions = [cause for cause in together if isinstance(cause, Region)]
    if len(regions) < 2:
        return together
    merged: dict[str, Region] = {}
    for region in regions:
        known = merged.get(region.measure, region)
        shared = Region(region.measure, max(known.low, region.low), min(known.high, region.high))
        if shared.low >= shared.high:
            return None
        merged[region.measure] = shared
    if len(merged) == len(regions):
        return together
    return frozenset(cause for cause in together if not isinstance(cause, Region)) | frozenset(merged.values())


def implies(strong: CauseSet, weak: CauseSet) -> bool:
    """Whether wherever all causes of one set hold those of the other do."""
    return all(
        cause in strong
        or (isinstance(cause, Region) and any(isinstance(c, Region) and _within(c, cause) for c in strong))
        for cause in weak
    )


def minimal(sets: Collection[CauseSet]) -> Sets:
    """Those of the sets that imply no other."""
    present = frozenset(sets)
    if len(present) < 2:
        return present
    if frozenset() in present:
        return ALWAYS
    regions: dict[str, set[Region]] = {}
    for cause in {cause for one in present for cause in one}:
        if isinstance(cause, Region):
            regions.setdefault(cause.measure, set()).add(cause)
    by_size: dict[int, list[tuple[CauseSet, CauseSet]]] = {}
    for one in present:
        failures = frozenset(cause for cause in one if not isinstance(cause, Region))
        by_size.setdefault(len(one), []).append((failures, one))
    return frozenset(one for one in present if not _implies_another(one, present, by_size, regions))


def all_of(conditions: Iterable[Sets], order: int | None, limit: int) -> Sets:
    """The minimal sets with which every condition holds.

    Args:
        conditions: each by its minimal sets.
        order: sets of more causes are left out; None keeps all.
        limit: the most sets that are worked with.

    Raises:
        TooManySetsError: if there are more.
    """
    families = sorted((one for one in dict.fromkeys(conditions) if one != ALWAYS), key=len)
    if not families:
        return ALWAYS
    if not families[0]:
        return NEVER
    common = frozenset.intersection(*(frozenset(one for one in family if len(one) == 1) for family in families))
    if common:
        # What alone brings all about makes sets that contain it superfluous: without these there is less to combine.
        alone = frozenset(cause for one in common for cause in one)
        rest = all_of((frozenset(one for one in f if not one & alone) for f in families), order, limit)
        return minimal(common | rest)
    if order is not None and _least_order(families) > order:
        return NEVER
    result: Sets = ALWAYS
    for family in families:
        result = _combined(result, family, order, limit)
    return result


def any_of(conditions: Iterable[Sets], order: int | None, limit: int, *, measured: bool = False) -> Sets:
    """The minimal sets with which one of the conditions holds.

    Args:
        conditions: each by its minimal sets.
        order: sets of more causes are left out; None keeps all.
        limit: the most sets that are worked with.
        measured: every measure has a value, so that a region of all values says nothing.

    Raises:
        TooManySetsError: if there are more.
    """
    result = minimal(frozenset().union(*conditions))
    _check(result, limit)
    while True:
        wider = frozenset(one for one in _consensus(result, measured) if order is None or len(one) <= order)
        _check(wider, 10 * limit)
        new = minimal(result | wider)
        _check(new, limit)
        if new == result:
            return result
        result = new


def _combined(result: Sets, family: Sets, order: int | None, limit: int) -> Sets:
    made: set[CauseSet] = set()
    for one in result:
        if any(implies(one, other) for other in family):
            made.add(one)
            continue
        for other in family:
            together = both(one, other)
            if together is not None and (order is None or len(together) <= order):
                made.add(together)
        _check(made, 10 * limit)
    combined = minimal(made)
    _check(combined, limit)
    return combined


def _check(sets: Collection[CauseSet], limit: int) -> None:
    if len(sets) > limit:
        raise TooManySetsError


def _least_order(families: Iterable[Sets]) -> int:
    """At least so many causes are in a set with which every condition holds: those with nothing in common add up."""
    used: set[str] = set()
    total = 0
    for family in families:
        names = {cause.measure if isinstance(cause, Region) else f"failed {cause}" for one in family for cause in one}
        if used.isdisjoint(names):
            used |= names
            total += min(len(one) for one in family)
    return total


def _within(one: Region, other: Region) -> bool:
    return one.measure == other.measure and other.contains(one)


def _implies_another(
    one: CauseSet, present: Sets, by_size: dict[int, list[tuple[CauseSet, CauseSet]]], regions: dict[str, set[Region]]
) -> bool:
    weaker: list[tuple[Cause | None, ...]] = []
    ways = 1
    for cause in one:
        wider: tuple[Cause | None, ...] = (cause,)
        if isinstance(cause, Region):
            wider = tuple(region for region in regions[cause.measure] if region.contains(cause))
        weaker.append((*wider, None))
        ways *= len(wider) + 1
    if ways <= 2 * len(present):
        if ways == 1 << len(one):
            return any(frozenset(part) in present for size in range(1, len(one)) for part in combinations(one, size))
        combined = (frozenset(c for c in choice if c is not None) for choice in product(*weaker))
        return any(other != one and other in present for other in combined)
    return any(
        failures <= one and other != one and implies(one, other)  # failures alone are compared much faster
        for size, others in by_size.items()
        if size <= len(one)
        for failures, other in others
    )


def _consensus(sets: Sets, measured: bool) -> Iterator[CauseSet]:
    """For two sets with neighbouring regions of a measure: what else they ask for, with both regions as one."""
    with_region: dict[str, list[tuple[Region, CauseSet]]] = {}
    for one in sets:
        for cause in one:
            if isinstance(cause, Region):
                with_region.setdefault(cause.measure, []).append((cause, one))
    for pairs in with_region.values():
        if len({region.low for region, _ in pairs}) == 1 or len({region.high for region, _ in pairs}) == 1:
            continue
        for (region, one), (other_region, other) in combinations(pairs, 2):
            if region.contains(other_region) or other_region.contains(region):
                continue
            if region.low > other_region.high or other_region.low > region.high:
                continue
            rest = both(one - {region}, other - {other_region})
            if rest is not None:
                low, high = min(region.low, other_region.low), max(region.high, other_region.high)
                union = Region(region.measure, low, high)
                yield rest if measured and union.is_whole else rest | {union}
