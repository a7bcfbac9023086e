"""Figures of a time span: rate, errors against the truth, names, and when all was normal again."""

import collections
import dataclasses
from typing import Dict, List, Optional

import numpy as np

from wiimote_tracker_bringup import timeseries
from wiimote_tracker_evaluation.faults.listener import POSITION, RECEIPT, STAMP, STDDEV

# A point is wrong if it is farther from every LED than both of these.
WRONG = 0.05   # [m]
CLAIMED = 5.0  # its own standard deviations

PIECE = 0.25       # over which normality is judged [s]
MOST_ERROR = 0.02  # of the middle point of a normal piece [m]
MOST_AGE = 0.1     # more than before the fault [s]
LEAST_POINTS = 20.0  # per second and LED, before a fault is caused
LEAST_RATE = 0.5   # share of the rate before
LONGEST_GAP = 0.1  # between two true positions [s]
FASTEST = 2.0      # LED [m/s]
LEAST_SHARE = 0.1  # of the points, which a camera of Figures.cameras has seen


@dataclasses.dataclass(eq=False)
class Figures:
    """rate: points a second and LED. error: median and 95 % [m]. age: median time from the stamp to
    the receipt [s]. wrong: number of wrong points of `number`; worst: largest error of those [m].
    names: of each LED the label that most of its points have. cameras: those that saw more than
    LEAST_SHARE of the points."""

    rate: float
    error: Optional[float]
    error_95: Optional[float]
    age: Optional[float]
    number: int
    wrong: int
    worst: float
    names: Dict[str, str]
    cameras: List[str]


def select(window, chosen):
    return dataclasses.replace(window, points=window.points[chosen], labels=window.labels[chosen],
                               cameras=window.cameras[chosen])


def with_truth(window):
    """The window with the points for which the truth is known: not while the simulation was
    started again, which shows as a gap or as a leap of an LED."""
    stamps, known = window.points[:, STAMP], np.ones(len(window.points), dtype=bool)
    for truth in window.truth.values():
        times = truth[:, 0]
        gaps = np.diff(times)
        steps = np.linalg.norm(np.diff(truth[:, 1:4], axis=0), axis=1)
        continuous = (gaps < LONGEST_GAP) & (steps <= FASTEST * gaps)
        after = np.searchsorted(times, stamps)
        inside = (after > 0) & (after < len(times))
        known &= inside
        known[inside] &= continuous[after[inside] - 1]
    return select(window, known)


def errors(window):
    """For each point the distance to the nearest LED [m], and that LED's index."""
    rows = window.points
    if not len(rows):
        return np.zeros(0), np.zeros(0, dtype=int)
    distances = [
        np.linalg.norm(rows[:, POSITION]
                       - timeseries.at(truth[:, 0], truth[:, 1:4], rows[:, STAMP]), axis=1)
        if len(truth) else np.full(len(rows), np.inf) for truth in window.truth.values()]
    return np.min(distances, axis=0), np.argmin(distances, axis=0)


def figures(window, seconds) -> Figures:
    window = with_truth(window)
    error, led = errors(window)
    leds = list(window.truth)
    wrong = error > np.maximum(WRONG, CLAIMED * window.points[:, STDDEV])
    names = {}
    for index, name in enumerate(leds):
        labels, counts = np.unique(window.labels[led == index], return_counts=True)
        if len(labels):
            names[name] = str(labels[np.argmax(counts)])
    ages = window.points[:, RECEIPT] - window.points[:, STAMP]
    known = len(error) > 0
    return Figures(
        rate=len(error) / max(seconds, 1e-9) / len(leds),
        error=float(np.median(error)) if known else None,
        error_95=float(np.percentile(error, 95)) if known else None,
        age=float(np.median(ages)) if known else None,
        number=len(error), wrong=int(wrong.sum()), worst=float(error[wrong].max(initial=0.0)),
        names=names, cameras=regular_cameras(window))


def regular_cameras(window) -> List[str]:
    together, counts = np.unique(window.cameras, return_counts=True)
    share = collections.Counter()
    for names, count in zip(together, counts):
        share.update({name: count / len(window.cameras) for name in str(names).split()})
    return sorted(name for name in share if share[name] > LEAST_SHARE)


def is_tracked(window, seconds, leds, cameras) -> bool:
    """Whether so many LEDs are tracked, none wrongly, and each of the cameras has seen one."""
    now = figures(window, seconds)
    return (len(now.names) >= leds and now.rate >= LEAST_POINTS and not now.wrong
            and set(' '.join(window.cameras).split()) >= set(cameras))


def is_normal(window, seconds, before) -> bool:
    """Whether rate, age and error are as before, and each LED and each camera is there."""
    now = figures(window, seconds)
    return (now.number > 0 and len(now.names) == len(before.names)
            and set(now.cameras) >= set(before.cameras)
            and now.rate >= LEAST_RATE * before.rate and now.age <= before.age + MOST_AGE
            and now.error <= max(MOST_ERROR, 2.0 * before.error))


def normal_since(window, start, end, before) -> Optional[float]:
    """From when every piece until the end was normal [s since 1970]; None: not at the end."""
    edges = np.arange(end, start + 1e-6, -PIECE)
    since = None
    for last, first in zip(edges[:-1], edges[1:]):
        receipt = window.points[:, RECEIPT]
        inside = (receipt >= first) & (receipt < last)
        if not is_normal(select(window, inside), PIECE, before):
            break
        since = first
    return since
