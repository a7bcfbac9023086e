"""Samples at increasing times, two or more, and what they say of other times."""

import numpy as np


def following(times, wanted):
    """For each of the times wanted the index of the sample after it, from 1 to the last."""
    return np.clip(np.searchsorted(times, wanted), 1, len(times) - 1)


def covers(times, wanted, longest_gap):
    """Mask of the times wanted between two samples that are no further apart than longest_gap."""
    after = following(times, wanted)
    return ((times[after - 1] <= wanted) & (wanted <= times[after])
            & (times[after] - times[after - 1] <= longest_gap))


def at(times, values, wanted):
    """m x ...: n x ... values, interpolated linearly; beyond the ends the first or last."""
    columns = np.reshape(values, (len(times), -1)).T
    found = np.stack([np.interp(wanted, times, column) for column in columns], axis=1)
    return found.reshape(-1, *np.shape(values)[1:])


def to_nearest(wanted, times):
    """From each of the times wanted to the nearest sample."""
    after = following(times, wanted)
    return np.minimum(np.abs(wanted - times[after - 1]), np.abs(times[after] - wanted))
