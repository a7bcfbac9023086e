"""Confidence intervals (low, high); all are reproducible."""

from typing import Callable, Sequence, Tuple

import numpy as np
from scipy.special import ndtr, stdtrit

CONFIDENCE = 0.95
NORMAL_QUANTILE = 1.959963984540054  # of CONFIDENCE, both sides


def bootstrap(units, statistic=np.mean, seed=1, resamples=1000):
    """Interval of statistic(all values) by resampling whole units (B. Efron, 1979): expanded
    percentile interval (T. Hesterberg, The American Statistician 69, 2015), as wide for few units
    as Student's. For fewer than six it is at most their range, and covers 1 - 2^(1 - units).

    units: one array of values (or of rows) per independent unit, such as a session; values of one
    unit may depend on each other. statistic: of one array to a number. @raise ValueError: fewer
    than two units.
    """
    units = [np.atleast_1d(np.asarray(unit, dtype=float)) for unit in units]
    if len(units) < 2:
        raise ValueError('an interval needs at least two independent units')
    random = np.random.RandomState(seed)
    count = len(units)
    drawn = [statistic(np.concatenate([units[i] for i in random.randint(0, count, count)]))
             for _ in range(resamples)]
    tail = 100.0 * expanded_tail(len(units), 0.5 * (1.0 - CONFIDENCE))
    low, high = np.percentile(drawn, [tail, 100.0 - tail])
    return float(low), float(high)


def expanded_tail(units: int, tail: float) -> float:
    """Share of a bootstrap's draws to omit on either side, so that the interval misses a share
    `tail` there: draws scatter less than the truth by sqrt((units - 1) / units), and their scatter
    is itself uncertain."""
    return float(ndtr(np.sqrt(units / (units - 1.0)) * stdtrit(units - 1.0, tail)))


def wilson(successes: int, trials: int) -> Tuple[float, float]:
    """Of a probability (E. B. Wilson, JASA 22, 1927). @raise ValueError: no trials."""
    if not 0 <= successes <= trials or trials < 1:
        raise ValueError('successes must be between 0 and the number of trials, at least 1')
    z2 = NORMAL_QUANTILE ** 2
    share = successes / trials
    middle = (share + z2 / (2.0 * trials)) / (1.0 + z2 / trials)
    half = NORMAL_QUANTILE / (1.0 + z2 / trials) * np.sqrt(
        share * (1.0 - share) / trials + z2 / (4.0 * trials ** 2))
    return (0.0 if successes == 0 else float(middle - half),
            1.0 if successes == trials else float(middle + half))


def rms(values: Sequence[float]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def quantile(share: float) -> Callable[[Sequence[float]], float]:
    """The statistic for a quantile, for bootstrap()."""
    return lambda values: float(np.quantile(values, share))


def blocks(values, number):
    """Divides a time series into contiguous parts, as units for bootstrap() when neighbours depend
    on each other."""
    return [piece for piece in np.array_split(np.asarray(values, dtype=float), number)
            if len(piece)]
