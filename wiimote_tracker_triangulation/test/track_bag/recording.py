"""A small simulated recording: four cameras with their own clocks, LEDs on known paths. Shares no
code with the tracker."""

import math

import genpy
import numpy as np
import std_msgs.msg
from wiimote_tracker_msgs.msg import (CameraCalibration, IrBlob, IrBlobArray, RigCalibration, Zone)

START = 1600000000  # [s]
FOCAL, WIDTH, HEIGHT = 1300.0, 1024, 768
NAMES = ['camera_%d' % i for i in range(4)]
SIDES = {'fx': FOCAL, 'fy': FOCAL, 'cx': 511.5, 'cy': 383.5}


def time_of(seconds):
    """From seconds after START, to the microsecond."""
    return genpy.Time(START, int(round(1e6 * seconds)) * 1000) if seconds >= 0 else \
        genpy.Time(START - 1, int(round(1e6 * (1 + seconds))) * 1000)


def seconds_of(stamp):
    return (stamp.secs - START) + 1e-9 * stamp.nsecs


class Camera:
    """4 m from the middle of the room, 2 m above the floor, looks at the middle."""

    def __init__(self, number, distance=4.0):
        angle = 0.5 * math.pi * number + 0.3
        self.center = np.array([distance * math.cos(angle), distance * math.sin(angle), 2.0])
        z = np.array([0.0, 0.0, 1.0]) - self.center
        z /= np.linalg.norm(z)
        x = np.cross(z, [0.0, 0.0, 1.0])
        x /= np.linalg.norm(x)
        self.axes = np.array([x, np.cross(z, x), z])  # rows: of the camera, in the world

    def pixel(self, point):
        x, y, z = self.axes @ (np.asarray(point) - self.center)
        u, v = FOCAL * x / z + SIDES['cx'], FOCAL * y / z + SIDES['cy']
        inside = z > 0.1 and 0 <= u <= WIDTH - 1 and 0 <= v <= HEIGHT - 1
        return (u, v) if inside else None

    def quaternion(self):
        """(x, y, z, w) of the rotation from camera to world (Bar-Itzhack 2000)."""
        m = self.axes.T
        k = np.array([
            [m[0, 0] - m[1, 1] - m[2, 2], m[1, 0] + m[0, 1], m[2, 0] + m[0, 2], m[2, 1] - m[1, 2]],
            [m[1, 0] + m[0, 1], m[1, 1] - m[0, 0] - m[2, 2], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]],
            [m[2, 0] + m[0, 2], m[2, 1] + m[1, 2], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m.trace()]])
        values, vectors = np.linalg.eigh(k)
        return tuple(vectors[:, np.argmax(values)])


def cameras(distance=4.0):
    return [Camera(i, distance) for i in range(len(NAMES))]


def rig(distance=4.0, zones=()):
    message = RigCalibration(format_version=RigCalibration.FORMAT_VERSION, method='simulated')
    message.header.stamp = time_of(0)
    message.header.frame_id = 'world'
    message.virtual_hfov = message.led_height = float('nan')
    for name, camera in zip(NAMES, cameras(distance)):
        calibration = CameraCalibration(name=name, frame_id=name + '_optical_frame', width=WIDTH,
                                        height=HEIGHT, distortion_model='plumb_bob',
                                        distortion=[0.0] * 5, time_offset=float('nan'),
                                        residual_px=float('nan'), residual_m=float('nan'), **SIDES)
        pose = calibration.world_from_camera
        pose.position.x, pose.position.y, pose.position.z = camera.center
        q = pose.orientation
        q.x, q.y, q.z, q.w = camera.quaternion()
        message.cameras.append(calibration)
    for name, minimum, maximum in zones:
        zone = Zone(name=name)
        zone.minimum.x, zone.minimum.y, zone.minimum.z = minimum
        zone.maximum.x, zone.maximum.y, zone.maximum.z = maximum
        message.zones.append(zone)
    return message


def rig_yaml(distance=4.0):
    """The same as rig.yaml."""
    text = ['format: wiimote_tracker_rig', 'version: 1', 'world_frame: "world"', 'solved_at: 0.0',
            'method: "simulated"', 'verdict: ""', 'ray_model: calibrated', 'virtual_hfov: .nan',
            'square_sides: []', 'led_height: .nan', 'camera_order: [%s]' % ', '.join(NAMES),
            'cameras:']
    for name, camera in zip(NAMES, cameras(distance)):
        text += ['  %s:' % name, '    identity: ""', '    image_width: %d' % WIDTH,
                 '    image_height: %d' % HEIGHT, '    camera_name: %s' % name,
                 '    camera_matrix: {rows: 3, cols: 3, data: [%r, 0, %r, 0, %r, %r, 0, 0, 1]}'
                 % (FOCAL, SIDES['cx'], FOCAL, SIDES['cy']),
                 '    distortion_model: plumb_bob',
                 '    distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}',
                 '    extrinsics:', '      header: {frame_id: "world"}',
                 '      child_frame_id: "%s_optical_frame"' % name, '      transform:',
                 '        translation: {x: %r, y: %r, z: %r}' % tuple(map(float, camera.center)),
                 '        rotation: {x: %r, y: %r, z: %r, w: %r}'
                 % tuple(map(float, camera.quaternion())),
                 '    time_offset: .nan', '    time_offset_rule: none', '    time_offset_epoch: 0',
                 '    gravity: []', '    masks: []', '    residual_px: .nan',
                 '    residual_m: .nan', '    observations: 0', '    inliers: 0']
    return '\n'.join(text + ['zones: []', 'covariance: {rows: 0, cols: 0, data: []}',
                             'complete: true', ''])


def walk(t):
    """Slowly round the middle, 0.5 m/s."""
    return np.array([0.5 * math.cos(t), 0.5 * math.sin(t), 1.1 + 0.1 * math.sin(2 * t)])


def other(t):
    return np.array([-0.4, 0.3 * math.sin(1.5 * t), 0.8])


def images(duration, ways=(walk,), seed=1, noise=0.2, distance=4.0):
    """IrBlobArrays in the order of arrival. Spots in a random order."""
    random = np.random.RandomState(seed)
    result = []
    for number, (name, camera) in enumerate(zip(NAMES, cameras(distance))):
        for frame in range(int(duration / 0.01)):
            t = 0.01 * frame + 0.0023 * number + 1e-5 * number * frame
            image = IrBlobArray(camera=name, width=WIDTH, height=HEIGHT, max_blobs=4, frame=frame,
                                stamp_stddev=float('nan'))
            image.header.stamp = time_of(t)
            image.header.frame_id = name + '_optical_frame'
            image.arrival = time_of(t + 0.009)
            for way in random.permutation(len(ways)):
                pixel = camera.pixel(ways[way](t))
                if pixel is not None:
                    u, v = np.array(pixel) + random.normal(0, noise, 2)
                    image.blobs.append(IrBlob(x=u, y=v, size=2.0, intensity=float('nan'),
                                              slot=len(image.blobs)))
            result.append(image)
    result.sort(key=lambda i: (i.arrival, i.camera))
    return result


def trigger(seconds):
    return std_msgs.msg.Header(stamp=time_of(seconds), frame_id='light_barrier')
