"""Closed-form alignment of two sets of corresponding points (S. Umeyama, PAMI 13(4), 1991)."""

import dataclasses

import numpy as np

from wiimote_tracker_bringup.errors import Refusal


@dataclasses.dataclass(eq=False)
class Alignment:
    """p -> scale * rotation @ p + translation."""

    rotation: np.ndarray
    translation: np.ndarray
    scale: float

    def apply(self, points: np.ndarray) -> np.ndarray:
        return self.scale * np.asarray(points) @ self.rotation.T + self.translation


def fit(source: np.ndarray, target: np.ndarray, with_scale: bool, line: bool = False) -> Alignment:
    """Least-squares alignment: minimises the sum of |aligned source - target|^2.

    source, target: N x 3, three or more points not on one line, else Refusal.
    with_scale: similarity; otherwise rigid (scale 1). Never a reflection.
    line: also of points on one line, where any of the rotations about it is found.
    """
    source = np.asarray(source, dtype=float)
    target = np.asarray(target, dtype=float)
    if source.shape != target.shape or source.ndim != 2 or source.shape[1] != 3:
        raise Refusal('an alignment needs two N x 3 arrays of one size')
    if not (np.isfinite(source).all() and np.isfinite(target).all()):
        raise Refusal('an alignment needs finite points')
    source_mean, target_mean = source.mean(axis=0), target.mean(axis=0)
    a, b = source - source_mean, target - target_mean
    if with_scale and not (a ** 2).sum() > 0.0:
        raise Refusal('all points to align are at one place')
    u, singular, vt = np.linalg.svd(b.T @ a)
    if len(source) < 3 or not line and singular[1] <= 1e-12 * max(singular[0], 1e-300):
        raise Refusal('an alignment needs three points or more that are not on one line')
    signs = np.array([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = u @ np.diag(signs) @ vt
    scale = (singular * signs).sum() / (a ** 2).sum() if with_scale else 1.0
    return Alignment(rotation, target_mean - scale * rotation @ source_mean, scale)


def fit_circle(points: np.ndarray):
    """Centre and radius of the circle through N x 2 points (least squares, algebraic)."""
    matrix = np.column_stack([2.0 * points, np.ones(len(points))])
    a, b, c = np.linalg.lstsq(matrix, (points ** 2).sum(axis=1), rcond=None)[0]
    return np.array([a, b]), float(np.sqrt(c + a * a + b * b))


def rms(difference: np.ndarray) -> float:
    """Root of the mean squared length of N x 3 vectors."""
    return float(np.sqrt((np.asarray(difference) ** 2).sum(axis=1).mean()))


# The three ways of reporting accuracy, by the alignment fitted beforehand.
KINDS = ('absolute', 'rigid', 'similarity')


def fit_kind(kind: str, source: np.ndarray, target: np.ndarray, line: bool = False) -> Alignment:
    """Alignment of one of KINDS; line as in fit."""
    if kind == 'absolute':
        return Alignment(np.eye(3), np.zeros(3), 1.0)
    return fit(source, target, kind == 'similarity', line)
