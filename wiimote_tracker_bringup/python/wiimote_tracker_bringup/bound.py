"""Least possible errors if the cameras are known from the square only.

Cramér-Rao bound of the calibration: the Fisher information of the corners' pixels and the priors
(corners: accuracy of placing an LED; lenses: their spread) about each camera's pose and lens and
each corner. The error of a point is that of the calibration plus the noise of its own pixels,
propagated to first order through the best triangulation.

Independent of the tracker: separate camera model, numerical derivatives.
"""

import dataclasses

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import rigid_motion, scene as scene_module
from wiimote_tracker_bringup.alignment import KINDS

PER_CAMERA = 11  # rotation vector about the world axes [rad], position [m], fx, fy, cx, cy, k1


@dataclasses.dataclass(eq=False)
class Knowledge:
    """Standard deviations of the priors.

    focal: of the focal length, relative, common to both axes; focal_ratio: of fy / fx, relative;
    center: of the principal point, each axis [px]; k1 [1]; corner: of a corner's position, each
    horizontal axis [m]. 0 means exactly known.
    """

    focal: float = 0.03
    focal_ratio: float = 0.001
    center: float = 15.0
    k1: float = 0.02
    corner: float = 0.005


def moved(camera, change, points):
    """Pixels of the points in a camera whose 11 parameters are changed by `change`."""
    return scene_module.project(camera.parameters + change[6:],
                                Rotation.from_rotvec(change[:3]).as_matrix() @ camera.rotation,
                                camera.position + change[3:6], points)


STEPS = np.array([1e-6] * 3 + [1e-6] * 3 + [1e-3] * 4 + [1e-6])


def derivatives(pixels, steps):
    """N x 2 x k: of N x 2 pixels, a function of k changes."""
    return np.stack([(pixels(change) - pixels(-change)) / (2.0 * step)
                     for change, step in zip(np.diag(steps), steps)], axis=2)


def camera_derivative(camera: scene_module.Camera, point: np.ndarray) -> np.ndarray:
    """2 x 11: of the pixel with respect to the camera's parameters."""
    return derivatives(lambda change: moved(camera, change, point), STEPS)[0]


def point_derivative(camera: scene_module.Camera, point: np.ndarray) -> np.ndarray:
    """2 x 3: of the pixel with respect to the point."""
    return derivatives(lambda change: camera.project(point + change), [1e-6] * 3)[0]


def seen_derivatives(scene, point):
    """Of the pixels of the cameras that see the point: 2 m x 3 with respect to it, 2 m x 11 n with
    respect to the parameters of all cameras."""
    seeing = [c for c, camera in enumerate(scene.cameras) if camera.sees(point[None])[0]]
    by_point, by_camera = np.zeros((len(seeing), 2, 3)), np.zeros(
        (len(seeing), 2, len(scene.cameras), PER_CAMERA))
    for row, c in enumerate(seeing):
        by_point[row] = point_derivative(scene.cameras[c], point)
        by_camera[row, :, c] = camera_derivative(scene.cameras[c], point)
    return by_point.reshape(-1, 3), by_camera.reshape(-1, PER_CAMERA * len(scene.cameras))


def lens_prior(camera, knowledge):
    """5 x 5 information about fx, fy, cx, cy, k1; and which of the five are free."""
    fx, fy = camera.parameters[:2]
    scale = np.array([fx, fy])
    focal = (knowledge.focal ** 2 * np.outer(scale, scale)
             + knowledge.focal_ratio ** 2 * np.diag([0.0, fy ** 2]))
    covariance = np.zeros((5, 5))
    covariance[:2, :2] = focal
    covariance[2, 2] = covariance[3, 3] = knowledge.center ** 2
    covariance[4, 4] = knowledge.k1 ** 2
    free = np.diag(covariance) > 0
    information = np.zeros((5, 5))
    information[np.ix_(free, free)] = np.linalg.inv(covariance[np.ix_(free, free)])
    return information, free


class Calibration:
    """Information of the square about a scene's cameras. covariance: least possible, of all
    cameras' parameters, 11 per camera; exactly known parameters have zero rows and columns."""

    def __init__(self, scene, corners, samples, knowledge):
        """corners: N x 3, nominal positions of the LED [m]; samples: images averaged at each."""
        self._cameras = PER_CAMERA * len(scene.cameras)
        size = self._cameras + 2 * len(corners)
        self._prior = np.zeros((size, size))
        information = np.zeros((size, size))
        free = np.ones(size, dtype=bool)
        weight = samples / scene.effective_noise() ** 2
        for c, camera in enumerate(scene.cameras):
            lens = slice(PER_CAMERA * c + 6, PER_CAMERA * (c + 1))
            self._prior[lens, lens], free[lens] = lens_prior(camera, knowledge)
        for k, corner in enumerate(corners):
            by_point, by_camera = seen_derivatives(scene, corner)
            derivative = np.zeros((len(by_point), size))
            derivative[:, :self._cameras] = by_camera
            derivative[:, self._cameras + 2 * k:][:, :2] = by_point[:, :2]
            information += weight * derivative.T @ derivative
        placed = slice(self._cameras, size)
        if knowledge.corner > 0:
            self._prior[placed, placed] = np.eye(2 * len(corners)) / knowledge.corner ** 2
        else:
            free[placed] = False
        # Scaled before inverting: pixels, radians and metres differ by many orders of magnitude.
        kept = (information + self._prior)[np.ix_(free, free)]
        scale = 1.0 / np.sqrt(np.diag(kept))
        self._joint = np.zeros((size, size))
        self._joint[np.ix_(free, free)] = scale[:, None] * np.linalg.inv(
            scale[:, None] * kept * scale) * scale
        self.covariance = self._joint[:self._cameras, :self._cameras]

    def error(self, deviation):
        """Errors of the cameras' parameters of the best estimate from perfect pixels if the truth
        deviates from the priors by `deviation`: 5 lens parameters per camera, then x, y of each
        corner."""
        full = np.zeros(len(self._prior))
        number = self._cameras // PER_CAMERA
        for c in range(number):
            full[PER_CAMERA * c + 6:PER_CAMERA * (c + 1)] = deviation[5 * c:5 * c + 5]
        full[self._cameras:] = deviation[5 * number:]
        return (-self._joint @ self._prior @ full)[:self._cameras]


def deviation_of(scene, nominal_lens, corners, placed):
    """Deviation of a rig from the priors: the argument of Calibration.error() and Bound.best()."""
    return np.concatenate([camera.parameters - nominal_lens for camera in scene.cameras]
                          + [(np.asarray(placed) - corners)[:, :2].reshape(-1)])


def point_sensitivity(scene, calibration, point, samples):
    """Errors of a triangulated point: 3 x (11 cameras) by calibration, 3 x 3 covariance by pixels.

    The triangulation weights pixels with their own noise and that of the calibration.
    """
    by_point, by_camera = seen_derivatives(scene, point)
    if len(by_point) < 4:
        raise ValueError(f'fewer than two cameras see the point {point}')
    pixels = np.eye(len(by_point)) * scene.effective_noise() ** 2 / samples
    weight = np.linalg.inv(pixels + by_camera @ calibration @ by_camera.T)
    solve = np.linalg.solve(by_point.T @ weight @ by_point, by_point.T @ weight)
    return -solve @ by_camera, solve @ pixels @ solve.T


def alignment_basis(points: np.ndarray, kind: str) -> np.ndarray:
    """3N x d: displacements of the points by small alignments of a kind."""
    if kind == 'absolute':
        return np.zeros((3 * len(points), 0))
    columns = rigid_motion.by_pose(points)
    if kind == 'similarity':
        columns = np.concatenate([columns, points[..., None]], axis=-1)
    return columns.reshape(3 * len(points), -1)


@dataclasses.dataclass(eq=False)
class Bound:
    """Bound of the RMS error over the test points [m], for one kind of alignment. rms: over all
    rigs; low, high: range of the RMS of one rig with probability 0.95. by_calibration: errors of
    the test points by those of the cameras; pixels: variance of the points by their pixels, summed
    [m^2]."""

    rms: float
    low: float
    high: float
    calibration: Calibration
    by_calibration: np.ndarray
    pixels: float

    def best(self, deviation):
        """The RMS error of the best estimate for one rig; see Calibration.error()."""
        error = self.by_calibration @ self.calibration.error(deviation)
        return float(np.sqrt((error @ error + self.pixels) / (len(error) // 3)))


def position_bounds(scene, corners, test_points, alignment_points, corner_samples, test_samples,
                    alignment_samples, knowledge=None, experiments=4000):
    """Bound of each of KINDS, for points measured by averaging this many images each."""
    calibration = Calibration(scene, corners, corner_samples, knowledge or Knowledge())

    def joint(points, samples):
        sensitivities = [point_sensitivity(scene, calibration.covariance, p, samples)
                         for p in points]
        noise = np.zeros((3 * len(points),) * 2)
        for i, (_, own) in enumerate(sensitivities):
            noise[3 * i:3 * i + 3, 3 * i:3 * i + 3] = own
        return np.concatenate([s for s, _ in sensitivities]), noise

    test, test_noise = joint(test_points, test_samples)
    aligning, aligning_noise = joint(alignment_points, alignment_samples)
    random = np.random.RandomState(1)
    bounds = {}
    for kind in KINDS:
        # Error left at the test points if an alignment is fitted at the others.
        carry = (alignment_basis(test_points, kind)
                 @ np.linalg.pinv(alignment_basis(alignment_points, kind)))
        by_calibration = test - carry @ aligning
        by_pixels = test_noise + carry @ aligning_noise @ carry.T
        variances = np.clip(np.linalg.eigvalsh(
            by_calibration @ calibration.covariance @ by_calibration.T + by_pixels), 0.0, None)
        squares = random.randn(experiments, len(variances)) ** 2 @ variances / len(test_points)
        low, high = np.sqrt(np.percentile(squares, [2.5, 97.5]))
        bounds[kind] = Bound(float(np.sqrt(variances.sum() / len(test_points))), float(low),
                             float(high), calibration, by_calibration, np.trace(by_pixels))
    return bounds
