"""Errors of an estimated trajectory against a true one.

ATE and RPE: J. Sturm, N. Engelhard, F. Endres, W. Burgard and D. Cremers, "A benchmark for the
evaluation of RGB-D SLAM systems", IROS 2012, as the TUM tools and evo compute them, except that the
truth is interpolated at the times of the estimate instead of taken at the nearest time.
"""

import dataclasses

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import alignment, statistics
from wiimote_tracker_bringup.errors import Refusal

STATISTICS = (('rmse', statistics.rms), ('mean', np.mean), ('median', np.median),
              ('p95', statistics.quantile(0.95)), ('max', np.max))


@dataclasses.dataclass
class Comparison:
    """truth, estimate: Poses at the same times, the estimate aligned. errors: names, with units, to
    arrays; scale: of the alignment; rpe_times: of the beginnings of the intervals [s]; left_out:
    which error is missing and why, in words, or empty."""

    truth: object
    estimate: object
    scale: float
    errors: dict
    rpe_times: np.ndarray
    left_out: str = ''

    def figures(self):
        return {'poses': len(self.truth.times), 'scale': self.scale, 'left_out': self.left_out,
                **{name: {statistic: float(of(values)) for statistic, of in STATISTICS}
                   for name, values in self.errors.items()}}


def compare(estimate, truth, kind='rigid', interval=1.0, longest_gap=0.05):
    """kind: of alignment.KINDS. interval: of the RPE [s]. longest_gap: greatest time between two
    true poses to interpolate between [s]."""
    estimate = estimate.chosen(truth.covers(estimate.times, longest_gap))
    if len(estimate.times) < 3:
        raise Refusal('fewer than three estimated poses lie between true poses; check the '
                      'clocks, --offset and --gap')
    truth = truth.at(estimate.times)
    try:
        fitted = alignment.fit_kind(kind, estimate.positions, truth.positions, line=True)
    except Refusal as error:
        raise Refusal(f'{error}; use --alignment absolute') from error
    aligned = dataclasses.replace(estimate, positions=fitted.apply(estimate.positions),
                                  rotations=Rotation.from_matrix(fitted.rotation)
                                  * estimate.rotations)
    first, last = intervals(estimate.times, interval, longest_gap)
    shift, turn = relative_errors(aligned, truth, first, last)
    errors = {'ATE [m]': np.linalg.norm(aligned.positions - truth.positions, axis=1),
              'ATE [deg]': degrees(truth.rotations.inv() * aligned.rotations),
              f'RPE of {interval:g} s [m]': shift, f'RPE of {interval:g} s [deg]': turn}
    left_out = '' if kind == 'absolute' else missing_angle(aligned.positions, truth.positions)
    if left_out:
        del errors['ATE [deg]']  # the others do not depend on the turn about the path
    return Comparison(truth, aligned, fitted.scale, errors, estimate.times[first], left_out)


def missing_angle(aligned, truth):
    """Why the alignment does not tell the turn about the path, in words, or empty: its width is
    less than the errors. n x 3 [m]. Throws Refusal where its length is, too."""
    extents = np.linalg.svd(truth - truth.mean(axis=0), compute_uv=False) / np.sqrt(len(truth))
    error = alignment.rms(aligned - truth)
    if extents[0] < max(error, 1e-6):
        raise Refusal(
            f'the true path is too short to align: its length is {1e3 * extents[0]:.1f} mm, errors '
            f'are {1e3 * error:.1f} mm (RMS); move about, or use --alignment absolute')
    if extents[1] > max(error, 1e-9 * extents[0]):
        return ''
    return (f'ATE [deg] is left out: the width of the true path is {1e3 * extents[1]:.1f} mm, '
            f'errors are {1e3 * error:.1f} mm (RMS), so the turn about the path cannot be told; '
            'move about, or use --alignment absolute')


def intervals(times, interval, tolerance):
    """Indices of all pairs of poses that are this far apart, to the tolerance [s]."""
    ends = times + interval
    last = np.clip(np.searchsorted(times, ends), 1, len(times) - 1)
    last -= ends - times[last - 1] < times[last] - ends
    first = np.flatnonzero((np.abs(times[last] - ends) <= min(tolerance, interval / 2.0))
                           & (ends <= times[-1] + 1e-6))
    if not len(first):
        other = 'smaller' if times[0] + interval > times[-1] else 'larger'
        raise Refusal(f'no two poses are {interval:g} s apart; use a {other} --interval')
    return first, last[first]


def relative_errors(estimate, truth, first, last):
    """Lengths [m] and angles [deg] of (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), P: estimate, Q: truth."""
    moved = [poses.rotations[first].inv().apply(poses.positions[last] - poses.positions[first])
             for poses in (estimate, truth)]
    turned = [poses.rotations[first].inv() * poses.rotations[last] for poses in (estimate, truth)]
    return np.linalg.norm(moved[0] - moved[1], axis=1), degrees(turned[1].inv() * turned[0])


def degrees(rotations):
    return np.degrees(rotations.magnitude())
