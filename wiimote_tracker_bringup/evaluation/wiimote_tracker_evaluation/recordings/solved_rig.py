"""Solved rigs, as far as scores need them."""

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_rig
from wiimote_tracker_bringup.scene import Camera

DISTANCE = 3.0  # of a light from cameras in a room [m]


def camera_of(message):
    """A CameraCalibration as a camera. @raise Refusal: it has another distortion model."""
    if message.distortion_model != 'plumb_bob':
        raise Refusal(f'{message.name}: the distortion model {message.distortion_model} is '
                      'not supported')
    place, turn = message.world_from_camera.position, message.world_from_camera.orientation
    distortion = (list(message.distortion) + 5 * [0.0])[:5]
    return Camera(message.name, [message.fx, message.fy, message.cx, message.cy, *distortion],
                  Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix(),
                  [place.x, place.y, place.z])


def cameras_of(content):
    """The cameras of a rig's file, whose lenses are taken for plumb_bob. content: of the file."""
    cameras = []
    for name, camera in content['cameras'].items():
        pose = camera['extrinsics']['transform']
        fx, _, cx, _, fy, cy = camera['camera_matrix']['data'][:6]
        cameras.append(Camera(
            name, [fx, fy, cx, cy, *camera['distortion_coefficients']['data']],
            Rotation.from_quat([pose['rotation'][axis] for axis in 'xyzw']).as_matrix(),
            [pose['translation'][axis] for axis in 'xyz']))
    return cameras


def nearest_points(origins, rays):
    """... x 3: the points nearest to k rays each, from origins, k x 3, along ... x k x 3; NaN where
    a ray is."""
    rays = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    across = np.eye(3) - rays[..., :, None] * rays[..., None, :]
    planes = across.sum(axis=-3)
    right = (across @ np.asarray(origins)[:, :, None]).sum(axis=-3)
    seen = np.isfinite(right).all(axis=(-2, -1))
    points = np.full(seen.shape + (3,), np.nan)
    points[seen] = np.linalg.solve(planes[seen], right[seen])[..., 0]
    return points


class Rig:
    """rotations k x 3 x 3, camera to world; positions k x 3 [m]; offsets k, exposure time minus
    stamp, 0 if not solved [s]; residuals k [px]."""

    def __init__(self, path):
        self.path = path
        content = read_rig(path)
        cameras, entries = cameras_of(content), content['cameras'].values()
        self.rotations = np.array([camera.rotation for camera in cameras])
        self.positions = np.array([camera.position for camera in cameras])
        self.offsets = np.nan_to_num([entry['time_offset'] for entry in entries])
        self.residuals = np.array([entry['residual_px'] for entry in entries])

    def pixel_stddev(self):
        """Of a coordinate [px]."""
        return float(np.sqrt(0.5 * np.mean(self.residuals ** 2)))

    def intersections(self, views, times):
        """Points nearest to the rays of the first two cameras, m x lights x 3 [m]."""
        rays = []
        for camera, offset, rotation in list(zip(views.cameras, self.offsets, self.rotations))[:2]:
            plane = (camera.pixels_at(times - offset) - camera.middle) / camera.focal
            rays.append(np.concatenate([plane, np.ones(plane.shape[:2] + (1,))], axis=2)
                        @ rotation.T)
        return nearest_points(self.positions[:2], np.stack(rays, axis=2))

    def scale(self, views, times):
        """By which lengths are too short, by the distances between the lights of the body. One
        light has no scale: it is DISTANCE from the cameras, because the tracker expects motions in
        m/s^2.
        """
        points = self.intersections(views, times)
        if len(views.shape) == 1:
            return DISTANCE / float(np.nanmedian(np.linalg.norm(points - self.positions, axis=2)))
        pairs = [(i, j) for j in range(len(views.shape)) for i in range(j)]
        ratios = [np.linalg.norm(views.shape[i] - views.shape[j]) /
                  np.linalg.norm(points[:, i] - points[:, j], axis=1) for i, j in pairs]
        return float(np.nanmedian(ratios))
