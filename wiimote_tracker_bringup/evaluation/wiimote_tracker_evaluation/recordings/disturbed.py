"""Disturbs pose and clock of each camera in turn and measures how well keep_calibrated restores
them from the motion of the light in a recording by synchronised cameras.

The rig is that of import_multicamselfcal, with lenses known to 1 px. The layout has no times: the
recording is played with RATE, to and fro. Errors of points are distances, instant by instant, from
those of the undisturbed rig.
"""

import copy
import os

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import Quaternion
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import alignment, programs
from wiimote_tracker_bringup.files import read_rig
from wiimote_tracker_evaluation.recordings import pipeline, replay
from wiimote_tracker_evaluation.recordings.solved_rig import camera_of, cameras_of

METHOD = ('Each camera in turn is turned by 2 degrees and its clock set 5 ms off, and '
          'keep_calibrated corrects the rig from the recording, played to and fro')
ANGLE, LATE = np.radians(2.0), 0.005  # of the disturbance [rad], [s]
RATE = 25.0  # [1/s]
PLAYED = 40.0  # [s]
START = 1e9  # [s]
SAME_INSTANT = 1e-4  # of an image and its point [s]
# What is known of the cameras: rotation [rad], position [m], focal length [1], principal point
# [px], distortion [1], clock [s].
ROTATION, POSITION, FOCAL, CENTER, DISTORTION, CLOCK = 1e-4, 1e-4, 1e-3, 1.0, 1e-3, 1e-4


def evaluate(recording, folder):
    """{camera: figures}. recording: a bag of import_multicamselfcal."""
    recorded = replay.Bag(recording)
    true_rig = recorded.rig
    for camera in true_rig.cameras:
        camera.time_offset, camera.time_offset_rule = 0.0, camera.TIME_OFFSET_ONE_EPOCH
    true_rig.covariance = covariance_of(true_rig.cameras)
    played = to_and_fro(recorded.instants)
    true_bag, images_bag = (os.path.join(folder, name) for name in ('true.bag', 'images.bag'))
    write_bag(true_rig, played, true_bag)
    write_bag(None, played, images_bag)
    truth = points_of(true_bag, folder)
    return {camera.name: figures(true_rig, number, played, images_bag, truth, folder)
            for number, camera in enumerate(true_rig.cameras)}


def to_and_fro(frames):
    there_and_back = frames + frames[-2:0:-1]
    count = int(RATE * PLAYED)
    return ((count // len(there_and_back) + 1) * there_and_back)[:count]


def covariance_of(cameras):
    deviations = [[ROTATION] * 3 + [POSITION] * 3 + [FOCAL * camera.fx, FOCAL * camera.fy]
                  + [CENTER] * 2 + [DISTORTION] * 5 + [CLOCK] for camera in cameras]
    return np.diag(np.square(np.concatenate(deviations))).ravel().tolist()


def figures(true_rig, number, played, images_bag, truth, folder):
    """How far pose and clock of the corrected camera are from the truth, RMS errors of points
    before and after, and when it was corrected; None: never. images_bag: of what is played; truth:
    its points by the true rig."""
    disturbed_rig = copy.deepcopy(true_rig)
    disturb(disturbed_rig.cameras[number], np.random.RandomState(number).randn(3))
    disturbed_bag, corrected_rig = (os.path.join(folder, name) for name in (
        'disturbed.bag', 'corrected.yaml'))
    write_bag(disturbed_rig, played, disturbed_bag)
    programs.run('wiimote_tracker_calibration/keep_calibrated', disturbed_bag, corrected_rig)
    before = points_of(disturbed_bag, folder)
    after = points_of(images_bag, folder, '--rig', corrected_rig)
    return {**errors_of(corrected_rig, true_rig.cameras[number]),
            'points_before_mm': 1e3 * rms_error(before, truth),
            'points_after_mm': 1e3 * rms_error(after, truth)}


def disturb(camera, axis):
    """Turns it by ANGLE about an axis of its own, and sets its clock off by LATE."""
    turned = Rotation.from_matrix(camera_of(camera).rotation) * Rotation.from_rotvec(
        ANGLE * axis / np.linalg.norm(axis))
    camera.world_from_camera.orientation = Quaternion(*turned.as_quat())
    camera.time_offset = LATE


def errors_of(path, true_message):
    """Of a camera in a rig's file."""
    content, true = read_rig(path), camera_of(true_message)
    found = next(each for each in cameras_of(content) if each.name == true.name)
    remaining = Rotation.from_matrix(true.rotation.T @ found.rotation)
    offset = content['cameras'][true.name]['time_offset']
    return {'turned_deg': float(np.degrees(remaining.magnitude())),
            'moved_mm': float(1e3 * np.linalg.norm(found.position - true.position)),
            'clock_ms': 1e3 * offset,
            'after_s': content['solved_at'] - START if offset != LATE else None}


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
        corrected = (
            'after {after_s:.0f} s {turned_deg:.2f} degrees, {moved_mm:.1f} mm, {clock_ms:.2f} ms, '
            'points {points_before_mm:.1f} -> {points_after_mm:.2f} mm')
        yield (f'{name} turned by 2 degrees, 5 ms off',
               corrected.format(**own) if own['after_s'] else 'never corrected')
