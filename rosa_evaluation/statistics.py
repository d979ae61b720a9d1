"""The statistics of a comparison of managing systems: what is estimated, tested and said.

Distributions of search times come in clusters, so nothing here supposes that they are normal: two managers are
compared by the Mann-Whitney U test, as the SUAVE exemplar does, and the size of an effect is the probability that a
run of one is above a run of the other. Intervals of means and effect sizes are bootstrapped, those of medians and
shares exact. The same values give the same numbers, always.

Sources: Mann and Whitney, "On a test of whether one of two random variables is stochastically larger than the other"
(1947); Holm, "A simple sequentially rejective multiple test procedure" (1979); Vargha and Delaney, "A critique and
improvement of the CL common language effect size statistics of McGraw and Wong" (2000); Hodges and Lehmann, "Estimates
of location based on rank tests" (1963); Clopper and Pearson, "The use of confidence or fiducial limits" (1934).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import combinations
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

CONFIDENCE = 0.95
_RESAMPLES = 5000
_SEED = 20250711
"""Of the bootstrap: resampling must not make a report differ from one day to the next."""


@dataclass(frozen=True, slots=True)
class Interval:
    """From ``low`` to ``high``, at a confidence; infinite where the values are too few."""

    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Summary:
    """A sample in numbers, in the unit of its values.

    Attributes:
        n: how many values there are.
        sd: the sample standard deviation (n - 1); None for a single value.
        mean_interval: bootstrapped (bias-corrected and accelerated); the mean itself when all values are the same.
        median_interval: exact, from order statistics; it covers at least what it says.
        normality_p: of the Shapiro-Wilk test, which the exemplar reports; None for less than three or equal values.
    """

    n: int
    mean: float
    sd: float | None
    median: float
    lower_quartile: float
    upper_quartile: float
    lowest: float
    highest: float
    mean_interval: Interval
    median_interval: Interval
    normality_p: float | None


def summarise(values: Sequence[float], confidence: float = CONFIDENCE) -> Summary:
    """A sample in numbers.

    Args:
        values: of shape (n,), in any unit.
        confidence: of the intervals, from 0 to 1.

    Returns:
        mean, median, quartiles, spread and their intervals, in the same unit.

    Raises:
        ValueError: if there are no values, or one is not finite.

    Example:
        >>> summary = summarise([3.0, 1.0, 2.0, 4.0, 10.0])
        >>> summary.n, summary.mean, summary.median, summary.lower_quartile
        (5, 4.0, 3.0, 2.0)
        >>> summary.median_interval
        Interval(low=-inf, high=inf)
    """
    import numpy as np
    from scipy import stats

    sample = _sample(values)
    lower, median, upper = (float(q) for q in np.quantile(sample, (0.25, 0.5, 0.75)))
    constant = bool(np.all(sample == sample[0]))
    return Summary(
        n=len(sample),
        mean=float(np.mean(sample)),
        sd=float(np.std(sample, ddof=1)) if len(sample) > 1 else None,
        median=median,
        lower_quartile=lower,
        upper_quartile=upper,
        lowest=float(sample.min()),
        highest=float(sample.max()),
        mean_interval=_mean_interval(sample, confidence, constant=constant),
        median_interval=_median_interval(sample, confidence),
        normality_p=None if len(sample) < 3 or constant else float(stats.shapiro(sample).pvalue),
    )


def share_interval(successes: int, n: int, confidence: float = CONFIDENCE) -> Interval:
    """The exact (Clopper-Pearson) interval of a share, such as that of missions in which the pipeline was found.

    Args:
        successes: in how many of the cases it was so.
        n: how many cases there were.
        confidence: of the interval, from 0 to 1.

    Returns:
        the interval of the share, within 0 and 1.

    Raises:
        ValueError: unless ``0 <= successes <= n`` and ``n > 0``.

    Example:
        >>> interval = share_interval(9, 10)
        >>> f"{interval.low:.3f} to {interval.high:.3f}"
        '0.555 to 0.997'
    """
    from scipy import stats

    found = stats.binomtest(successes, n).proportion_ci(confidence, method="exact")
    return Interval(float(found.low), float(found.high))


class Magnitude(StrEnum):
    """How large an effect is, by the thresholds of Vargha and Delaney (0.56, 0.64, 0.71)."""

    NEGLIGIBLE = "negligible"
    SMALL = "small"
    MEDIUM = "medium"
    LARGE = "large"


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two samples, compared by the two-sided Mann-Whitney U test.

    Attributes:
        first: name of the one sample.
        second: name of the other.
        u: of the first sample: in how many pairs its value is above, ties counting half.
        p: exact for small samples without ties, else by the normal approximation, corrected for ties and continuity.
        p_corrected: by Holm, for the family of comparisons that it is one of.
        superiority: Vargha and Delaney's A: the probability that a value of ``first`` is above one of ``second``.
        superiority_interval: bootstrapped.
        shift: Hodges and Lehmann's estimate of how far the first is above the second.
    """

    first: str
    second: str
    n_first: int
    n_second: int
    median_first: float
    median_second: float
    u: float
    p: float
    p_corrected: float
    superiority: float
    superiority_interval: Interval
    shift: float

    @property
    def rank_biserial(self) -> float:
        """The rank-biserial correlation, from -1 (all of the first below) to 1 (all above)."""
        return 2.0 * self.superiority - 1.0

    @property
    def magnitude(self) -> Magnitude:
        """How large the effect is."""
        size = max(self.superiority, 1.0 - self.superiority)
        for limit, magnitude in ((0.71, Magnitude.LARGE), (0.64, Magnitude.MEDIUM), (0.56, Magnitude.SMALL)):
            if size >= limit:
                return magnitude
        return Magnitude.NEGLIGIBLE

    def significant(self, level: float = 0.05) -> bool:
        """Whether the corrected p is below the level."""
        return self.p_corrected < level


def compare(
    first: tuple[str, Sequence[float]], second: tuple[str, Sequence[float]], confidence: float = CONFIDENCE
) -> Comparison:
    """Compare two named samples.

    Args:
        first: name and values, of shape (n,).
        second: name and values, of shape (m,), in the same unit.
        confidence: of the effect size's interval, from 0 to 1.

    Returns:
        the comparison; its ``p_corrected`` is ``p``, as for a family of one.

    Raises:
        ValueError: if one has no values, or one value is not finite.

    Example:
        >>> comparison = compare(("a", [1.0, 2.0, 3.0]), ("b", [2.5, 4.0, 5.0]))
        >>> comparison.u, round(comparison.p, 3), round(comparison.superiority, 3), comparison.shift
        (1.0, 0.2, 0.111, -2.0)
    """
    import numpy as np
    from scipy import stats

    a, b = _sample(first[1]), _sample(second[1])
    pairs = len(a) * len(b)
    same = bool(np.all(np.concatenate((a, b)) == a[0]))
    test = None if same else stats.mannwhitneyu(a, b, alternative="two-sided", method="auto")
    u, p = (pairs / 2.0, 1.0) if test is None else (float(test.statistic), float(test.pvalue))
    return Comparison(
        first=first[0],
        second=second[0],
        n_first=len(a),
        n_second=len(b),
        median_first=float(np.median(a)),
        median_second=float(np.median(b)),
        u=u,
        p=p,
        p_corrected=p,
        superiority=u / pairs,
        superiority_interval=_superiority_interval(a, b, confidence),
        shift=float(np.median(np.subtract.outer(a, b))),
    )


def compare_all(samples: Mapping[str, Sequence[float]], confidence: float = CONFIDENCE) -> list[Comparison]:
    """Compare every two of several samples, corrected by Holm for the number of comparisons.

    Args:
        samples: by name, each of shape (n,), all in one unit; those without values are left out.
        confidence: of the effect sizes' intervals, from 0 to 1.

    Returns:
        a comparison for each pair, in the order of the names.

    Raises:
        ValueError: if a value is not finite.

    Example:
        >>> low, high = [1.0, 2.0, 3.0, 4.0], [11.0, 12.0, 13.0, 14.0]
        >>> comparisons = compare_all({"low": low, "high": high, "also low": low, "none": []})
        >>> [(c.first, c.second, round(c.p_corrected, 3)) for c in comparisons]
        [('low', 'high', 0.086), ('low', 'also low', 1.0), ('high', 'also low', 0.086)]
    """
    named = [(name, values) for name, values in samples.items() if len(values)]
    return corrected([compare(a, b, confidence) for a, b in combinations(named, 2)])


def corrected(comparisons: Sequence[Comparison]) -> list[Comparison]:
    """The same comparisons, corrected by Holm as one family.

    Args:
        comparisons: whose ``p`` are corrected together.

    Returns:
        the comparisons in the same order, each with its ``p_corrected``.
    """
    ps = holm([comparison.p for comparison in comparisons])
    return [replace(comparison, p_corrected=p) for comparison, p in zip(comparisons, ps, strict=True)]


def holm(ps: Sequence[float]) -> list[float]:
    """Holm's step-down correction: p-values that can be compared with one level, however many tests there were.

    Args:
        ps: p-values of shape (n,).

    Returns:
        the corrected ones, in the same order.

    Example:
        >>> holm([0.01, 0.04, 0.03])
        [0.03, 0.06, 0.06]
    """
    order = sorted(range(len(ps)), key=lambda index: ps[index])
    adjusted = [0.0] * len(ps)
    reached = 0.0
    for rank, index in enumerate(order):
        reached = max(reached, min(1.0, (len(ps) - rank) * ps[index]))
        adjusted[index] = reached
    return adjusted


def describe_comparison(comparison: Comparison, what: str, unit: str = "", comparisons: int = 1) -> str:
    """What a comparison says, in a sentence or two for a report.

    Args:
        comparison: of two managers.
        what: the measure, such as ``search time``.
        unit: its unit, such as ``s``.
        comparisons: how many there are in its family.

    Returns:
        the sentence; it says which sample is higher only if the corrected p is below 5%.

    Example:
        >>> comparison = compare(("rosa", [1.0, 2.0, 3.0]), ("none", [2.5, 4.0, 5.0]))
        >>> describe_comparison(comparison, "search time", "s").partition("; ")[0]
        'No difference in search time between rosa and none is shown (medians 2 s against 4 s'
    """
    c = comparison
    test = f"Mann-Whitney U = {c.u:g}, n = {c.n_first} and {c.n_second}, p {_p(c.p_corrected)}"
    if comparisons > 1:
        test += f" after Holm's correction for {comparisons} comparisons"
    higher = c.superiority > 0.5
    share = c.superiority if higher else 1.0 - c.superiority
    low, high = c.superiority_interval.low, c.superiority_interval.high
    if not higher:
        low, high = 1.0 - high, 1.0 - low
    word = "higher" if higher else "lower"
    medians = f"{_with(c.median_first, unit)} against {_with(c.median_second, unit)}"
    if not c.significant():
        return f"No difference in {what} between {c.first} and {c.second} is shown (medians {medians}; {test})."
    return (
        f"The {what} of {c.first} is {word} than that of {c.second} (medians {medians}; {test}). "
        f"The effect is {c.magnitude}: of two runs, one of each, that of {c.first} is the {word} in {share:.0%} "
        f"({CONFIDENCE:.0%} interval {low:.0%} to {high:.0%}), typically by {_with(abs(c.shift), unit)}."
    )


def _p(p: float) -> str:
    return "< 0.001" if p < 0.001 else f"= {p:.3f}"


def _with(value: float, unit: str) -> str:
    return f"{value:.3g} {unit}".rstrip() if abs(value) < 100 else f"{value:.0f} {unit}".rstrip()


def _sample(values: Sequence[float]) -> np.ndarray[Any, np.dtype[np.float64]]:
    import numpy as np

    sample = np.asarray(values, dtype=float)
    if sample.ndim != 1 or not len(sample):
        raise ValueError("a sample needs at least one value")
    if not np.all(np.isfinite(sample)):
        raise ValueError("a sample has values that are not finite")
    return sample


def _mean_interval(sample: np.ndarray[Any, Any], confidence: float, *, constant: bool) -> Interval:
    import numpy as np
    from scipy import stats

    if len(sample) < 2:
        return Interval(-math.inf, math.inf)
    if constant:
        return Interval(float(sample[0]), float(sample[0]))
    found = stats.bootstrap(
        (sample,), np.mean, n_resamples=_RESAMPLES, confidence_level=confidence, rng=np.random.default_rng(_SEED)
    ).confidence_interval
    return Interval(float(found.low), float(found.high))


def _median_interval(sample: np.ndarray[Any, Any], confidence: float) -> Interval:
    """Between two order statistics: how many values are below the median is binomial, whatever the distribution."""
    import numpy as np
    from scipy import stats

    n = len(sample)
    # The median is below the k-th smallest value with the probability of fewer than k values below it.
    k = int(stats.binom.ppf((1.0 - confidence) / 2.0, n, 0.5))
    if k == 0:
        return Interval(-math.inf, math.inf)
    ordered = np.sort(sample)
    return Interval(float(ordered[k - 1]), float(ordered[n - k]))


def _superiority_interval(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any], confidence: float) -> Interval:
    """Percentiles of resamples, all of which are ranked at once."""
    import numpy as np

    rng = np.random.default_rng(_SEED)
    drawn = [_superiority(batch_a, batch_b) for batch_a, batch_b in _resamples(a, b, rng)]
    low, high = np.quantile(np.concatenate(drawn), ((1.0 - confidence) / 2.0, (1.0 + confidence) / 2.0))
    return Interval(float(low), float(high))


def _resamples(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any], rng: np.random.Generator) -> Iterator[tuple[Any, Any]]:
    """In batches that take at most some tens of megabytes, however large the samples are."""
    batch = max(1, min(_RESAMPLES, 1_000_000 // (len(a) + len(b))))
    left = _RESAMPLES
    while left:
        size = min(batch, left)
        left -= size
        yield rng.choice(a, (size, len(a))), rng.choice(b, (size, len(b)))


def _superiority(a: Any, b: Any) -> Any:
    """Vargha and Delaney's A of each row of ``a`` over the same row of ``b``, from the sum of ranks."""
    import numpy as np
    from scipy import stats

    n, m = a.shape[1], b.shape[1]
    ranks = stats.rankdata(np.concatenate((a, b), axis=1), axis=1)
    return (ranks[:, :n].sum(axis=1) - n * (n + 1) / 2.0) / (n * m)
