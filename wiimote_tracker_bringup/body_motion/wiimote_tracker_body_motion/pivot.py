"""The tip of a probe, from its poses while it turns about the tip, which rests in a dimple."""

import dataclasses

import numpy as np
from scipy.optimize import least_squares

from wiimote_tracker_bringup import alignment, rigid_motion
from wiimote_tracker_bringup.errors import Refusal

LEAST_POSES = 30
LARGEST_STDDEV = 0.005  # of a tip that is told [m]
LARGEST_RESIDUAL = 2.0  # RMS, of their standard deviations, of a tip that rests


@dataclasses.dataclass
class Tip:
    """position: in the body's frame [m]; covariance [m^2]; place: in the world [m]; residual: RMS
    distance of the tips of all poses from there [m]."""

    position: np.ndarray
    covariance: np.ndarray
    place: np.ndarray
    residual: float


def solve(positions, rotations, covariances):
    """Tip: R_i tip + p_i = place for all poses, by linear least squares, then weighted.

    The weights depend on the tip: without that, the noise of the rotations would shorten it.
    positions: n x 3 [m]; rotations: n; covariances: n x 6 x 6, of positions and of small rotations
    about the world's axes [m, rad]. Errors of the poses are independent.
    """
    number = len(positions)
    if number < LEAST_POSES:
        raise Refusal(f'{number} poses, {LEAST_POSES} are needed: the cameras must see the '
                      'probe')
    system = np.hstack([rotations.as_matrix().reshape(-1, 3), np.tile(-np.eye(3), (number, 1))])
    start = np.linalg.lstsq(system, -positions.reshape(-1), rcond=None)[0]

    def residuals(unknown):
        points = rotations.apply(unknown[:3]) + positions - unknown[3:]
        factors = np.linalg.cholesky(
            rigid_motion.covariance_of_point(unknown[:3], rotations, covariances))
        return np.linalg.solve(factors, points[..., None]).reshape(-1)

    found = least_squares(residuals, start, x_scale='jac')
    covariance = np.linalg.pinv(found.jac.T @ found.jac)[:3, :3]
    normalised = np.sqrt((found.fun ** 2).sum() / (3.0 * number - 6.0))
    stddev = np.sqrt(np.linalg.eigvalsh(covariance)[-1])
    if normalised > LARGEST_RESIDUAL:
        raise Refusal('the tip did not rest: the poses depart from a pivot by '
                      f'{normalised:.1f} of their standard deviations (RMS)')
    if not stddev < LARGEST_STDDEV:
        raise Refusal(f'the tip is told to {1e3 * stddev:.0f} mm only: tilt the probe '
                      'further, in all directions')
    place = found.x[3:]
    return Tip(found.x[:3], covariance * max(normalised, 1.0) ** 2, place,
               alignment.rms(rotations.apply(found.x[:3]) + positions - place))
