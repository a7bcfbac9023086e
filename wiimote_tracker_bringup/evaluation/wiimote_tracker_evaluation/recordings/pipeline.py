"""The ordinary programs on a recording in files: self_calibrate, solve_samples with the path as a
wave, and track_bag.

A wave leaves scale and world open, and the solver asks for a square. It gets one that is made up:
four corners as the cameras of self_calibrate would see them, with so little weight that they only
fix what is open.
"""

import itertools
import os

import numpy as np
import rosbag
import rospy
import yaml
from wiimote_tracker_msgs.msg import IrBlob, IrBlobArray

from wiimote_tracker_bringup import multicamselfcal, programs
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_rig, write_yaml
from wiimote_tracker_evaluation.recordings.solved_rig import Rig
from wiimote_tracker_evaluation.recordings.views import LONGEST_GAP

# The first poses come from this many instants at most.
INSTANTS = 400
# The lenses are known, and held: the smallest deviations that the solver takes [1, px].
HELD = {'focal_stddev': 1e-6, 'aspect_stddev': 1e-6, 'principal_point_stddev': 1e-3,
        'k1_stddev': 1e-6, 'maximum_offset_stddev': 0.01}
# From an exposure to the image's arrival, more than clocks may differ [s].
LATENCY = 0.1
# A camera's parameters in a rig's covariance, and those of its principal point.
PER_CAMERA, PRINCIPAL_POINT = 16, [8, 9]
ROUNDS = 200  # of the search for the made-up square
# Noise of its corners: large, so that they fix only scale and world [px].
CORNER_STDDEV = 2.0
BIRTH_WINDOW = 0.03  # in which the tracker looks for a new LED [s]


def calibrate(views, folder, parts=None):
    """The rig; files go to the folder. parts: pairs of a camera's number, from whose first pose to
    start, and the images to solve as a camera; default: each camera once."""
    samples, parameters, rig = (os.path.join(folder, name)
                                for name in ('samples.yaml', 'solve.yaml', 'rig.yaml'))
    numbers, cameras = zip(*(parts or enumerate(views.cameras)))
    rotations, positions, path = first_poses(views, folder)
    side, corners = made_up_square(rotations[list(numbers)], positions[list(numbers)], path)
    write_samples(cameras, side, corners, samples)
    write_yaml(parameters, dict(HELD, pixel_stddev=CORNER_STDDEV))
    programs.run('wiimote_tracker_calibration/solve_samples', samples, '--params', parameters,
                 '--rig', rig)
    return Rig(rig)


def first_poses(views, folder):
    """Rotations and positions of the cameras as if their clocks agreed, by self_calibrate, and the
    body's path. The scale is that of the body."""
    times = views.cameras[0].times
    common = [camera.pixels_at(times).mean(axis=1) for camera in views.cameras]
    both = np.flatnonzero(np.isfinite(common).all(axis=(0, 2)))
    if len(both) < 2:
        raise Refusal('the cameras never saw the lights at the same time')
    chosen = both[::max(1, len(both) // INSTANTS)]
    source, path = os.path.join(folder, 'instants'), os.path.join(folder, 'first.yaml')
    os.makedirs(source, exist_ok=True)
    multicamselfcal.write(
        source, [camera.name for camera in views.cameras],
        [2 * [camera.size] for camera in views.cameras], np.array(common)[:, chosen],
        [[[camera.focal, 0.0, camera.middle], [0.0, camera.focal, camera.middle],
          [0.0, 0.0, 1.0]] for camera in views.cameras], np.zeros((len(views.cameras), 5)))
    programs.run('wiimote_tracker_calibration/self_calibrate', source, '--fix-intrinsics', source,
                 '--rig', path)
    rig = Rig(path)
    scale = rig.scale(views, times[chosen])
    points = rig.intersections(views, times[chosen]).mean(axis=1)
    return rig.rotations, scale * rig.positions, scale * points[np.isfinite(points[:, 0])]


def made_up_square(rotations, positions, path):
    """Side [m] of a square around the path's middle, open to all cameras, and its corners in the
    coordinates of each camera, k x 4 x 3 [m]."""
    middle = np.median(path, axis=0)
    half = np.median(np.linalg.norm(path - middle, axis=1))
    sights = positions - middle
    sights /= np.linalg.norm(sights, axis=1)[:, None]
    up = sights.sum(axis=0)
    # All cameras must see the same side of it. Frank-Wolfe: turns to the direction whose largest
    # angle to any camera is least.
    for _ in range(ROUNDS):
        up += sights[np.argmin(sights @ up)]
    x = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
    y = np.cross(up, x)
    x, y = half * x / np.linalg.norm(x), half * y / np.linalg.norm(y)
    corners = middle + np.array([-x - y, x - y, x + y, y - x])
    return 2.0 * half, np.array([(corners - position) @ rotation
                                 for rotation, position in zip(rotations, positions)])


def write_samples(seen_by, side, corners, path):
    """A file as calibration/save_samples writes it: the middle of the lights as a wave."""
    cameras, frames = [], ''
    for camera, seen in zip(seen_by, corners):
        pixels = camera.middle + camera.focal * seen[:, :2] / seen[:, 2:]
        cameras.append({
            'name': camera.name, 'identity': '', 'gravity': None, 'clock_epoch': 0, 'masks': [],
            'corners': pixels.tolist(), 'frames': len(camera.times),
            'lens': {'width': camera.size, 'height': camera.size, 'fx': camera.focal,
                     'fy': camera.focal, 'cx': camera.middle, 'cy': camera.middle,
                     'distortion_model': 'plumb_bob', 'distortion': 5 * [0.0]}})
        frames += '- |\n' + ''.join(f'  {time!r} {x!r} {y!r}\n' for time, (x, y) in zip(
            camera.times.tolist(), camera.centers.tolist()))
    head = {'format': 'wiimote_tracker_samples', 'version': 1, 'world_frame': 'world', 'wand': None,
            'square': {'side_x': float(side), 'side_y': float(side), 'led_height': 0.0,
                       'origin': [0.0, 0.0], 'yaw': 0.0}, 'cameras': cameras}
    with open(path, 'w') as file:
        file.write(yaml.safe_dump(head) + '--- # Images of the wave, camera by camera: time [s], '
                   'then x and y [px] of every spot.\n' + frames + '...\n')


def lenses_of(views, rig, folder):
    """A file of the rig whose covariance is that of its lenses, whose principal points are off by
    views.accuracy: poses are aligned later."""
    path = os.path.join(folder, 'lenses.yaml')
    content = read_rig(rig.path)
    variances = np.zeros((len(views.cameras), PER_CAMERA))
    variances[:, PRINCIPAL_POINT] = views.accuracy ** 2
    content['covariance'].update(data=np.diag(variances.reshape(-1)).reshape(-1).tolist())
    write_yaml(path, content)
    return path


def track(views, rig, folder, smooth=False):
    """What track_bag makes of the middle of the lights: the columns of its table. smooth: with what
    was seen later, and from the first point of each track that was confirmed later."""
    source, target, table, parameters = (os.path.join(folder, name) for name in (
        'blobs.bag', 'tracked.bag', 'points.csv', 'track.yaml'))
    write_bag(views, rig.offsets, source)
    # Each spot is known to be the body's: one of each camera starts a track, and another, which
    # tells its speed, confirms it.
    write_yaml(parameters, {
        'pixel_stddev': rig.pixel_stddev(),
        'tracks': {'birth_window': BIRTH_WINDOW,
                   'birth_pixel_stddev': BIRTH_WINDOW * spot_speed(views),
                   'confirmation_hits': len(views.cameras)}})
    programs.run('wiimote_tracker_triangulation/track_bag', source, target,
                 '--rig', lenses_of(views, rig, folder), '--params', parameters, '--csv', table,
                 '--results-only', *(['--smooth'] if smooth else []))
    columns = programs.read_csv(table)
    if smooth:
        ids, states = columns['id'], columns['state']
        known_later = (states == 'tentative') & np.isin(ids, ids[states == 'tracked'])
        columns['state'] = np.where(known_later, 'tracked', states)
    return columns


def track_light(source, folder, mode, *options):
    """Runs track_bag on a bag with images of one light by synchronised cameras. Returns its bag."""
    target, parameters = (os.path.join(folder, name) for name in ('light.bag', 'light.yaml'))
    # Frames may be missing: the light may move by metres between instants, which narrow gates do
    # not allow.
    write_yaml(parameters, {'instant': {'maximum_leds': 1, 'maximum_speed': 1000.0,
                                        'maximum_spot_speed': 1e5}, 'learnt_noise': False})
    programs.run('wiimote_tracker_triangulation/track_bag', source, target, '--mode', mode,
                 '--results-only', '--params', parameters, *options)
    return target


def spot_speed(views):
    """RMS [px/s]."""
    speeds = []
    for camera in views.cameras:
        step = np.diff(camera.times)
        ways = np.linalg.norm(np.diff(camera.centers, axis=0), axis=1)
        speeds.append((ways / step)[step < LONGEST_GAP])
    return float(np.sqrt(np.mean(np.square(np.concatenate(speeds)))))


def write_bag(views, offsets, path):
    """Blobs of the middle of the lights, none in an image that does not show them all, in the order
    of their exposure times: each image arrives LATENCY after it. offsets: exposure time minus stamp
    of each camera [s]."""
    nan = float('nan')
    images = sorted((time + offset, time, number, center)
                    for number, (camera, offset) in enumerate(zip(views.cameras, offsets))
                    for time, center in itertools.chain(
                        zip(camera.times.tolist(), camera.centers.tolist()),
                        zip(camera.blank_times.tolist(), itertools.repeat([]))))
    with rosbag.Bag(path, 'w') as bag:
        for i, (exposure, time, number, center) in enumerate(images):
            camera = views.cameras[number]
            blobs = [IrBlob(x=center[0], y=center[1], size=nan, intensity=nan)] if center else []
            image = IrBlobArray(camera=camera.name, frame=i, width=camera.size, height=camera.size,
                                max_blobs=1, stamp_stddev=nan, blobs=blobs)
            image.header.stamp = rospy.Time.from_sec(time)
            image.header.frame_id = camera.name + '_optical_frame'
            image.arrival = rospy.Time.from_sec(exposure + LATENCY)
            bag.write(f'/{camera.name}/ir_blobs', image, image.arrival)
