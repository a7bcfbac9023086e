"""Alignment, bound, scoring and the demo's helpers, compared with closed forms and small cases."""

import json
import os
import subprocess

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import alignment, bound, experiment, scene
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.demo import animation, report, scoring

HERE = os.path.dirname(os.path.realpath(__file__))
PAPER_RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')


# --- Alignment

def a_rotation(seed):
    q, r = np.linalg.qr(np.random.RandomState(seed).randn(3, 3))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


@pytest.mark.parametrize('seed', range(5))
def test_alignment_finds_the_similarity_that_was_applied(seed):
    random = np.random.RandomState(seed)
    source = random.randn(8, 3)
    rotation, translation, scale = a_rotation(seed), random.randn(3), 0.5 + random.rand()
    found = alignment.fit(source, scale * source @ rotation.T + translation, with_scale=True)
    assert np.allclose(found.rotation, rotation, atol=1e-12)
    assert np.allclose(found.translation, translation, atol=1e-12)
    assert found.scale == pytest.approx(scale, abs=1e-12)


def test_rigid_alignment_keeps_the_size_and_is_never_a_reflection():
    random = np.random.RandomState(3)
    source = random.randn(9, 3)
    mirrored = source * [1.0, 1.0, -1.0]
    found = alignment.fit(source, 1.3 * mirrored, with_scale=False)
    assert found.scale == 1.0
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert alignment.rms(found.apply(source) - 1.3 * mirrored) > 0.1


@pytest.mark.parametrize('with_scale', [False, True])
def test_no_small_change_of_the_alignment_fits_better(with_scale):
    random = np.random.RandomState(4)
    source, target = random.randn(10, 3), random.randn(10, 3)
    best = alignment.fit(source, target, with_scale)

    def cost(change):
        changed = alignment.Alignment(Rotation.from_rotvec(change[:3]).as_matrix() @ best.rotation,
                                      best.translation + change[3:6], best.scale + change[6])
        return ((changed.apply(source) - target) ** 2).sum()
    for axis in range(7 if with_scale else 6):
        step = 1e-3 * np.eye(7)[axis]
        assert cost(np.zeros(7)) < min(cost(step), cost(-step))


@pytest.mark.parametrize('points, reason', [
    (np.zeros((5, 3)), 'at one place'), (np.outer(np.arange(5.0), [1, 2, 3]), 'not on one line'),
    (np.eye(3)[:2], 'three points or more'), (np.full((4, 3), np.nan), 'finite points'),
    (np.zeros((3, 2)), 'two N x 3 arrays')])
def test_alignment_refuses_points_that_do_not_determine_it(points, reason):
    with pytest.raises(Refusal, match=reason):
        alignment.fit(points, points, with_scale=True)


def test_rms_is_the_root_of_the_mean_square_length():
    assert alignment.rms([[3.0, 0.0, 0.0], [0.0, 0.0, 4.0]]) == pytest.approx(np.sqrt(12.5))


# --- Scene

def a_camera(position, target, parameters=(1300.0, 1300.0, 512.0, 384.0, 0.0), name='camera'):
    return scene.Camera(name, parameters, scene.look_at(np.asarray(position, float), target),
                        position, (1024, 768))


def test_camera_model_agrees_with_opencv_convention_by_hand():
    camera = a_camera((0, 0, 1), (5, 0, 1), (1000.0, 900.0, 500.0, 400.0, 0.1))
    # 1 m to the camera's right (-y), 0.5 m above its axis, at 5 m.
    x, y = 0.2, -0.1
    radial = 1.0 + 0.1 * (x * x + y * y)
    assert np.allclose(camera.project(np.array([[5.0, -1.0, 1.5]])),
                       [[500.0 + 1000.0 * x * radial, 400.0 + 900.0 * y * radial]])
    assert np.isnan(camera.project(np.array([[-5.0, 0.0, 1.0]]))).all()
    assert camera.sees(np.array([[5.0, 0.0, 1.0], [5.0, -5.0, 1.0], [-5.0, 0.0, 1.0]])).tolist() \
        == [True, False, False]


def test_paper_rig_sees_all_measured_places():
    rig = scene.read_scene(PAPER_RIG)
    assert [camera.name for camera in rig.cameras] == [f'wiimote_{i}' for i in (1, 2, 3, 4)]
    for points in (experiment.TEST_POINTS, experiment.circle_points(), experiment.CORNERS,
                   experiment.alignment_points(2)):
        assert not any(rig.missed(points))


def test_missed_names_the_cameras():
    rig = scene.Scene([a_camera((0, 0, 1), (5, 0, 1), name='a'),
                       a_camera((0, 0, 1), (-5, 0, 1), name='b')], 0.3)
    assert rig.missed(np.array([[5.0, 0.0, 1.0], [0.0, 9.0, 1.0]])) == [['b'], ['a', 'b']]


# --- Bound

EXACT = bound.Knowledge(focal=0.0, focal_ratio=0.0, center=0.0, k1=0.0, corner=0.0)


def test_bound_of_a_stereo_pair_is_the_textbook_formula():
    # Two parallel cameras, baseline b, point at depth z on the middle axis: across (along b)
    # z sigma / (f sqrt 2), in height the same, in depth z^2 sigma sqrt 2 / (f b), for b << z.
    b, z, f = 0.1, 4.0, 1300.0
    pair = scene.Scene([a_camera((0, -b / 2, 0), (9, -b / 2, 0)),
                        a_camera((0, b / 2, 0), (9, b / 2, 0))], 0.4)
    sigma = np.sqrt(0.4 ** 2 + 1.0 / 12.0)
    _, covariance = bound.point_sensitivity(pair, np.zeros((22, 22)), np.array([z, 0.0, 0.0]), 1)
    assert np.sqrt(covariance[0, 0]) == pytest.approx(z * z * sigma * np.sqrt(2.0) / (f * b),
                                                      rel=1e-3)
    assert np.sqrt(covariance[1, 1]) == pytest.approx(z * sigma / (f * np.sqrt(2.0)), rel=1e-3)
    assert np.sqrt(covariance[2, 2]) == pytest.approx(z * sigma / (f * np.sqrt(2.0)), rel=1e-3)
    _, averaged = bound.point_sensitivity(pair, np.zeros((22, 22)), np.array([z, 0.0, 0.0]), 25)
    assert np.allclose(averaged, covariance / 25.0)


def test_a_point_needs_two_cameras():
    pair = scene.Scene([a_camera((0, 0, 1), (5, 0, 1)), a_camera((0, 0, 1), (-5, 0, 1))], 0.3)
    for point in (5.0, 0.0, 1.0), (0.0, 5.0, 1.0):  # seen by one camera, and by none
        with pytest.raises(ValueError, match='fewer than two cameras see the point'):
            bound.point_sensitivity(pair, np.zeros((22, 22)), np.array(point), 1)


def test_pose_bound_agrees_with_many_least_squares_solutions():
    """A camera with a known lens and exact corners, solved by Gauss-Newton from noisy pixels."""
    camera = a_camera((-3.0, -3.0, 2.0), (1.25, 1.25, 1.0))
    rig = scene.Scene([camera], 0.4)
    sigma = rig.effective_noise()
    covariance = bound.Calibration(rig, experiment.CORNERS, 1, EXACT).covariance
    assert not covariance[6:, :].any()

    jacobian = np.concatenate([bound.camera_derivative(camera, corner)[:, :6]
                               for corner in experiment.CORNERS])
    exact = camera.project(experiment.CORNERS)
    random = np.random.RandomState(1)
    solutions = []
    for _ in range(3000):
        pixels = exact + sigma * random.randn(4, 2)
        change = np.zeros(11)
        for _ in range(3):
            residual = (pixels - bound.moved(camera, change, experiment.CORNERS)).reshape(-1)
            change[:6] += np.linalg.lstsq(jacobian, residual, rcond=None)[0]
        solutions.append(change[:6])
    measured = np.std(solutions, axis=0)
    assert np.allclose(measured / np.sqrt(np.diag(covariance)[:6]), 1.0, atol=0.05)


def test_misplaced_corners_that_are_a_motion_of_the_square_move_the_world():
    """With perfect pixels and lenses only the corners' misplacement contributes: a point in the
    middle of the square moves with the mean of the corners, 5 mm / sqrt 4 in each axis."""
    rig = scene.read_scene(PAPER_RIG)
    rig.pixel_noise = 0.0
    knowledge = bound.Knowledge(focal=0.0, focal_ratio=0.0, center=0.0, k1=0.0, corner=0.005)
    calibration = bound.Calibration(rig, experiment.CORNERS, 1e9, knowledge).covariance
    sensitivity, _ = bound.point_sensitivity(rig, calibration, np.array([1.25, 1.25, 0.0]), 1e9)
    covariance = sensitivity @ calibration @ sensitivity.T
    assert np.sqrt(covariance[0, 0]) == pytest.approx(0.0025, rel=0.05)
    assert np.sqrt(covariance[1, 1]) == pytest.approx(0.0025, rel=0.05)


def bounds_with(**knowledge):
    return bound.position_bounds(scene.read_scene(PAPER_RIG), experiment.CORNERS,
                                 experiment.TEST_POINTS, experiment.alignment_points(2, 8), 100,
                                 100, 30, bound.Knowledge(**knowledge), experiments=1000)


@pytest.fixture(scope='module')
def bounds():
    return bounds_with()


def test_alignment_only_helps_and_the_range_holds_the_mean(bounds):
    assert bounds['absolute'].rms > bounds['rigid'].rms > bounds['similarity'].rms > 0.0
    for kind in alignment.KINDS:
        assert bounds[kind].low < bounds[kind].rms < bounds[kind].high


def test_bound_is_the_mean_of_the_best_errors_over_rigs(bounds):
    """Rigs drawn from the prior: their mean square best error equals the bound's."""
    knowledge = bound.Knowledge()
    random = np.random.RandomState(8)
    cameras = scene.read_scene(PAPER_RIG).cameras
    squares = []
    for _ in range(400):
        lenses = []
        for camera in cameras:
            fx, fy = camera.parameters[:2]
            focal = knowledge.focal * random.randn()
            lenses += [fx * focal, fy * (focal + knowledge.focal_ratio * random.randn()),
                       *(knowledge.center * random.randn(2)), knowledge.k1 * random.randn()]
        corners = knowledge.corner * random.randn(8)
        deviation = np.concatenate([lenses, corners])
        squares.append([bounds[kind].best(deviation) ** 2 for kind in alignment.KINDS])
    expected = np.array([bounds[kind].rms ** 2 for kind in alignment.KINDS])
    error = np.std(squares, axis=0) / np.sqrt(len(squares))
    assert (np.abs(np.mean(squares, axis=0) - expected) < 4.0 * error).all()
    assert (error < 0.1 * expected).all()


def test_a_shifted_square_only_shifts_the_world(bounds):
    deviation = np.zeros(5 * 4 + 8)
    deviation[20::2] = 0.003  # all four corners 3 mm too far along x
    assert bounds['absolute'].best(deviation) == pytest.approx(0.003, rel=0.01)
    assert bounds['rigid'].best(deviation) < 6e-4  # the part due to pixel noise


def test_knowing_more_lowers_the_bound(bounds):
    for more in (dict(corner=0.001), dict(focal=0.005), dict(center=2.0)):
        assert bounds_with(**more)['absolute'].rms < bounds['absolute'].rms


@pytest.mark.parametrize('kind, size', [('rigid', 6), ('similarity', 7)])
def test_an_alignment_removes_the_errors_of_a_world_that_is_moved(kind, size):
    """Small motions, applied as alignments: those at the test points follow from those at the
    points to align. A change of the scale is left by a rigid alignment."""
    def displaced(points, change):
        moved = alignment.Alignment(Rotation.from_rotvec(change[:3]).as_matrix(), change[3:6],
                                    1.0 + change[6])
        return (moved.apply(points) - points).reshape(-1)
    test, aligning = experiment.TEST_POINTS, experiment.alignment_points(2)
    carry = (bound.alignment_basis(test, kind)
             @ np.linalg.pinv(bound.alignment_basis(aligning, kind)))
    left = [np.abs(displaced(test, change) - carry @ displaced(aligning, change)).max()
            for change in 1e-6 * np.eye(7)]
    assert max(left[:size]) < 1e-11
    assert min(left[size:], default=1.0) > 1e-7


def test_the_noise_of_a_pixel_includes_its_rounding():
    rig = scene.read_scene(PAPER_RIG)
    assert rig.effective_noise() == pytest.approx(np.sqrt(0.09 + 1.0 / 12.0))


# --- Scoring and report, on a recording made by hand

class HandMade:
    """A recording with a known error of every point."""

    def __init__(self):
        from wiimote_tracker_bringup.conductor import Segment
        from wiimote_tracker_evaluation.demo import published
        points, truths, self.segments = [], [], []
        now = 1000.0
        places = ([('test', p) for p in experiment.TEST_POINTS]
                  + [('alignment', p) for p in experiment.alignment_points(2)])
        for number, (kind, place) in enumerate(places):
            self.segments.append(Segment(kind, f'{kind}{number}', place, now, now + 1.0))
            for i in range(101):
                stamp = now + 0.01 * i
                wiggle = 0.001 * (-1) ** i  # 1 mm to either side in x
                measured = 1.01 * place + [0.0, 0.0, 0.002] + [wiggle, 0.0, 0.0]
                points.append((stamp,) + tuple(measured) + (0.001, 0.001, 0.001, 4, 0.3))
                truths.append((stamp,) + tuple(place))
            now += 2.0
        center = experiment.CIRCLE_CENTERS[0]
        self.segments.append(Segment('circle', 'circle', center, now, now + 1.0))
        for i in range(101):
            stamp, angle = now + 0.01 * i, 2.0 * np.pi * i / 100
            ring = np.array([np.cos(angle), np.sin(angle), 0.0])
            points.append((stamp,) + tuple(center + 0.753 * ring + [0, 0, 0.004])
                          + (0.001, 0.001, 0.001, 4, 0.3))
            truths.append((stamp,) + tuple(center + 0.75 * ring))
        self.recording = published.PublishedPoints(points, truths, np.linspace(0.001, 0.002, 101),
                                             np.full(101, 0.02))


@pytest.fixture(scope='module')
def hand_made():
    return HandMade()


def test_score_of_a_recording_with_known_errors(hand_made):
    score = scoring.score(hand_made.recording, hand_made.segments)
    error = 0.01 * experiment.TEST_POINTS + [0.0, 0.0, 0.002]
    rms = score['position_rms_mm']
    assert rms['absolute'] == pytest.approx(1e3 * alignment.rms(error), rel=1e-2)
    assert rms['similarity'] < 0.1
    assert rms['similarity'] < rms['rigid'] < rms['absolute']
    assert score['point_scatter_mm'] == pytest.approx(1.0, rel=0.02)
    assert score['circles'][0]['radial_rms_mm'] == pytest.approx(3.0, rel=1e-6)
    assert score['circles'][0]['height_rms_mm'] == pytest.approx(4.0, rel=1e-6)
    assert score['rate_hz'] == pytest.approx(101.0, rel=1e-6)
    assert score['latency_ms'] == {'p50': pytest.approx(1.5), 'p99': pytest.approx(1.99)}
    assert score['point_age_ms']['p50'] == pytest.approx(20.0)


def test_a_place_without_points_is_named(hand_made):
    segment = hand_made.segments[0]
    late = type(segment)('test', 'P11', segment.target, 1.0, 2.0)
    with pytest.raises(Refusal, match='P11'):
        scoring.score(hand_made.recording, hand_made.segments + [late])


def test_files_contain_the_figures(hand_made, bounds, tmp_path):
    score = scoring.score(hand_made.recording, hand_made.segments)
    report.write_summary(str(tmp_path / 'summary.json'), 'tracks', score, bounds,
                         {kind: 0.002 for kind in bounds})
    summary = json.loads((tmp_path / 'summary.json').read_text())
    assert set(summary['position_rms_mm']) == {'absolute', 'rigid', 'similarity'}
    assert summary['best_for_this_rig_mm']['rigid'] == 2.0
    assert summary.items() >= score.items()

    report.write_csv(str(tmp_path / 'points.csv'), hand_made.recording, hand_made.segments)
    rows = (tmp_path / 'points.csv').read_text().splitlines()
    assert rows[0].startswith('phase,name,stamp_s,x_m,y_m,z_m,true_x_m')
    assert len(rows) == 1 + 101 * len(hand_made.segments)
    assert len({row.count(',') for row in rows}) == 1

    report.draw_tracks(str(tmp_path / 'tracks.png'), hand_made.recording, hand_made.segments,
                       score)
    assert (tmp_path / 'tracks.png').read_bytes()[:4] == b'\x89PNG'

    animation.draw(str(tmp_path / 'tracks.gif'), scene.read_scene(PAPER_RIG), hand_made.recording,
                   hand_made.segments)
    assert (tmp_path / 'tracks.gif').read_bytes()[:4] == b'GIF8'

    text = report.sentence('tracks', score)
    assert '\n' not in text and '%.1f mm absolute' % score['position_rms_mm']['absolute'] in text


# --- Processes

def test_stopping_ends_grandchildren_that_left_their_parent(tmp_path):
    """In a process of its own: it becomes the reaper of everything below it."""
    program = tmp_path / 'program.py'
    program.write_text('''
import os, sys, time
sys.path.insert(0, %r)
from wiimote_tracker_bringup.processes import Processes, descendants
p = Processes()
# A shell whose child, in its own session, ignores SIGINT and SIGTERM.
p.start('shell', ['sh', '-c', "setsid sh -c \\"trap '' INT TERM; echo up > %s; while :; do "
        "sleep 1; done\\" & wait"], os.devnull)
deadline = time.monotonic() + 20
while not os.path.exists(%r) and time.monotonic() < deadline:
    time.sleep(0.01)
before = len(descendants())
p.stop_all(patience=(0.5, 0.5, 5.0))
print(before, len(descendants()))
''' % (os.path.join(HERE, '..', 'python'), tmp_path / 'up', str(tmp_path / 'up')))
    before, after = subprocess.check_output(['/usr/bin/python3', str(program)],
                                            timeout=60).split()
    assert int(before) >= 2
    assert int(after) == 0


def test_a_process_that_ends_is_noticed_and_named(tmp_path):
    program = tmp_path / 'program.py'
    program.write_text('''
import os, sys
sys.path.insert(0, %r)
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.processes import Processes
p = Processes()
p.start('falsifier', ['false'], os.devnull).wait()
try:
    p.check()
except Refusal as error:
    print(error)
''' % os.path.join(HERE, '..', 'python'))
    said = subprocess.check_output(['/usr/bin/python3', str(program)], timeout=60).decode()
    assert 'falsifier ended unexpectedly (status 1)' in said
