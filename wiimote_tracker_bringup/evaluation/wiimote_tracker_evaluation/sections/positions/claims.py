"""Statements of the paper about its ten points, compared with simulated sessions.

Each statement is about a few sessions. It is compared with the results of as many simulated
sessions, drawn repeatedly: the paper agrees if its number is in their middle 95 %.
"""

import dataclasses
from typing import Callable, Sequence

import numpy as np

from wiimote_tracker_bringup import alignment, statistics
from wiimote_tracker_evaluation.sections.positions.results import FOUR, TWO
from wiimote_tracker_evaluation.sessions import by_session

DRAWS = 4000
PER_CASE = 2  # sessions of the paper


@dataclasses.dataclass(eq=False)
class Claim:
    """text: the statement. cameras, cases: of its points. extreme: np.max or np.min over all points
    of all its sessions. said [m], and the unit of its last digit [m]."""

    text: str
    cameras: str
    cases: Sequence[str]
    extreme: Callable
    said: float
    digit: float

    def simulated(self, results, ray_model, seed):
        """Lower end, median and upper end of the middle 95 % for this number of sessions [m]."""
        random = np.random.RandomState(seed)
        values = []
        for case in self.cases:
            errors = self.extreme(results.group(self.cameras, case, ray_model).from_nominal(),
                                  axis=1)
            values.append(errors[random.randint(0, len(errors), (DRAWS, PER_CASE))])
        drawn = self.extreme(np.concatenate(values, axis=1), axis=1)
        return np.percentile(drawn, [2.5, 50.0, 97.5])


CLAIMS = (
    Claim('two, C1 and C2: least error', TWO, ('C1', 'C2'), np.min, 0.15, 0.01),
    Claim('two, C1 and C2: largest error', TWO, ('C1', 'C2'), np.max, 0.50, 0.01),
    Claim('two, C3 to C5: largest error', TWO, ('C3', 'C4', 'C5'), np.max, 0.07, 0.01),
    Claim('four, C3: largest error', FOUR, ('C3',), np.max, 0.028, 0.001),
    Claim('four, C4: largest error', FOUR, ('C4',), np.max, 0.085, 0.001),
    Claim('four, C5: largest error', FOUR, ('C5',), np.max, 0.048, 0.001),
)


def verdict(claim, simulated):
    """In words; a rounded number may be half a digit off."""
    low, _, high = simulated
    if claim.said + 0.5 * claim.digit < low:
        return 'no: ours is larger'
    if claim.said - 0.5 * claim.digit > high:
        return 'no: ours is smaller'
    return 'yes'


def form_of_cube(results, ray_model):
    """Distances of the corners of the cube measured by C2 with two cameras from the ideal one, and
    the residuals of a rigid alignment: sessions x 8 each [m]."""
    group = results.group(TWO, 'C2', ray_model)
    off, left = [], []
    for measured, nominal in zip(group.measured[:, :8], group.nominal[:, :8]):
        if np.isnan(measured).any():
            continue
        off.append(np.linalg.norm(measured - nominal, axis=1))
        aligned = alignment.fit(measured, nominal, with_scale=False).apply(measured)
        left.append(np.linalg.norm(aligned - nominal, axis=1))
    return np.array(off), np.array(left)


def worst_is_fourth_corner(results, ray_model):
    """Number of sessions with two cameras whose largest error of C4 is on the edge of the cube near
    the missing fourth camera (its points 4 and 8), and number of all sessions."""
    worst = np.argmax(results.group(TWO, 'C4', ray_model).from_nominal(), axis=1)
    return int(np.isin(worst, [3, 7]).sum()), len(worst)


def farthest_principal_point(results, ray_model):
    """How far 95 % of the corrected principal points are from (512, 384) [px]; interval; number."""
    rows = results.last_round(['C3', 'C4', 'C5'], ray_model)
    off = np.maximum(np.abs(rows['center_u'] - 512.0), np.abs(rows['center_v'] - 384.0))
    return (float(np.quantile(off, 0.95)),
            statistics.bootstrap(by_session(rows, off), statistics.quantile(0.95)), len(off))


def board_error(results):
    """Three standard deviations of a principal point from 12 views of the board [px], like the
    error limits of the paper's toolbox; interval; number."""
    rows = results.last_round(['C2'], 'calibrated')
    error = np.stack([rows['center_u'] - rows['true_u'], rows['center_v'] - rows['true_v']], axis=1)

    def limit(values):
        return 3.0 * statistics.rms(values)
    return limit(error), statistics.bootstrap(by_session(rows, error), limit), error.size
