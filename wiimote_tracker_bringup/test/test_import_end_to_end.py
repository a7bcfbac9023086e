"""Recordings in foreign layouts go through importer and tracker, without a ROS master.

The result is compared with the recordings' own files and with the truth, by code that shares
nothing with either.
"""

import json
import math
import os
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
import rosbag
import roslib.packages

PACKAGE = 'wiimote_tracker_bringup'
FLYDRA = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'data', 'flydra_excerpt')


def run(program, *arguments, package=PACKAGE):
    """(exit status, standard output, standard error) of a program of the package."""
    found = roslib.packages.find_node(package, program)
    if not found:
        raise AssertionError(f'{program} is not built')
    process = subprocess.run([found[0]] + list(arguments), capture_output=True, text=True)
    return process.returncode, process.stdout, process.stderr


def read_lens(path):
    """K and kc of a .rad file."""
    with open(path) as stream:
        values = dict(line.split('=') for line in stream if '=' in line)
    values = {key.strip(): float(value) for key, value in values.items()}
    k = np.array([[values['K%d%d' % (row, column)] for column in (1, 2, 3)] for row in (1, 2, 3)])
    return k, [values[f'kc{i}'] for i in (1, 2, 3, 4)]


def distort(normalized, kc):
    x, y = normalized
    r2 = x * x + y * y
    radial = 1 + kc[0] * r2 + kc[1] * r2 * r2
    return np.array([x * radial + 2 * kc[2] * x * y + kc[3] * (r2 + 2 * x * x),
                     y * radial + kc[2] * (r2 + 2 * y * y) + 2 * kc[3] * x * y])


def undistort(pixel, k, kc):
    """Undistorted pixel, by fixed-point iteration."""
    target = np.linalg.solve(k, [pixel[0], pixel[1], 1.0])[:2]
    normalized = target.copy()
    for _ in range(200):
        normalized = normalized + target - distort(normalized, kc)
    return (k @ [normalized[0], normalized[1], 1.0])[:2]


def pixel_of(projection, point):
    u, v, w = projection @ np.append(point, 1.0)
    return np.array([u, v]) / w


def rms(distances):
    return math.sqrt(np.mean(np.square(distances)))


class ImportEndToEnd(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='import_end_to_end_')

    def tearDown(self):
        shutil.rmtree(self.folder)

    def report(self, recording):
        """Imports a folder, replays the bag, and returns evaluate_recording's JSON."""
        bag, report = (os.path.join(self.folder, name) for name in ('out.bag', 'report.json'))
        status, _, errors = run('import_multicamselfcal', recording, bag)
        self.assertEqual(status, 0, errors)
        status, self.output, errors = run('evaluate_recording', 'bag', bag, '--json', report)
        self.assertEqual(status, 0, errors)
        with open(report) as stream:
            return json.load(stream)

    def published(self, report):
        """{frame number: position}; frames come at 100 Hz."""
        points = report['published_points']
        first = 1e9
        return {int(round((p['time'] - first) * 100.0)): np.array(p['position']) for p in points}

    def test_flydra(self):
        report = self.report(FLYDRA)
        published = self.published(report)
        # Camera 1 saw all points of the excerpt, each with another camera: its file gives the
        # order.
        rows = [np.loadtxt(os.path.join(FLYDRA, 'cam%d.points4cal.dat' % n)) for n in range(1, 6)]
        self.assertEqual(sorted(published), list(range(len(rows[0]))))
        frame_of = {tuple(row[:3]): frame for frame, row in enumerate(rows[0])}

        all_published, all_shipped = [], []
        for n in range(1, 6):
            # Millimetres to undistorted pixels, in the frame of the shipped points.
            projection = np.loadtxt(os.path.join(FLYDRA, 'camera%d.Pmat.cal' % n))
            k, kc = read_lens(os.path.join(FLYDRA, 'basename%d.rad' % n))
            of_published, of_shipped = [], []
            for row in rows[n - 1]:
                pixel = undistort(row[4:6], k, kc)
                point = 1e3 * published[frame_of[tuple(row[:3])]]
                of_published.append(np.linalg.norm(pixel_of(projection, point) - pixel))
                of_shipped.append(np.linalg.norm(pixel_of(projection, row[:3]) - pixel))
            self.assertLess(np.median(of_published), 0.35)
            name = 'cam%d_0' % n
            # The report uses pixels whose skew (below 1 %) was removed.
            figures = report['published'][name]
            self.assertEqual(figures['observations'], len(of_published))
            self.assertAlmostEqual(figures['rms'] / rms(of_published), 1.0, delta=0.02)
            self.assertAlmostEqual(report['shipped'][name]['rms'] / rms(of_shipped), 1.0,
                                   delta=0.02)
            self.assertIn(name, self.output)
            all_published += of_published
            all_shipped += of_shipped
        # Maximum likelihood minimises the squares: the shipped points cannot be better except for
        # the skew and their rounding.
        self.assertLess(rms(all_published), 1.01 * rms(all_shipped))
        self.assertLess(np.median(all_published), 0.25)

    def test_generated_multicamselfcal(self):
        room = Room(self.folder)
        report = self.report(room.folder)
        published = self.published(report)
        seen_by = np.isfinite(room.pixels).all(axis=2).sum(axis=0)
        self.assertTrue({0, 1, 2, 3, 4} <= set(seen_by))
        self.assertEqual(sorted(published), [f for f in range(Room.FRAMES) if seen_by[f] >= 2])
        errors = [np.linalg.norm(published[f] - room.points[f]) for f in published]
        # 0.2 px at 3 to 6 m and f = 400 px are 2 to 3 mm; two cameras alone are worse.
        self.assertLess(np.median(errors), 0.004)
        reprojections = [np.linalg.norm(room.project(c, published[f]) - room.pixels[c, f])
                         for f in published for c in range(Room.CAMERAS)
                         if np.isfinite(room.pixels[c, f]).all() and (c, f) not in room.spoiled]
        self.assertLess(np.median(reprojections), 2 * Room.NOISE)
        for c in range(Room.CAMERAS):
            figures = report['published']['camera_%d' % (c + 1)]
            self.assertLess(figures['median'], 2 * Room.NOISE)
            self.assertGreaterEqual(figures['inliers'], figures['observations'] - 2)
        # At 10 m/s and more a track soon loses the light, and must not go on without it.
        self.assertGreater(report['points_in_tracks'], 50)
        tracks = report['tracks']['all']
        self.assertLess(tracks['median'], 1.0)
        # An instant has one to four observations.
        outliers = tracks['observations'] - tracks['inliers']
        instants = report['tracked_instants_with_an_outlier']
        self.assertGreater(instants, 0)
        self.assertLessEqual(instants, outliers)
        self.assertGreaterEqual(Room.CAMERAS * instants, outliers)

    def test_solved_cameras_are_at_their_true_places(self):
        room = Room(self.folder)
        bag_path = os.path.join(self.folder, 'out.bag')
        status, _, errors = run('import_multicamselfcal', room.folder, bag_path)
        self.assertEqual(status, 0, errors)
        with rosbag.Bag(bag_path) as bag:
            rig = [message for _, message, _ in bag.read_messages(topics='/calibration/rig')][0]
            blobs = [message for _, message, _ in
                     bag.read_messages(topics='/camera_2/ir_blobs')]
            transforms = [message for _, message, _ in bag.read_messages(topics='/tf_static')][0]
        self.assertEqual(len(transforms.transforms), Room.CAMERAS)
        self.assertEqual(len(rig.cameras), Room.CAMERAS)
        for camera, center in zip(rig.cameras, room.centers):
            p = camera.world_from_camera.position
            self.assertLess(np.linalg.norm(np.array([p.x, p.y, p.z]) - center), 0.01)
        self.assertEqual(len(blobs), Room.FRAMES)
        for frame, message in enumerate(blobs):
            self.assertEqual(message.frame, frame)
            self.assertEqual((message.width, message.height), (660, 500))
            expected = room.pixels[1, frame]
            if np.isfinite(expected).all():
                self.assertEqual([b.x for b in message.blobs], [float(f'{expected[0]:.6f}')])
                self.assertEqual([b.y for b in message.blobs], [float(f'{expected[1]:.6f}')])
            else:
                self.assertEqual(len(message.blobs), 0)

    def test_the_same_folder_gives_the_same_bag(self):
        contents = []
        for name in ('first.bag', 'second.bag', 'first.bag'):
            path = os.path.join(self.folder, name)
            status, _, errors = run('import_multicamselfcal', FLYDRA, path)
            self.assertEqual(status, 0, errors)
            with open(path, 'rb') as stream:
                contents.append(stream.read())
        self.assertTrue(contents[0] == contents[1])
        with open(os.path.join(self.folder, 'first.bag.bak'), 'rb') as stream:
            self.assertTrue(stream.read() == contents[0])

    def test_self_calibrate_refuses_two_trackers_and_keeps_the_bag(self):
        one, two = (os.path.join(self.folder, name) for name in ('one.bag', 'two.bag'))
        self.assertEqual(run('import_multicamselfcal', FLYDRA, one)[0], 0)
        with rosbag.Bag(one) as bag, rosbag.Bag(two, 'w') as both:
            for topic, message, time in bag.read_messages():
                for room in ('/a', '/b'):
                    both.write(room + topic, message, time)
        for arguments, status, words in (((two,), 1, 'keep those of one tracker'),
                                         ((one, '--json', one), 2, 'write to another file'),
                                         ((one, '--rig', one), 2, 'write to another file')):
            before = os.path.getsize(one)
            found, _, errors = run('self_calibrate', *arguments,
                                   package='wiimote_tracker_calibration')
            self.assertEqual(found, status)
            self.assertIn(words, errors)
            self.assertEqual(os.path.getsize(one), before)

    def test_bad_input_gets_one_error_line(self):
        missing = os.path.join(self.folder, 'missing')
        out = os.path.join(self.folder, 'out.bag')
        status, _, errors = run('import_multicamselfcal', missing, out)
        self.assertEqual(status, 1)
        self.assertIn('Res.dat is missing', errors)
        self.assertFalse(os.path.exists(out))
        status, _, errors = run('import_multicamselfcal', FLYDRA, os.path.join(missing, 'out.bag'))
        self.assertEqual(status, 1)
        self.assertIn('cannot be written', errors)
        status, _, errors = run('import_multicamselfcal')
        self.assertEqual(status, 2)
        self.assertIn('usage', errors)
        status, _, errors = run('evaluate_recording', 'bag', missing)
        self.assertEqual(status, 1)
        self.assertIn(missing, errors)
        self.assertNotIn('Traceback', errors)
        with rosbag.Bag(out, 'w'):
            pass
        status, _, errors = run('evaluate_recording', 'bag', out)
        self.assertEqual(status, 1)
        self.assertIn('make it with import_multicamselfcal', errors)
        status, _, errors = run('evaluate_recording', 'bag', out, '--inlier-px', '0')
        self.assertEqual(status, 2)
        self.assertIn('argument --inlier-px: 0 is not within', errors)
        with open(out, 'w') as file:
            file.write('no bag')
        status, _, errors = run('evaluate_recording', 'bag', out)
        self.assertEqual(status, 1)
        self.assertIn(out + ' cannot be read', errors)


class Room:
    """Four cameras with distortion, a moving light, and the folder that MultiCamSelfCal expects."""

    CAMERAS, FRAMES, NOISE = 4, 240, 0.2

    def __init__(self, parent):
        random = np.random.RandomState(1)
        self.folder = os.path.join(parent, 'recording')
        os.mkdir(self.folder)
        self.k, self.kc, self.rotations, self.centers = [], [], [], []
        for c in range(self.CAMERAS):
            self.k.append(np.array([[random.uniform(390, 430), 0, random.uniform(315, 345)],
                                    [0, random.uniform(390, 430), random.uniform(235, 265)],
                                    [0, 0, 1]]))
            self.kc.append([random.uniform(-0.29, -0.26), random.uniform(0.06, 0.08),
                            random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)])
            angle = 0.5 * math.pi * c + random.uniform(-0.2, 0.2)
            center = np.array([4 * math.cos(angle), 4 * math.sin(angle), random.uniform(1.5, 2.5)])
            z = np.array([0, 0, 1]) - center
            z = z / np.linalg.norm(z)
            x = np.cross(z, [0, 0, 1])
            x = x / np.linalg.norm(x)
            self.rotations.append(np.array([x, np.cross(z, x), z]))
            self.centers.append(center)
        t = np.linspace(0, 1, self.FRAMES)
        self.points = np.stack([1.4 * np.sin(23 * t), 1.4 * np.sin(31 * t + 1),
                                1 + np.sin(17 * t + 2)], axis=1)
        self.pixels = np.array([[self.project(c, p) for p in self.points]
                                for c in range(self.CAMERAS)])
        self.pixels += random.normal(0, self.NOISE, self.pixels.shape)
        outside = ((self.pixels < 0) | (self.pixels > [659, 499])).any(axis=2)
        self.pixels[outside] = np.nan
        self.pixels[random.uniform(size=self.pixels.shape[:2]) < 0.2] = np.nan
        self.pixels[:, 100] = np.nan
        self.pixels[1:, 101] = np.nan
        # A large error where all four see the light, so that it can be identified.
        by_all = np.flatnonzero(np.isfinite(self.pixels).all(axis=(0, 2)))
        self.spoiled = [(0, by_all[10]), (2, by_all[20])]
        for c, f in self.spoiled:
            self.pixels[c, f] += [60, -45]
        self.write()

    def project(self, camera, point):
        x, y, z = self.rotations[camera] @ (point - self.centers[camera])
        distorted = distort((x / z, y / z), self.kc[camera])
        return (self.k[camera] @ [distorted[0], distorted[1], 1.0])[:2]

    def write(self):
        def table(name, rows, number):
            with open(os.path.join(self.folder, name), 'w') as stream:
                for row in rows:
                    stream.write(' '.join(number % value for value in row) + '\n')
        seen = np.isfinite(self.pixels).all(axis=2)
        rows = []
        for c in range(self.CAMERAS):
            rows += [self.pixels[c, :, 0], self.pixels[c, :, 1], np.where(seen[c], 1.0, np.nan)]
        table('points.dat', rows, '%.6f')
        table('IdMat.dat', seen.astype(float), '%g')
        table('Res.dat', [[660, 500]] * self.CAMERAS, '%d')
        table('original_cam_centers.dat', self.centers, '%.17g')
        for c in range(self.CAMERAS):
            with open(os.path.join(self.folder, 'basename%d.rad' % (c + 1)), 'w') as stream:
                for row in range(3):
                    for column in range(3):
                        stream.write('K%d%d = %.17g\n'
                                     % (row + 1, column + 1, self.k[c][row, column]))
                stream.write('\n')
                for i, value in enumerate(self.kc[c]):
                    stream.write(f'kc{i + 1} = {value:.17g}\n')
