"""What the motion of the light in a recording by synchronised cameras brings back: the pose and the
clock of each camera in turn are disturbed, and keep_calibrated corrects the rig.

The rig is that of import_multicamselfcal, with lenses known to 1 px. The layout has no times: the
recording is played with RATE, to and fro. Errors of points are distances, instant by instant, from
those of the rig as it was.
"""

import copy
import os

import numpy as np
import rosbag
import rospy
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import alignment, descriptions, programs
from wiimote_tracker_evaluation.recordings import pipeline

METHOD = ('Each camera in turn is turned by 2 degrees and its clock set 5 ms off, and keep_calibrated '
          'corrects the rig from the recording, played to and fro')
TURN, LATE = np.radians(2.0), 0.005  # [rad], [s]
RATE = 25.0  # [1/s]
PLAYED = 40.0  # [s]
START = 1e9  # [s]
SAME_INSTANT = 1e-4  # of an image and its point [s]
# What is known of the cameras: rotation [rad], position [m], focal length [1], principal point [px],
# distortion [1], clock [s].
ROTATION, POSITION, FOCAL, CENTER, DISTORTION, CLOCK = 1e-4, 1e-4, 1e-3, 1.0, 1e-3, 1e-4


def evaluate(recording, folder):
    """{camera: figures}. recording: a bag of import_multicamselfcal."""
    frames = {}
    with rosbag.Bag(recording) as bag:
        for topic, message, _ in bag.read_messages():
            if topic == '/calibration/rig':
                known = copy.deepcopy(message)
            elif topic.endswith('/ir_blobs'):
                frames.setdefault(message.frame, []).append(message)
    for camera in known.cameras:
        camera.time_offset, camera.time_offset_rule = 0.0, camera.TIME_OFFSET_ONE_EPOCH
    known.covariance = covariance_of(known.cameras)
    played = to_and_fro([frames[frame] for frame in sorted(frames)])
    return {camera.name: figures(known, number, played, folder)
            for number, camera in enumerate(known.cameras)}


def to_and_fro(frames):
    turn = frames + frames[-2:0:-1]
    count = int(RATE * PLAYED)
    return ((count // len(turn) + 1) * turn)[:count]


def covariance_of(cameras):
    deviations = [[ROTATION] * 3 + [POSITION] * 3 + [FOCAL * camera.fx, FOCAL * camera.fy]
                  + [CENTER] * 2 + [DISTORTION] * 5 + [CLOCK] for camera in cameras]
    return np.diag(np.square(np.concatenate(deviations))).ravel().tolist()


def figures(known, number, played, folder):
    """How far pose and clock of the corrected camera are from the truth, RMS errors of points before
    and after, and when it was corrected; None: never."""
    disturbed = copy.deepcopy(known)
    camera = disturbed.cameras[number]
    turn(camera.world_from_camera.orientation, np.random.RandomState(number).randn(3))
    camera.time_offset = LATE
    files = [os.path.join(folder, name) for name in ('known.bag', 'disturbed.bag', 'images.bag')]
    corrected = os.path.join(folder, 'kept.yaml')
    for rig, path in zip((known, disturbed, None), files):
        write_bag(rig, played, path)
    programs.run('wiimote_tracker_calibration/keep_calibrated', files[1], corrected)
    content = descriptions.read(corrected)
    found = content['cameras'][camera.name]
    pose, true = found['extrinsics']['transform'], known.cameras[number].world_from_camera
    left = rotation_of(true.orientation).inv() * Rotation.from_quat(
        [pose['rotation'][axis] for axis in 'xyzw'])
    moved = [pose['translation'][axis] - getattr(true.position, axis) for axis in 'xyz']
    truth, during = (points_of(path, folder) for path in files[:2])
    after = points_of(files[2], folder, '--rig', corrected)
    changed = found['time_offset'] != LATE
    return {'turned_deg': float(np.degrees(left.magnitude())),
            'moved_mm': float(1e3 * np.linalg.norm(moved)), 'clock_ms': 1e3 * found['time_offset'],
            'points_before_mm': 1e3 * rms_error(during, truth),
            'points_after_mm': 1e3 * rms_error(after, truth),
            'after_s': content['solved_at'] - START if changed else None}


def turn(orientation, axis):
    """By TURN about an axis of the camera."""
    turned = rotation_of(orientation) * Rotation.from_rotvec(TURN * axis / np.linalg.norm(axis))
    orientation.x, orientation.y, orientation.z, orientation.w = turned.as_quat()


def rotation_of(orientation):
    return Rotation.from_quat([orientation.x, orientation.y, orientation.z, orientation.w])


def write_bag(rig, played, path):
    """rig: None for a bag without one."""
    with rosbag.Bag(path, 'w') as bag:
        if rig:
            bag.write('/calibration/rig', rig, rospy.Time.from_sec(START - 0.1))
        for number, frame in enumerate(played):
            time = rospy.Time.from_sec(START + number / RATE)
            for recorded in frame:
                image, image.header = copy.copy(recorded), copy.copy(recorded.header)
                image.header.stamp = image.arrival = time
                image.frame = number
                bag.write(f'/{image.camera}/ir_blobs', image, time)


def points_of(source, folder, *options):
    """{number of the played frame: position [m]} of track_bag, instant by instant."""
    table = os.path.join(folder, 'points.csv')
    pipeline.track_light(source, folder, 'instant', '--csv', table, *options)
    columns = programs.read_csv(table)
    times = columns['time [s]'] - START
    numbers = np.rint(times * RATE)
    seen = (columns['state'] != 'predicted') & (np.abs(times - numbers / RATE) < SAME_INSTANT)
    positions = np.stack([columns[f'{axis} [m]'] for axis in 'xyz'], axis=1)
    return dict(zip(numbers[seen].tolist(), positions[seen]))


def rms_error(points, truth):
    """NaN without common points."""
    errors = [points[number] - truth[number] for number in points.keys() & truth.keys()]
    return alignment.rms(np.array(errors)) if errors else float('nan')


def rows_of(result):
    """What is printed and reported: name, value."""
    for name, own in result.items():
        yield (f'{name} turned by 2 degrees, 5 ms off', 'never corrected' if not own['after_s'] else (
            'after {after_s:.0f} s {turned_deg:.2f} degrees, {moved_mm:.1f} mm, {clock_ms:.2f} ms, '
            'points {points_before_mm:.1f} -> {points_after_mm:.2f} mm'.format(**own)))
