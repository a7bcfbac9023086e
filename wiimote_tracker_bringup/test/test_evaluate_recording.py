"""evaluate_recording on simulated flights in the format of the lighthouse recordings: two stations
whose sweeps hit four sensors at their own times, a log with its delays, a truth elsewhere on the
body by another clock. The errors are compared with the simulation's own."""

import gzip
import json
import os
import sys

import numpy as np
import pytest
import rosbag
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import programs
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml
from wiimote_tracker_evaluation.recordings import (
    accuracy, body, disturbed, flight as flights, formats, lighthouse, multicamselfcal, pipeline,
    program)
from wiimote_tracker_evaluation.recordings.solved_rig import cameras_of
from wiimote_tracker_evaluation.recordings.views import Camera, Truth, Views

HERE = os.path.dirname(os.path.realpath(__file__))
NOISE = 1e-4  # [rad]
DELAYS = (0.0007, 0.0172)  # of the stations' logs beyond the end of both sweeps [s]
RATE, START = 1.011, 3.0  # of the truth's clock, and the cameras' time of its zero
DURATION = 20.0  # [s]
PLACE = np.array([0.01, -0.005, 0.02])  # of the truth on the body [m]


def looking(position, target):
    """Rotation of a station: x to the target, y left, z up as far as possible."""
    x = (target - position) / np.linalg.norm(target - position)
    y = np.cross([0.0, 0.0, 1.0], x)
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], axis=1)


class Flight:
    """Through a 1.4 m cube, about 0.7 m/s, tilting by some degrees; seen from two corners."""

    stations = [np.array([-1.8, 1.9, 2.7]), np.array([2.0, -1.7, 2.6])]

    def __init__(self):
        self.target = np.array([0.0, 0.0, 0.9])
        self.rotations = [looking(place, self.target) for place in self.stations]

    def center(self, times):
        times = np.asarray(times)[..., None]
        return self.target + 0.7 * np.sin(times * [0.97, 0.73, 1.21] + [0.0, 1.1, 2.0])

    def places(self, times, on_body):
        """n x m x 3 of m places on the body."""
        roll, pitch = 0.05 * np.sin(1.3 * times), 0.06 * np.cos(0.9 * times)
        turn = np.zeros((len(times), 3, 3))
        turn[:] = np.eye(3)
        turn[:, 0, 2], turn[:, 2, 0] = pitch, -pitch
        turn[:, 2, 1], turn[:, 1, 2] = roll, -roll
        return self.center(times)[:, None] + (turn @ on_body.T).transpose(0, 2, 1)

    def angles(self, station, times):
        """Exact, n x sensors x 2 [rad]."""
        seen = ((self.places(times, lighthouse.SHAPE) - self.stations[station])
                @ self.rotations[station])
        return np.arctan(seen[..., 1:] / seen[..., :1])

    def bearings(self, random):
        """Rows of the log: a cycle of 30 Hz has two sweeps of station 0, then two of station 1.
        Station 0 is logged again after those of station 1."""
        rows = []
        cycles = 5.0 + np.arange(0.0, DURATION, 4 * lighthouse.SWEEP)
        logs = []
        for station in (0, 1):
            begin = cycles + 2 * station * lighthouse.SWEEP
            measured = []
            for sweep in (0, 1):
                times = begin + sweep * lighthouse.SWEEP
                angle = self.angles(station, times)[..., sweep].mean(axis=1)
                for _ in range(3):  # the plane reaches the body later, the greater the angle
                    at = times + angle / (2.0 * np.pi) * lighthouse.ROTOR_PERIOD
                    angle = self.angles(station, at)[..., sweep].mean(axis=1)
                measured.append(self.angles(station, at)[..., sweep])
            angles = np.stack(measured, axis=2) + NOISE * random.randn(len(cycles), 4, 2)
            logged = begin + 2 * lighthouse.SWEEP + DELAYS[station] + random.uniform(
                -0.0008, 0.0008, len(cycles))
            logs.append((logged, angles))
        for cycle in range(len(cycles)):
            for time, own in ((logs[0][0][cycle], [0]), (logs[1][0][cycle], [0, 1])):
                rows += [(1e3 * time + 0.01 * i, station, sensor, sweep,
                          logs[station][1][cycle, sensor, sweep])
                         for i, (sensor, station, sweep) in enumerate(np.ndindex(4, 2, 2))
                         if station in own]
        return np.array(rows)

    def write(self, folder, random):
        own = np.arange(0.0, RATE * DURATION, 1.0 / 300.0)
        truth = self.places(own / RATE + 5.0, PLACE[None])[:, 0]
        truth[1000:1040] = np.nan
        turned = looking(np.zeros(3), np.array([1.0, 2.0, 0.3]))
        save(os.path.join(folder, 'mocap.csv.gz'), 'time_s,x_m,y_m,z_m',
             np.column_stack([own, truth @ turned.T + [3.0, -2.0, 0.5]]))
        save(os.path.join(folder, 'bearings.csv.gz'), 'time_ms,station,sensor,sweep,angle_rad',
             self.bearings(random))
        with open(os.path.join(folder, 'markers_on_off.csv'), 'w') as file:
            file.write('time_ms\n%r\n%r\n' % (5030.0, 4990.0 + 1e3 * DURATION))

    def bound(self):
        """RMS error of single intersections of both stations' rays, middle of four sensors [m]."""
        variances = []
        for time in np.arange(5.0, 5.0 + DURATION, 0.1):
            rows = []
            for axis in 1e-6 * np.eye(3):
                rows.append([])
                for place, rotation in zip(self.stations, self.rotations):
                    ends = [(self.center(time) + sign * axis - place) @ rotation
                            for sign in (1.0, -1.0)]
                    rows[-1] += list(np.subtract(*[np.arctan(end[1:] / end[0]) for end in ends])
                                     / 2e-6)
            design = np.array(rows).T
            variances.append(np.trace(np.linalg.inv(design.T @ design)) * NOISE ** 2 / 4.0)
        return np.sqrt(np.mean(variances))


def save(path, head, table):
    with gzip.open(path, 'wt') as file:
        np.savetxt(file, table, '%.9g', ',', header=head, comments='')


@pytest.fixture(scope='module')
def flight(tmp_path_factory):
    folder = tmp_path_factory.mktemp('flight')
    Flight().write(str(folder), np.random.RandomState(3))
    return folder


def test_a_simulated_flight_is_as_accurate_as_its_bound(flight, tmp_path, capsys, monkeypatch):
    output = tmp_path / 'figures.json'
    monkeypatch.setattr(sys, 'argv', ['evaluate_recording', 'lighthouse', str(flight), '--json',
                                      str(output)])
    program.main()
    assert 'tracked while in sight' in capsys.readouterr().out
    figures = json.loads(output.read_text())
    # The truth lies 23 mm beside the middle and moves against it as the body tilts.
    times = np.arange(5.0, 5.0 + DURATION, 0.1)
    lever = Flight().places(times, PLACE[None])[:, 0] - Flight().center(times)
    expected = np.hypot(Flight().bound(),
                        np.sqrt(((lever - lever.mean(axis=0)) ** 2).sum(axis=1).mean()))
    assert figures['rms_mm'] < 1.1 * 1e3 * expected
    assert figures['mean_mm'] < figures['rms_mm'] < figures['p95_mm'] < figures['largest_mm']
    assert figures['coverage_95'] > 0.95, 'the stations are better than they are taken for'
    assert figures['tracked'] > 0.99
    assert figures['scale'] == pytest.approx(1.0, abs=0.01)
    assert figures['rigid']['mean_mm'] < 1.0 + figures['mean_mm']
    # What was seen later helps, and a track counts from its first point.
    assert figures['smoothed']['rms_mm'] < figures['rms_mm']
    assert figures['tracked'] <= figures['smoothed']['tracked']
    # Its four lights tell the same place, by a filter that expects the motion of a hand.
    assert figures['body']['rms_mm'] < 2.0 * 1e3 * expected
    assert figures['body']['nees'] < 3.0
    assert figures['body']['tracked'] > 0.95
    # By the log, station 1 is later by the difference of the delays than it swept.
    assert figures['clock_offset_ms']['station_1'] == pytest.approx(
        -1e3 * (DELAYS[1] - DELAYS[0]), abs=0.2)


class Hand(Flight):
    """The same, at twice the speed."""

    def center(self, times):
        return super().center(2.0 * np.asarray(times))


def test_a_body_in_a_hand_is_not_lost_between_images(tmp_path):
    Hand().write(str(tmp_path), np.random.RandomState(3))
    views = lighthouse.read(str(tmp_path))
    rig = pipeline.calibrate(views, str(tmp_path))
    figures, _, _ = flights.score(views, rig, body.track(views, rig, str(tmp_path)))
    assert figures['tracked'] > 0.985
    assert figures['rms_mm'] < 1.9
    assert figures['coverage_95'] > 0.9

    images = tmp_path / 'images.txt'  # of that track, now cut off in its last line
    images.write_text(images.read_text().rsplit(' ', 2)[0])
    with pytest.raises(Refusal, match='has a line that is not camera, time'):
        programs.run('track_labelled_body', pipeline.lenses_of(views, rig, str(tmp_path)), images,
                     tmp_path / 'body.csv')
    lights = images.read_text().splitlines()[0]
    for text, words in [('word\n', 'does not begin with a line of x, y and z'),
                        (lights + ' 1.0\n', 'does not begin with'),
                        (lights + '\n', 'has no image after the lights')]:
        images.write_text(text)
        with pytest.raises(Refusal, match=words):
            programs.run('track_labelled_body', pipeline.lenses_of(views, rig, str(tmp_path)),
                         images, tmp_path / 'none.csv')
    assert not (tmp_path / 'none.csv').exists()


def test_the_images_are_of_the_sweeps_own_times(flight):
    views = lighthouse.read(str(flight))
    simulated = Flight()
    assert len(views.cameras) == len(simulated.stations)
    for station, camera in enumerate(views.cameras):
        assert len(camera.times) > 0.95 * DURATION * 30.0
        # What the log says is later than the sweep by two sweeps and the delay.
        times = camera.times - 2 * lighthouse.SWEEP - DELAYS[station]
        expected = camera.middle - camera.focal * np.tan(simulated.angles(station, times))
        error = camera.pixels - expected
        assert np.abs(error.mean(axis=(0, 1))).max() < 0.02
        assert error.std() < 1.2 * NOISE * camera.focal


def test_both_angles_are_of_one_time_though_the_body_accelerates():
    def tangents(times):
        t = times - 0.2
        return np.stack([0.1 - 0.5 * t + 3.0 * t ** 2, 0.1 + 0.4 * t - 2.0 * t ** 2], axis=-1)
    # In sight for eight turns, hidden, then for three.
    begins = np.concatenate([np.arange(8), np.arange(11, 14)]) / 30.0
    for sweep in (0, 1):
        times = begins[:, None] + np.array([0.0, lighthouse.SWEEP])
        measured = np.stack([tangents(times[:, k])[:, k] for k in (0, 1)], axis=-1)[:, None]
        seen, pixels = lighthouse.images_of(times, measured, sweep)
        assert seen.tolist() == times[:, sweep].tolist()
        expected = 0.5 * (lighthouse.SIZE - 1) - lighthouse.FOCAL * tangents(seen)
        assert pixels[:, 0] == pytest.approx(expected, abs=1e-9)


def test_a_camera_sends_images_also_when_it_sees_nothing(tmp_path):
    seen = np.array([0.0, 0.1, 0.2, 0.5, 0.6, 0.8])  # 10 Hz, three images without the light
    cameras = [Camera(name, 100, 100.0, seen + start, np.full((len(seen), 1, 2), 40.0))
               for name, start in (('one', 5.0), ('other', 5.03))]
    assert cameras[0].blank_times == pytest.approx([5.3, 5.4, 5.7])
    path = str(tmp_path / 'blobs.bag')
    pipeline.write_bag(Views(cameras, np.zeros((1, 3)), 0.0, None), [0.0, 0.0], path)
    with rosbag.Bag(path) as bag:
        images = [image for _, image, _ in bag.read_messages('/one/ir_blobs')]
    assert [image.header.stamp.to_sec() for image in images] == pytest.approx(
        5.0 + 0.1 * np.arange(9))
    assert [len(image.blobs) for image in images] == [1, 1, 1, 0, 0, 1, 1, 0, 1]


def test_coverage_and_nees_of_errors_as_stated():
    random = np.random.RandomState(5)
    times = np.arange(0.0, 40.0, 0.02)
    true = Flight().center(times)
    stddev = np.array([0.001, 0.002, 0.004])
    path = accuracy.Path(times, true + stddev * random.randn(len(times), 3),
                         np.tile(np.diag(stddev ** 2), (len(times), 1, 1)))
    own = np.arange(-1.0, 42.0, 1.0 / 300.0)
    truth = Truth(own, Flight().center((own - 0.5) / RATE), RATE + 1e-4, 0.45, 0.1)
    figures, scored, errors = accuracy.score(path, truth, 'rigid')
    assert len(scored) == len(errors) == len(times)
    assert figures['rms_mm'] == pytest.approx(1e3 * np.linalg.norm(stddev), rel=0.03)
    assert figures['nees'] == pytest.approx(3.0, rel=0.06)
    assert figures['coverage_95'] == pytest.approx(0.95, abs=0.012)


def test_the_place_of_the_truth_on_a_turning_body_is_found():
    random = np.random.RandomState(6)
    times = np.arange(0.0, 40.0, 0.02)
    turns = Rotation.from_rotvec(np.sin(times[:, None] * [1.3, 0.9, 0.7]) * [0.5, 0.6, 0.9])
    center, deviation = Flight().center(times), np.repeat([0.002, 0.05], 3)  # [m], [rad]
    noise = deviation * random.randn(len(times), 6)
    truth = Truth(times, center + turns.apply(PLACE), 1.0, 0.0, 0.1)
    path = accuracy.Path(times, center + noise[:, :3],
                         np.tile(np.diag(deviation ** 2), (len(times), 1, 1)),
                         Rotation.from_rotvec(noise[:, 3:]) * turns)
    _, _, place = accuracy.fit(path, truth, 'rigid')
    assert place == pytest.approx(PLACE, abs=0.0005)
    figures, _, _ = accuracy.score(path, truth, 'rigid')
    assert figures['coverage_95'] == pytest.approx(0.95, abs=0.012)


def camera_at(name, position, target):
    x, y, z = looking(np.array(position), np.array(target)).T
    matrix = np.stack([-y, -z, x], axis=1)  # x to the right, y down, z ahead
    w = 0.5 * np.sqrt(1.0 + np.trace(matrix))
    turn = [matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]
    numbers = np.concatenate([position, np.array(turn) / (4.0 * w), [w]]).tolist()
    return ('  %s: {distortion_model: plumb_bob, camera_matrix: {data: [500, 0, 320, 0, 510, 240, '
            '0, 0, 1]}, distortion_coefficients: {data: [-0.2, 0.05, 0.001, 0.002, 0]}, '
            'extrinsics: {transform: {translation: {x: %r, y: %r, z: %r}, rotation: {x: %r, y: %r, '
            'z: %r, w: %r}}}}\n' % (name, *numbers))


def test_a_pixel_is_predicted_from_the_other_cameras(tmp_path):
    (tmp_path / 'rig.yaml').write_text('cameras:\n' + ''.join(
        camera_at(name, place, [0.1, 0.0, 0.2])
        for name, place in (('a', (2.0, 0.3, 1.0)), ('b', (0.2, 2.0, 1.5)),
                            ('c', (1.5, 1.5, 0.4)))))
    cameras = {camera.name: camera for camera in cameras_of(read_yaml(str(tmp_path / 'rig.yaml')))}
    point = [0.3, -0.2, 0.4]
    pixels = {name: camera.project(point)[0] for name, camera in cameras.items()}
    assert multicamselfcal.prediction_error(cameras, pixels, 'a') == pytest.approx(0.0, abs=1e-6)
    pixels['a'] = pixels['a'] + [3.0, -4.0]
    assert multicamselfcal.prediction_error(cameras, pixels, 'a') == pytest.approx(5.0)
    del pixels['b']
    assert multicamselfcal.prediction_error(cameras, pixels, 'a') is None


def test_real_pixels_that_were_held_out(monkeypatch):
    monkeypatch.setattr(disturbed, 'PLAYED', 2.0)  # the next test judges what 40 s correct
    outcome = formats.measure('multicamselfcal', os.path.join(HERE, 'data', 'flydra_excerpt'))
    figures = outcome.scores['pixels']
    assert figures['observations'] == figures['inliers'] == len(outcome.errors) == 429
    assert figures['median'] < 0.35, 'noise of the pixels: 0.2 px'
    assert figures['p95'] < 1.2
    assert outcome.unit == 'px' and set(outcome.result) == {'held_out', 'disturbed', 'method'}


def test_the_motion_brings_a_disturbed_camera_back(tmp_path):
    recording = str(tmp_path / 'motion.bag')
    programs.run('import_multicamselfcal', os.path.join(HERE, 'data', 'flydra_motion'), recording)
    result = disturbed.evaluate(recording, str(tmp_path))
    for name in ('cam1_0', 'cam4_0', 'cam5_0'):
        own = result[name]
        assert own['after_s'] < 30.0
        assert own['turned_deg'] < 0.2
        assert own['moved_mm'] < 4.0
        assert abs(own['clock_ms']) < 0.2
        assert own['points_after_mm'] < min(0.2, 0.5 * own['points_before_mm'])
    # These two see the light within too small a place.
    assert result['cam2_0']['after_s'] is None and result['cam3_0']['after_s'] is None
    rows = dict(disturbed.rows_of(result))
    assert rows['cam1_0 turned by 2 degrees, 5 ms off'].startswith('after ')
    assert rows['cam2_0 turned by 2 degrees, 5 ms off'] == 'never corrected'


def test_gaps_are_counted_while_in_sight_only():
    times = np.array([0.0, 0.02, 0.04, 0.06, 5.0, 5.02, 5.04])
    tracked = np.array([True, False, False, True, False, False, True])
    assert flights.gaps_of(times, tracked) == pytest.approx([0.02, 0.02])


def test_the_rotors_turns_survive_delays_gaps_and_repeated_logs():
    random = np.random.RandomState(2)
    turn = np.flatnonzero(np.sin(0.05 * np.arange(4000)) > 0.3)  # in sight by turns
    exact = 11.0 + turn * 0.0329697
    logged = exact + random.uniform(-0.0008, 0.0008, len(turn))
    logged[::50] += 0.016
    times, regular = lighthouse.turns_of(logged)
    assert len(times) > 0.95 * len(turn)
    assert np.abs(times - exact[regular] - np.mean(times - exact[regular])).max() < 1e-4


def test_refusals_say_which_file(tmp_path):
    with pytest.raises(Refusal, match='bearings.csv.gz cannot be read'):
        lighthouse.read(str(tmp_path))
    save(str(tmp_path / 'bearings.csv.gz'), 'a,b', np.ones((4, 2)))
    with pytest.raises(Refusal, match='has 2 columns, but must have 5'):
        lighthouse.read(str(tmp_path))
    whole = gzip.compress(b'a,b\n')
    for damaged in (whole[:-10], whole[:10] + bytes(10 * [255])):  # half a download, a bad disk
        (tmp_path / 'bearings.csv.gz').write_bytes(damaged)
        with pytest.raises(Refusal, match='bearings.csv.gz cannot be read'):
            lighthouse.read(str(tmp_path))
    save(str(tmp_path / 'bearings.csv.gz'), 'a,b,c,d,e', np.ones((4, 5)))
    save(str(tmp_path / 'mocap.csv.gz'), 'a,b,c,d', np.ones((4, 4)))
    (tmp_path / 'markers_on_off.csv').write_text('time_ms\n1\n2\n3\n')
    with pytest.raises(Refusal, match='markers_on_off.csv two times'):
        lighthouse.read(str(tmp_path))
