"""Held-out points of a recording by synchronised cameras, in the layout of MultiCamSelfCal or
flydra.

Every other ten frames are calibrated by self_calibrate, lenses included; the rest are held out,
both ways round. A pixel of a held-out frame is predicted from the point that the other cameras see.
"""

import os

import numpy as np
import rosbag
from scipy.optimize import least_squares

from wiimote_tracker_bringup import programs
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_rig
from wiimote_tracker_evaluation.recordings import reprojection
from wiimote_tracker_evaluation.recordings.solved_rig import cameras_of, nearest_points

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
        cameras = {camera.name: camera for camera in cameras_of(read_rig(rig))}
        for frame, pixels in held_out.items():
            for name in pixels:
                error = prediction_error(cameras, pixels, name)
                if error is not None:
                    errors.setdefault(name, {})[frame] = error
    if not errors:
        raise Refusal(f'no frame of {source} was seen by three cameras: a prediction needs '
                      'two others')
    return reprojection.per_camera(dict(sorted(errors.items()))), {
        (frame, name): error for name, own in errors.items() for frame, error in own.items()}


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


def prediction_error(cameras, pixels, name):
    """Distance of a camera's pixel from what the others predict [px]; None with fewer than two."""
    others = [(cameras[other], pixel) for other, pixel in pixels.items() if other != name]
    if len(others) < 2:
        return None

    def residuals(point):
        return np.concatenate([miss(camera, point, pixel) for camera, pixel in others])
    point = least_squares(residuals, crossing(others), method='lm').x
    return float(np.linalg.norm(miss(cameras[name], point, pixels[name])))


def miss(camera, point, pixel):
    """From a pixel to where the camera would see the point; far behind the camera [px]."""
    return np.nan_to_num(camera.project(point)[0], nan=1e6) - pixel


def crossing(views):
    """Where the rays of pinholes come nearest to each other, to start from."""
    rays = []
    for camera, pixel in views:
        plane = (pixel - camera.parameters[2:4]) / camera.parameters[:2]
        rays.append(camera.rotation @ np.append(plane, 1.0))
    return nearest_points([camera.position for camera, _ in views], np.array(rays))
