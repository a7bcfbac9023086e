"""plan_rig: its predictions against closed forms and the bound's own model, and its search."""

import dataclasses
import os
import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup import bound, descriptions, scene
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.experiment import NOMINAL_LENS
from wiimote_tracker_bringup.files import read_yaml, write_yaml
from wiimote_tracker_rig_planning import body, plan, plan_rig, prediction, search

HERE = os.path.dirname(os.path.realpath(__file__))
EXAMPLE = os.path.join(HERE, '../config/plan.yaml')
PAPER_RIG = os.path.join(HERE, '../simulation/paper_rig.yaml')
ROOM_TEXT = 'cameras: 2\nvolume: [0, 0, 0, 1, 1, 1]\nstands: [[0, 0, 0, 1, 1, 1]]\n'
ROOM = plan.Plan(2, (0, 0, 0, 2, 2, 2), ((-4, -4, 1, 6, -4, 2),), square=1.0)

POSITIONS = np.array([[-3.0, -3.0, 2.0], [5.7, -3.2, 1.0], [1.0, 1.0, 6.0]])
TARGETS = np.array([[1.0, 1.0, 1.0], [1.0, 0.5, 0.7], [1.0, 1.0, 0.0]])  # the last looks down


def test_derivatives_are_those_of_the_bounds_camera_model():
    points = ROOM.grid(3)
    seen = prediction.look(ROOM, POSITIONS, TARGETS, points)
    frames = scene.look_at(POSITIONS, TARGETS)
    for n, position in enumerate(POSITIONS):
        camera = scene.Camera('', NOMINAL_LENS, frames[n], position, prediction.SIZE)
        for m, point in enumerate(points):
            np.testing.assert_allclose(seen.by_point[n, m], bound.point_derivative(camera, point),
                                       rtol=1e-6, atol=1e-5)
            np.testing.assert_allclose(seen.by_camera[n, m], bound.camera_derivative(camera, point),
                                       rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(frames[2] @ frames[2].T, np.eye(3), atol=1e-12)


def test_two_cameras_at_a_right_angle_know_a_point_as_the_closed_form_says():
    point = np.array([[0.0, 0.0, 1.0]])
    positions, targets = np.array([[-5.0, 0.0, 1.0], [0.0, -5.0, 1.0]]), point.repeat(2, axis=0)
    seen = prediction.look(ROOM, positions, targets, point)
    found = prediction.variances(prediction.information(ROOM, seen, None))[0]
    # Each sees one horizontal direction alone, and both the height.
    pixel = ROOM.pixel_stddev * 5.0 / NOMINAL_LENS[:2]
    assert found == pytest.approx(2.0 * pixel[0] ** 2 + pixel[1] ** 2 / 2.0, rel=1e-3)
    assert prediction.widest_angles(seen.sees, positions, point)[0] == pytest.approx(90.0)


def test_one_camera_alone_and_none_leave_a_point_unknown():
    points = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 50.0]])
    seen = prediction.look(ROOM, np.array([[-5.0, 0.0, 1.0]]), points[:1], points)
    alone, unseen = np.sqrt(prediction.variances(prediction.information(ROOM, seen, None)))
    assert alone == pytest.approx(prediction.UNSEEN, rel=0.01)
    assert unseen == pytest.approx(np.sqrt(3.0) * prediction.UNSEEN)


def test_what_the_cameras_see_is_told_with_rays_that_cross_and_with_parallel_ones():
    crossing = '\n'.join(plan_rig.describe_sight(ROOM, 'ab', POSITIONS[:2], TARGETS[:2]))
    assert re.search(r'pixels alone: [0-9.]+ mm \(RMS\), [0-9.]+ mm \(largest\)', crossing)
    away = plan_rig.describe_sight(ROOM, 'ab', POSITIONS[:2], 100.0 * POSITIONS[:2])
    assert 'no place is seen by two cameras: check that the plan is in metres' in away[-1]
    beside = POSITIONS[:1] + [[0.0, 0.0, 0.0], [0.001, 0.0, 0.0]]
    parallel = '\n'.join(plan_rig.describe_sight(ROOM, 'ab', beside, TARGETS[[0, 0]]))
    assert re.search(r'alone: [0-9.]+ mm \(RMS\), [0-9.]+ mm \(largest; 500 or more: ', parallel)


def test_the_square_tells_a_camera_as_well_as_the_bound_says():
    chosen = dataclasses.replace(ROOM, square=2.0, margin=0.0)
    corners = prediction.look(chosen, POSITIONS[:1], TARGETS[:1], chosen.corners())
    camera = scene.Camera('', NOMINAL_LENS, scene.look_at(POSITIONS[0], TARGETS[0]),
                          POSITIONS[0], prediction.SIZE)
    rig = scene.Scene([camera], np.sqrt(chosen.pixel_stddev ** 2 - 1.0 / 12.0))
    expected = bound.Calibration(rig, chosen.corners(), prediction.IMAGES,
                                 bound.Knowledge(corner=0.0)).covariance
    found = prediction.calibration(chosen, corners)[0]
    np.testing.assert_allclose(np.sqrt(np.diag(found)), np.sqrt(np.diag(expected)), rtol=0.02)


@pytest.mark.parametrize('changes, sees', [
    ({}, True),
    ({'farthest': 4.9}, False),
    ({'led_axis': (1.0, 0.0, 0.0), 'beam': 170.0}, False),
    ({'led_axis': (-1.0, 0.0, 0.0), 'beam': 30.0}, True),
    ({'obstacles': ((-3.0, -0.5, 0.0, -2.0, 0.5, 2.0),)}, False),
    ({'obstacles': ((-3.0, 0.5, 0.0, -2.0, 1.5, 2.0),)}, True),
    ({'obstacles': ((1.0, -0.5, 0.0, 2.0, 0.5, 2.0),)}, True),  # behind the LED
])
def test_what_hides_an_led(changes, sees):
    point = np.array([[0.0, 0.0, 1.0]])
    chosen = dataclasses.replace(ROOM, **changes)
    assert prediction.look(chosen, np.array([[-5.0, 0.0, 1.0]]), point, point).sees[0, 0] == sees


def test_the_margin_of_the_image_is_not_used():
    edge = np.array([[0.0, 5.0 * 500.0 / NOMINAL_LENS[0], 1.0]])  # u = 35 px
    for margin, sees in ((30.0, True), (40.0, False)):
        seen = prediction.look(dataclasses.replace(ROOM, margin=margin),
                               np.array([[-5.0, 0.0, 1.0]]), np.array([[0.0, 0.0, 1.0]]), edge)
        assert seen.sees[0, 0] == sees


def test_the_search_is_never_worse_than_the_greedy_one_and_repeats_itself():
    points = ROOM.grid(search.ACROSS)
    greedy = search.decode(ROOM, search.greedy(ROOM, np.random.RandomState(1)))
    found, again = (search.search(ROOM, 1, 5) for _ in range(2))
    assert prediction.cost(ROOM, *found, points) <= prediction.cost(ROOM, *greedy, points)
    np.testing.assert_array_equal(found, again)
    stand = np.array(ROOM.stands[0])
    assert ((found[0] >= stand[:3]) & (found[0] <= stand[3:])).all()


def test_the_search_betters_a_poor_start(monkeypatch):
    monkeypatch.setattr(search, 'CANDIDATES', 1)
    points = ROOM.grid(search.ACROSS)
    poor = search.decode(ROOM, search.greedy(ROOM, np.random.RandomState(1)))
    found = search.search(ROOM, 1, 5)
    assert prediction.cost(ROOM, *found, points) < 0.5 * prediction.cost(ROOM, *poor, points)


def test_the_search_tells_how_much_is_done_from_its_start_to_its_end(monkeypatch):
    monkeypatch.setattr(search, 'CANDIDATES', 20)
    shares = []
    search.search(ROOM, 1, 5, shares.append)
    assert shares[0] == 0.0 and shares[1] < 0.01 and shares[-1] == 1.0
    assert all(a < b for a, b in zip(shares, shares[1:]))


@pytest.mark.parametrize('terminal, said', [
    (True, '\rsearching:   0% \rsearching:   3% \rsearching: 100% \n'),
    (False, 'searching:   0% \nsearching: 100% \n')])
def test_a_terminal_shows_how_far_the_search_is(monkeypatch, capsys, terminal, said):
    times = iter([10.0, 10.0, 10.1, 12.0, 12.0, 12.1])
    monkeypatch.setattr('sys.stderr.isatty', lambda: terminal)
    monkeypatch.setattr('time.monotonic', lambda: next(times))
    progress = plan_rig.Progress()
    for share in (0.0, 0.01, 0.03, 1.0):
        progress(share)
    assert capsys.readouterr().err == said


@pytest.fixture
def coarse(monkeypatch):
    """What is proposed and told is of few candidates and places, where all that counts is that it
    is told."""
    monkeypatch.setattr(search, 'CANDIDATES', 20)
    monkeypatch.setattr(plan_rig, 'ACROSS', 2)


def test_a_proposal_is_a_rig_that_can_be_simulated_and_scored(coarse, tmp_path, capsys):
    path = str(tmp_path / 'rig.yaml')
    (tmp_path / 'rig.yaml').write_text('# of a user')
    plan_rig.main([EXAMPLE, '--generations', '1', '--output', path])
    assert (tmp_path / 'rig.yaml.bak').read_text() == '# of a user'
    proposed = capsys.readouterr().out
    assert len(scene.read_scene(path).cameras) == 4
    plan_rig.main([EXAMPLE, '--score', path])
    told = capsys.readouterr().out.splitlines()[1:]
    assert told == proposed.splitlines()[-len(told):]


@pytest.mark.parametrize('option', ['--output', '--plot'])
def test_a_missing_folder_is_told_before_the_search(option, tmp_path, monkeypatch):
    monkeypatch.setattr(plan_rig.search, 'search', lambda *_: pytest.fail('it searched'))
    (tmp_path / 'file').write_text('')
    for folder in ('missing', 'file'):
        with pytest.raises(SystemExit, match=f'{folder}/x.png cannot be written'):
            plan_rig.main([EXAMPLE, option, str(tmp_path / folder / 'x.png')])
    plan_rig.check_folder('/dev/null')


@pytest.mark.parametrize('option', ['--output', '--plot'])
def test_the_plan_is_not_overwritten(option, tmp_path):
    path = tmp_path / 'plan.yaml'
    path.write_text(ROOM_TEXT)
    with pytest.raises(SystemExit, match='plan.yaml: write to another file'):
        plan_rig.main([str(path), option, str(path)])
    assert path.read_text() == ROOM_TEXT


def test_ctrl_c_is_answered_in_a_word(tmp_path, monkeypatch, capsys):
    def interrupt(*_):
        raise KeyboardInterrupt
    monkeypatch.setattr(plan_rig.search, 'search', interrupt)
    path = tmp_path / 'plan.yaml'
    path.write_text(ROOM_TEXT)
    with pytest.raises(SystemExit, match='^130$'):
        plan_rig.main([str(path)])
    assert capsys.readouterr().err == 'plan_rig: interrupted\n'


def test_a_rig_that_is_moved_keeps_all_else_in_another_folder(tmp_path, capsys):
    room = tmp_path / 'room'
    room.mkdir()
    rig = read_yaml(PAPER_RIG)
    rig['cameras'] = dict(zip(['door', 'window', 'desk', 'wall'], rig['cameras'].values()))
    rig['leds']['led']['blink'] = {'codes': 'codes.yaml', 'label': 'led'}
    write_yaml(str(room / 'rig.yaml'), rig)
    loaded = plan_rig.read_description(str(room / 'rig.yaml'))
    write_yaml(str(tmp_path / 'saved.yaml'),
                       descriptions.placed(loaded, np.ones((4, 3)), np.eye(4, 3)))
    saved = read_yaml(str(tmp_path / 'saved.yaml'))
    rig['leds']['led']['blink']['codes'] = str(room / 'codes.yaml')
    for drawing in rig['drawings'].values():
        drawing['file'] = str(room / drawing['file'])
    for camera, target in zip(rig['cameras'].values(), np.eye(4, 3)):
        camera.update(position=[1.0, 1.0, 1.0], look_at=list(target))
    assert saved == rig
    plan_rig.main([EXAMPLE, '--score', str(tmp_path / 'saved.yaml')])
    assert 'since door does not see all corners' in capsys.readouterr().out


@pytest.mark.parametrize('text, words', [
    ('cameras: [', 'valid YAML'), ('cameras: {a: {}}', 'rig description'),
    ('cameras: {a: {position: x, look_at: y}}', 'rig description'), ('[]', 'rig description'),
    ('cameras: {a: {position: [0, 0], look_at: [1, 1]}}', 'rig description'),
    ('cameras: {}', 'rig description'), ('cameras: 2024-13-45', 'valid YAML')])
def test_what_is_no_rig_description_is_refused(text, words, tmp_path):
    path = tmp_path / 'rig.yaml'
    path.write_text(text)
    with pytest.raises(SystemExit, match=f'rig.yaml is (no|not) {words}'):
        plan_rig.main([EXAMPLE, '--score', str(path)])


def test_a_map_of_an_unknown_kind_is_refused(coarse, tmp_path):
    with pytest.raises(SystemExit, match="plan_rig: .*map.xyz: Format 'xyz' is not supported"):
        plan_rig.main([EXAMPLE, '--score', PAPER_RIG, '--plot', str(tmp_path / 'map.xyz')])


def test_the_papers_rig_sees_the_whole_cube(capsys):
    plan_rig.main([EXAMPLE, '--score', PAPER_RIG])
    told = capsys.readouterr().out
    assert 'by two cameras or more: 100.0 %; by three: 100.0 %' in told
    assert '2.6 mm (RMS)' in told


LEDS = tuple((0.1 * np.cos(a), 0.1 * np.sin(a), 0.02 * n, np.cos(a), np.sin(a), 0.0)
             for n, a in enumerate(np.radians([0.0, 50.0, 130.0, 180.0, 250.0, 300.0])))
CARRIED = dataclasses.replace(ROOM, body=LEDS, beam=150.0)


def test_a_bodys_covariance_is_that_of_its_pixels_by_numeric_derivatives():
    point = np.array([[1.0, 1.0, 1.0]])
    each, located = prediction.target_information(CARRIED, POSITIONS, TARGETS, point, None)
    assert each.shape == (3, body.HEADINGS, 6, 6) and located.all()
    levers = np.array(LEDS)[:, :3]
    sees = prediction.look(CARRIED, POSITIONS, TARGETS, point + levers, np.array(LEDS)[:, 3:]).sees

    def pixels(pose):
        turn = Rotation.from_rotvec(pose[3:]).as_matrix()
        places = point + pose[:3] + levers @ turn.T
        cameras = [scene.Camera('', NOMINAL_LENS, frame, position, prediction.SIZE)
                   for frame, position in zip(scene.look_at(POSITIONS, TARGETS), POSITIONS)]
        return np.concatenate([camera.project(places)[seen].ravel()
                               for camera, seen in zip(cameras, sees)])
    steps = 1e-6 * np.eye(6)
    derivative = np.array([(pixels(step) - pixels(-step)) / 2e-6 for step in steps])
    expected = derivative @ derivative.T / CARRIED.pixel_stddev ** 2
    scale = 1e-4 * np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert (np.abs(each.sum(axis=0)[0] - expected) < scale).all()


def test_a_body_whose_leds_look_away_is_not_located():
    alone = dataclasses.replace(CARRIED, body=tuple(led for led in LEDS if led[3] > 0.3),
                                beam=200.0)
    twice = [0, 0]  # two cameras at one place
    _, located = prediction.target_information(alone, POSITIONS[twice], TARGETS[twice],
                                               TARGETS[:1], None)
    assert not located[0] and located[3]


def test_cameras_for_a_body_are_planned(coarse, tmp_path, capsys):
    path = tmp_path / 'plan.yaml'
    with open(EXAMPLE) as example:
        path.write_text(example.read().replace(
            'body: []', f'body: {[list(map(float, led)) for led in LEDS]}').replace(
                'beam: 360', 'beam: 150'))
    plan_rig.main([str(path), '--generations', '1'])
    assert 'degrees (RMS)' in capsys.readouterr().out


@pytest.mark.parametrize('text, words', [
    ('volume: [0, 0, 0, 1, 1, 1]', 'cameras is missing'),
    ('cameras: 1\nvolume: [0, 0, 0, 1, 1, 1]\nstands: [[0, 0, 0, 1, 1, 1]]',
     'cameras is 1, but must be from 2 to 64'),
    ('camera: 2', 'camera is unknown; the keys are cameras, volume'),
    ('cameras: 2\nvolume: [0, 0, 0, 1, 1, 0]\nstands: [[0, 0, 0, 1, 1, 1]]', 'volume must have'),
    ('cameras: 2\nvolume: [0, 0, 0, 1, 1]\nstands: [[0, 0, 0, 1, 1, 1]]', 'volume must be 6'),
    ('cameras: 2\nvolume: [0, 0, 0, 1, 1, 1]\nstands: []', 'stands must be a list'),
    ('cameras: 2\nvolume: [0, 0, 0, 1, 1, 1]\nstands: [[0, 0, 0, 1, 1, .nan]]',
     'stands[0] must be'),
    ('cameras: 2\nvolume: [0, 0, 0, 1, 1, 1]\nstands: [[0, 0, 0, 1, 1, 1]]\n'
     'body: [[0, 0, 0, 1, 0, 0]]', 'body must be a list of 3'),
    (ROOM_TEXT + 'beam: 90\nbody: [[0, 0, 0, 1, 0, 0], [0, 1, 0, 1, 0, 0], [0, 0, 1, 0, 0, 0]]',
     r'body[2] must have a direction'),
    (ROOM_TEXT + 'body: [[0, 0, 0, 1, 0, 0], [0, 1, 0, 1, 0, 0], [0, 0, 1, 0, 0, 1]]', 'give beam'),
    ('[', 'is not valid YAML')])
def test_a_bad_plan_is_refused_in_words(tmp_path, text, words):
    path = tmp_path / 'plan.yaml'
    path.write_text(text)
    with pytest.raises(Refusal) as raised:
        plan.read(str(path))
    assert words in str(raised.value)
