"""Errors of a tracked path against a truth in another frame and by another clock.

The path is aligned on one half of the recording, every other tenth of it, and scored on the other
half, both ways round: in time (offset and rate of the truth's clock) and in space (similarity, or
rigid motion). The truth is of another place on the body than the middle of its lights. If the path
has the body's rotations, this place is fitted, too. Otherwise the alignment takes it up as far as
the body does not turn; the rest counts as an error.
"""

import dataclasses
from typing import Optional

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import alignment, bound, rigid_motion, timeseries
from wiimote_tracker_bringup.errors import Refusal

# Longest time between two samples of the truth to interpolate between [s].
LONGEST_GAP = 0.02
# Fewest points of a half.
LEAST_POINTS = 50
STEP = 0.01  # of the search for the clock's offset [s]
ROUNDS = 10  # of its refinement
# Points farther off than this many medians do not take part in a fit.
OUTLIER = 4.0
# Equal parts of a recording that are fitted and scored in turn.
PARTS = 10
CHI_SQUARED_95 = 7.814727903251178  # of three degrees of freedom


def truth_at(truth, times):
    """Positions n x 3 and velocities n x 3 of the truth; NaN in its gaps."""
    after = timeseries.following(truth.times, times)
    velocities = np.diff(truth.positions, axis=0) / np.diff(truth.times)[:, None]
    known = timeseries.covers(truth.times, times, LONGEST_GAP)[:, None]
    return (np.where(known, timeseries.at(truth.times, truth.positions, times), np.nan),
            np.where(known, velocities[after - 1], np.nan))


def fit_space(points, true, kind):
    """Alignment that leaves out what is far off, and the mask of what it was fitted to."""
    used = np.isfinite(true).all(axis=1)
    for _ in range(ROUNDS):
        if used.sum() < LEAST_POINTS:
            raise Refusal('the truth and the tracked path have too few common times')
        fitted = alignment.fit_kind(kind, points[used], true[used])
        errors = np.linalg.norm(fitted.apply(points) - true, axis=1)
        used = errors < OUTLIER * np.median(errors[used])
    return fitted, used


@dataclasses.dataclass(eq=False)
class Path:
    """What was tracked: times n [s], positions n x 3 [m], covariances n x 3 x 3 [m^2]. If
    rotations, n, body to world, are known: covariances n x 6 x 6 of position and rotation about the
    world's axes [m, rad]."""

    times: np.ndarray
    positions: np.ndarray
    covariances: np.ndarray
    rotations: Optional[Rotation] = None

    def part(self, chosen):
        rotations = None if self.rotations is None else self.rotations[chosen]
        return Path(self.times[chosen], self.positions[chosen], self.covariances[chosen], rotations)

    def of_place(self, place):
        """The path of a place on the body [m]."""
        if self.rotations is None:
            return self
        return Path(self.times, self.positions + self.rotations.apply(place),
                    rigid_motion.covariance_of_point(place, self.rotations, self.covariances))


def fit(path, truth, kind):
    """Clock (from the cameras' time to the truth's), alignment, and the truth's place on the body
    [m], 0 without rotations."""
    times = path.times

    def misfit(clock):
        true, _ = truth_at(truth, clock(times))
        fitted, _ = fit_space(path.positions, true, kind)
        return np.nanmedian(np.linalg.norm(fitted.apply(path.positions) - true, axis=1))
    steps = np.arange(-truth.tolerance, truth.tolerance + STEP, STEP)
    clock = min((np.poly1d([truth.rate, truth.offset + step]) for step in steps), key=misfit)
    middle, place = times.mean(), np.zeros(3)
    for _ in range(ROUNDS):
        true, velocity = truth_at(truth, clock(times))
        points = path.of_place(place).positions
        fitted, used = fit_space(points, true, kind)
        error = (true - fitted.apply(points))[used]
        speed = velocity[used]
        about_middle = fitted.apply(points[used]) - true[used].mean(axis=0)
        columns = [bound.alignment_basis(about_middle, kind),
                   -speed.reshape(-1, 1),
                   -(speed * (times[used] - middle)[:, None]).reshape(-1, 1)]
        if path.rotations is not None:
            columns.append((fitted.scale * fitted.rotation
                            @ path.rotations[used].as_matrix()).reshape(-1, 3))
        step = np.linalg.lstsq(np.concatenate(columns, axis=1), error.reshape(-1), rcond=None)[0]
        shift, rate = step[columns[0].shape[1]:][:2]
        clock = clock + [rate, shift - rate * middle]
        if path.rotations is not None:
            place = place + step[-3:]
    true, _ = truth_at(truth, clock(times))
    return clock, fit_space(path.of_place(place).positions, true, kind)[0], place


def score(path, truth, kind):
    """Figures in mm and 1; times and errors of the scored points [s, m]. The parts of the recording
    are fitted and scored in turn."""
    part = np.arange(len(path.times)) * PARTS // len(path.times) % 2
    times, errors, distances, scales = [], [], [], []
    for turn in (0, 1):
        fitted_to, scored = part == turn, part != turn
        clock, fitted, place = fit(path.part(fitted_to), truth, kind)
        true, _ = truth_at(truth, clock(path.times[scored]))
        known = np.isfinite(true).all(axis=1)
        found, true = path.part(scored).part(known).of_place(place), true[known]
        error = fitted.apply(found.positions) - true
        inside = (error @ fitted.rotation / fitted.scale)[:, :, None]  # in the rig's world
        distances.append((inside * np.linalg.solve(found.covariances, inside)).sum(axis=(1, 2)))
        times.append(found.times)
        errors.append(np.linalg.norm(error, axis=1))
        scales.append(fitted.scale)
    times, errors = np.concatenate(times), np.concatenate(errors)
    distances = np.concatenate(distances)
    figures = {'mean_mm': 1e3 * errors.mean(), 'rms_mm': 1e3 * alignment.rms(errors[:, None]),
               'median_mm': 1e3 * np.median(errors), 'p95_mm': 1e3 * np.percentile(errors, 95),
               'largest_mm': 1e3 * errors.max(), 'coverage_95': np.mean(distances < CHI_SQUARED_95),
               'nees': distances.mean(), 'scale': np.mean(scales)}
    figures = {name: float(value) for name, value in figures.items()}
    return dict(figures, points=len(errors)), times, errors
