"""Cramer-Rao bounds of single points, by a camera model that shares no code with the tracker."""

import numpy as np

from wiimote_tracker_bringup import bound, scene
from wiimote_tracker_evaluation.sessions import where

MIDDLE = np.array([1.25, 1.25, 1.0])  # target of the ring of evaluate_cameras [m]


def ring_bounds(rig, table, counts):
    """RMS of the bounds of the measured points [mm], for each number of cameras."""
    described = scene.read_scene(rig)
    bounds = []
    for count in counts:
        chosen = where(table, cameras=count, method='most_likely')
        points = np.stack([table[name][chosen] for name in ('x_m', 'y_m', 'z_m')], axis=1)
        points = points[np.isfinite(table['error_mm'][chosen])]
        bounds.append(1e3 * point_bound(ring(described, count), described.effective_noise(),
                                        points))
    return bounds


def ring(described, count):
    """The cameras of evaluate_cameras around the cube."""
    first = described.cameras[0].position - MIDDLE
    step = np.pi / 2.0 if count == 2 else 2.0 * np.pi / count
    cameras = []
    for i in range(count):
        like = described.cameras[i % len(described.cameras)]
        c, s = np.cos(step * i), np.sin(step * i)
        position = MIDDLE + np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ first
        cameras.append(scene.Camera('', like.parameters, scene.look_at(position, MIDDLE), position,
                                    like.size))
    return cameras


def point_bound(cameras, noise, points):
    """RMS over the points of the least standard deviation of a position [m]."""
    information = np.zeros((len(points), 3, 3))
    for camera in cameras:
        jacobian = bound.derivatives(lambda move: camera.project(points + move), [1e-5] * 3)
        seen = camera.sees(points)
        information[seen] += np.einsum('nij,nik->njk', jacobian[seen], jacobian[seen]) / noise ** 2
    return float(np.sqrt(np.mean(np.trace(np.linalg.inv(information), axis1=1, axis2=2))))
