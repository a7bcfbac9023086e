"""A rig description as arrays: an independent camera model for scoring and bounds.

It shares no code with the tracker, so that errors there are not repeated here.
"""

import dataclasses
from typing import List

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml


class Camera:
    """parameters: as of project(). rotation: its columns are the image's right, down and forward
    directions in the world. position [m]. size: width, height [px], for sees()."""

    def __init__(self, name, parameters, rotation, position, size=None):
        self.name = name
        self.parameters = np.asarray(parameters, dtype=float)
        self.rotation = rotation
        self.position = np.asarray(position, dtype=float)
        self.size = size

    def project(self, points: np.ndarray) -> np.ndarray:
        """N x 2 pixels of N x 3 points; NaN behind the camera."""
        return project(self.parameters, self.rotation, self.position, points)

    def sees(self, points: np.ndarray) -> np.ndarray:
        """For each of N x 3 points, whether its pixel is in the image."""
        pixel = self.project(points)
        with np.errstate(invalid='ignore'):
            return ((pixel >= 0) & (pixel <= np.asarray(self.size) - 1)).all(axis=1)


def project(parameters: np.ndarray, rotation: np.ndarray, position: np.ndarray,
            points: np.ndarray) -> np.ndarray:
    """N x 2 pixels of N x 3 world points; parameters fx, fy, cx, cy, k1, or also k2, p1, p2, k3."""
    fx, fy, cx, cy, k1, *others = parameters
    seen = (np.atleast_2d(points) - position) @ rotation
    with np.errstate(divide='ignore', invalid='ignore'):
        plane = np.where(seen[:, 2:] > 0, seen[:, :2] / seen[:, 2:], np.nan)
    square = (plane ** 2).sum(axis=1, keepdims=True)
    distorted = plane * (1.0 + k1 * square)
    if others:
        k2, p1, p2, k3 = others
        distorted = distorted + plane * square ** 2 * (k2 + k3 * square) + (
            2.0 * plane * (plane @ [p2, p1])[:, None] + square * [p2, p1])
    return distorted * [fx, fy] + [cx, cy]


def look_at(positions: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """... x 3 x 3: rotations of cameras at ... x 3 positions, with their axes through the targets
    and horizontal image x axes."""
    forward = np.subtract(targets, positions, dtype=float)
    forward /= np.maximum(np.linalg.norm(forward, axis=-1, keepdims=True), 1e-9)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right[np.linalg.norm(right, axis=-1) < 1e-6] = [1.0, 0.0, 0.0]  # looks up or down
    right /= np.linalg.norm(right, axis=-1, keepdims=True)
    return np.stack([right, np.cross(forward, right), forward], axis=-1)


@dataclasses.dataclass(eq=False)
class Scene:
    """True cameras, and the noise of their pixels [px] before rounding."""

    cameras: List[Camera]
    pixel_noise: float

    def effective_noise(self) -> float:
        """Standard deviation of one pixel coordinate, including rounding to whole pixels."""
        return float(np.sqrt(self.pixel_noise ** 2 + 1.0 / 12.0))

    def missed(self, points: np.ndarray) -> List[List[str]]:
        """For each of N x 3 points, the names of cameras that do not see it."""
        seen = [camera.sees(points) for camera in self.cameras]
        return [[camera.name for camera, sees in zip(self.cameras, seen) if not sees[i]]
                for i in range(len(points))]


def read_scene(path: str) -> Scene:
    """Scene of a rig description. Refusal if a lens has more than k1 of plumb_bob."""
    description = read_yaml(path)
    cameras = []
    for name, entry in description['cameras'].items():
        lens = entry['intrinsics']
        if lens.get('distortion_model', 'plumb_bob') != 'plumb_bob' or any(lens['distortion'][1:]):
            raise Refusal(f'{path}: {name} has distortion other than k1 of plumb_bob, which this '
                          'program does not know')
        position = np.asarray(entry['position'], dtype=float)
        cameras.append(Camera(
            name, [lens['fx'], lens['fy'], lens['cx'], lens['cy'], lens['distortion'][0]],
            look_at(position, entry['look_at']), position,
            (lens.get('width', 1024), lens.get('height', 768))))
    return Scene(cameras, float(description['pixel_noise']))
