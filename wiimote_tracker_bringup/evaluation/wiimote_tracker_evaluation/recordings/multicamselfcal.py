"""Held-out points of a recording by synchronised cameras, in the layout of MultiCamSelfCal or flydra.

Every other ten frames are calibrated by self_calibrate, lenses included; the rest are held out, both
ways round. A pixel of a held-out frame is predicted from the point that the other cameras see.
"""

import os
from types import SimpleNamespace

import numpy as np
import rosbag
from scipy.optimize import least_squares

from wiimote_tracker_bringup import programs, rigs
from wiimote_tracker_bringup.errors import ExperimentError
from wiimote_tracker_evaluation import reprojection

METHOD = ('Lenses and poses by self_calibrate from every other ten frames; the rest are held out, '
          'both ways round; a pixel is predicted from the point that the other cameras see')
BLOCK = 10  # frames


def whole(folder):
    """The bag of the recording that evaluate() makes."""
    return os.path.join(folder, 'whole.bag')


def evaluate(source, folder):
    """{camera: figures()} of predictions [px], and their errors [px] by frame."""
    programs.run('import_multicamselfcal', source, whole(folder))
    errors = {}
    for half in (0, 1):
        fitted = os.path.join(folder, f'half_{half}.bag')
        held_out = split(whole(folder), fitted, half)
        rig = os.path.join(folder, f'half_{half}.yaml')
        programs.run('wiimote_tracker_calibration/self_calibrate', fitted, '--rig', rig)
        cameras = cameras_of(rig)
        for frame, pixels in held_out.items():
            for name in pixels:
                error = prediction_error(cameras, pixels, name)
                if error is not None:
                    errors.setdefault(name, {})[frame] = error
    if not errors:
        raise ExperimentError(f'no frame of {source} was seen by three cameras: a prediction needs '
                              'two others')
    result = {name: reprojection.figures(list(own.values())) for name, own in sorted(errors.items())}
    everything = {(frame, name): error for name, own in errors.items()
                  for frame, error in own.items()}
    result['all'] = reprojection.figures(list(everything.values()))
    return result, everything


def split(source, target, half):
    """Writes one half of the frames; {frame: {camera: pixel}} of the other."""
    held_out = {}
    with rosbag.Bag(source) as whole, rosbag.Bag(target, 'w') as part:
        for topic, image, time in whole.read_messages():
            if not topic.endswith('/ir_blobs'):
                continue
            if image.frame // BLOCK % 2 == half:
                part.write(topic, image, time)
            elif image.blobs:
                held_out.setdefault(image.frame, {})[image.camera] = np.array(
                    [image.blobs[0].x, image.blobs[0].y])
    return held_out


def cameras_of(path):
    """{name: camera} of a rig's file, each as reprojection.project() takes it."""
    cameras = {}
    for name, camera in rigs.read(path)['cameras'].items():
        pose = camera['extrinsics']['transform']
        fx, _, cx, _, fy, cy = camera['camera_matrix']['data'][:6]
        cameras[name] = SimpleNamespace(
            name=name, distortion_model=camera['distortion_model'], fx=fx, fy=fy, cx=cx, cy=cy,
            distortion=camera['distortion_coefficients']['data'],
            world_from_camera=SimpleNamespace(position=SimpleNamespace(**pose['translation']),
                                              orientation=SimpleNamespace(**pose['rotation'])))
    return cameras


def prediction_error(cameras, pixels, name):
    """Distance of a camera's pixel from what the others predict [px]; None with fewer than two."""
    others = [(cameras[other], pixel) for other, pixel in pixels.items() if other != name]
    if len(others) < 2:
        return None

    def residuals(point):
        return np.concatenate([behind_is_far(reprojection.project(camera, point)) - pixel
                               for camera, pixel in others])
    point = least_squares(residuals, crossing(others), method='lm').x
    return float(np.linalg.norm(behind_is_far(reprojection.project(cameras[name], point)) -
                                pixels[name]))


def behind_is_far(pixel):
    return np.full(2, 1e6) if pixel is None else pixel


def crossing(views):
    """Where the rays of pinholes come nearest to each other, to start from."""
    across, right = np.zeros((3, 3)), np.zeros(3)
    for camera, (u, v) in views:
        pose = camera.world_from_camera
        ray = reprojection.rotation_matrix(pose.orientation) @ [
            (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0]
        plane = np.eye(3) - np.outer(ray, ray) / (ray @ ray)
        across += plane
        right += plane @ [pose.position.x, pose.position.y, pose.position.z]
    return np.linalg.solve(across, right)
