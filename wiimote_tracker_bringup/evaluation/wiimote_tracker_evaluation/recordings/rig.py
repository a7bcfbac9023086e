"""A solved rig's file, as far as scores need it: poses and clock offsets."""

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import rigs

DISTANCE = 3.0  # of a light from cameras in a room [m]


class Rig:
    """rotations k x 3 x 3, camera to world; positions k x 3 [m]; offsets k, exposure time minus
    stamp, 0 if not solved [s]; residuals k [px]."""

    def __init__(self, path):
        cameras = list(rigs.read(path)['cameras'].values())
        self.path = path
        poses = [camera['extrinsics']['transform'] for camera in cameras]
        self.rotations = Rotation.from_quat([[pose['rotation'][axis] for axis in 'xyzw']
                                             for pose in poses]).as_matrix()
        self.positions = np.array([[pose['translation'][axis] for axis in 'xyz'] for pose in poses])
        self.offsets = np.nan_to_num([camera['time_offset'] for camera in cameras])
        self.residuals = np.array([camera['residual_px'] for camera in cameras])

    def pixel_stddev(self):
        """Of a coordinate [px]."""
        return float(np.sqrt(0.5 * np.mean(self.residuals ** 2)))

    def intersections(self, views, times):
        """Points nearest to the rays of the first two cameras, m x lights x 3 [m]."""
        planes, right = 0.0, 0.0
        for camera, offset, rotation, position in list(zip(
                views.cameras, self.offsets, self.rotations, self.positions))[:2]:
            plane = (camera.pixels_at(times - offset) - camera.middle) / camera.focal
            rays = np.concatenate([plane, np.ones(plane.shape[:2] + (1,))], axis=2) @ rotation.T
            rays /= np.linalg.norm(rays, axis=2, keepdims=True)
            across = np.eye(3) - rays[..., :, None] * rays[..., None, :]
            planes, right = planes + across, right + across @ position
        seen = np.isfinite(right).all(axis=(1, 2))
        points = np.full(right.shape, np.nan)
        points[seen] = np.linalg.solve(planes[seen], right[seen][..., None])[..., 0]
        return points

    def scale(self, views, times):
        """By which lengths are too short, by the distances between the lights of the body. One light
        has no scale: it is DISTANCE from the cameras, because the tracker expects motions in m/s^2.
        """
        points = self.intersections(views, times)
        if len(views.shape) == 1:
            return DISTANCE / float(np.nanmedian(np.linalg.norm(points - self.positions, axis=2)))
        pairs = [(i, j) for j in range(len(views.shape)) for i in range(j)]
        ratios = [np.linalg.norm(views.shape[i] - views.shape[j]) /
                  np.linalg.norm(points[:, i] - points[:, j], axis=1) for i, j in pairs]
        return float(np.nanmedian(ratios))
