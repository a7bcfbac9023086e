"""Distance, identification and ours: models and a program are compared with closed forms, and the
parts of live measurements are tested."""

import io
import json
import os
import subprocess

import numpy as np
import pytest
import rospy
import yaml

from point_bounds import point_bound
from section_run import section_run
from wiimote_tracker_bringup import programs, scene
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation import evaluation, section
from wiimote_tracker_evaluation.live import circles, dialogue, distance, latency, running_tracker
from wiimote_tracker_evaluation.sections.ours import gestures
from wiimote_tracker_evaluation.sections import identification
from wiimote_tracker_evaluation.sections.distance import light

HERE = os.path.dirname(os.path.realpath(__file__))
RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')
LED = os.path.join(HERE, '..', 'evaluation', 'led.yaml')


def table_of(folder, program, sessions, seed=1):
    path = str(folder / ('%s_%d_%d.csv' % (program, sessions, seed)))
    subprocess.run([programs.find_program(program), '--rig', RIG, '--output', path,
                    '--sessions', str(sessions), '--seed', str(seed)], check=True)
    return programs.read_csv(path), path


# --- The LED's brightness

def test_the_constant_is_recovered_for_any_currents():
    constant, threshold = 3.7, 0.02
    pairs = [(current, np.sqrt(constant * current / threshold)) for current in (0.1, 0.3, 1.2)]
    led = light.Led(70.0, 'wii_3', pairs)
    assert led.brightness_per_ampere(threshold) == pytest.approx(constant)
    # One distance of three that is 10 % too long: the mean of the logarithms.
    led = light.Led(70.0, 'wii_3', pairs[:2] + [(1.2, 1.1 * pairs[2][1])])
    assert led.brightness_per_ampere(threshold) == pytest.approx(constant * 1.1 ** (2.0 / 3.0))


def test_half_the_power_at_half_the_angle():
    led = light.Led(70.0, 'wii_3', [(1.0, 1.0)])
    assert led.relative(np.radians(35.0)) == pytest.approx(0.5)
    assert led.relative(0.0) == 1.0
    assert light.Led(120.0, 'wii_3', [(1.0, 1.0)]).exponent == pytest.approx(1.0), 'Lambert'


def test_the_shipped_led_has_the_papers_point():
    assert light.read_led(LED).measured == [(0.56, 10.0)]


@pytest.mark.parametrize('content, named', [
    ('[]', 'not a description'), ('half_power_angle: 70\nsensitivity: wii_3\n', 'distances'),
    ('half_power_angle: 0\nsensitivity: wii_3\ndistances: {1: 1}', 'half_power_angle'),
    ('half_power_angle: 70\nsensitivity: high\ndistances: {1: 1}', 'sensitivity'),
    ('half_power_angle: 70\nsensitivity: max\ndistances: {}', 'distances'),
    ('half_power_angle: 70\nsensitivity: max\ndistances: {0.0: 1}', 'distances')])
def test_invalid_leds_are_refused(tmp_path, content, named):
    path = tmp_path / 'led.yaml'
    path.write_text(content)
    with pytest.raises(Refusal) as caught:
        light.read_led(str(path))
    assert named in str(caught.value)


# --- Programs

def test_lights_are_seen_up_to_the_distance_of_the_threshold(tmp_path):
    """Thresholds as the virtual Wii Remote documents them; the resolution is one image of the
    walk."""
    table, _ = table_of(tmp_path, 'evaluate_distance', 1)
    step = 0.25 * 0.01
    for level, threshold in (('wii_1', 0.12), ('wii_3', 1.0 / 36.0), ('max', 0.0060)):
        chosen = table['sensitivity'] == level
        assert chosen.any()
        # The light is 0.02 rad off the axis, so its distance exceeds the way by this factor.
        expected = np.sqrt(table['brightness'][chosen] / threshold) / np.sqrt(1.0 + 0.02 ** 2)
        tolerance = step + 1e-6 + (0.01 * expected if level != 'wii_3' else 0.0)  # two digits
        assert (np.abs(table['last_seen_m'][chosen] - expected) <= tolerance).all()
    late = table['stopped_at_m'] - table['last_seen_m']
    # Walking stops 0.5 s after the last change, which is up to one pixel of motion before the last
    # image with the light.
    assert (late <= 0.25 * 0.5 + step).all() and (late > 0.0).all()


@pytest.mark.parametrize('program', ['cameras', 'occlusion'])
def test_a_programs_table_depends_only_on_its_seed(tmp_path, program):
    def written(seed):
        with open(table_of(tmp_path, 'evaluate_' + program, 1, seed)[1], 'rb') as file:
            return file.read()
    first = written(1)
    assert written(1) == first
    if program == 'cameras':  # all take the seed in the same way
        assert written(2) != first


def test_a_sections_files_depend_only_on_its_seed(tmp_path):
    def written(seed):
        assert evaluation.main(['--quick', '--sections', 'distance', '--rig', RIG, '--seed',
                                str(seed), '--output', str(tmp_path)]) == 0
        return [(tmp_path / name).read_bytes() for name in (
            'figures.json', 'distance/carried.csv', 'distance/distance.svg')]
    first = written(1)
    assert written(1) == first
    assert all(again != before for again, before in zip(written(2), first))


def test_the_bound_of_two_cameras_at_a_right_angle():
    """Each sees two axes, both see the height: sum of 1, 1 and 1/2 times (pixel * distance /
    f)^2."""
    f, distance, noise = 1300.0, 6.0, 0.4
    rig = []
    for position in ((-distance, 0.0, 0.0), (0.0, -distance, 0.0)):
        rig.append(scene.Camera('', [f, f, 512.0, 384.0, 0.0],
                                scene.look_at(np.array(position), (0.0, 0.0, 0.0)), position,
                                (1024, 768)))
    expected = noise * distance / f * np.sqrt(2.5)
    assert point_bound(rig, noise, np.zeros((1, 3))) == pytest.approx(expected, rel=1e-6)


# --- Gestures

def write_drawing(path, shape, random):
    """A drawing with a trembling hand; rows x y z t_ms, millimetres."""
    turn = np.linspace(0.0, 1.0, 60)
    points = {'circle': np.stack([np.cos(6.28 * turn), 0.0 * turn, np.sin(6.28 * turn)], axis=1),
              'to-the-right': np.stack([turn, 0.0 * turn, 0.0 * turn], axis=1),
              'up': np.stack([0.0 * turn, 0.0 * turn, turn], axis=1)}[shape]
    points = 300.0 * points + 2.0 * random.randn(60, 3)
    path.write_text(''.join('%.1f %.1f %.1f %d\n' % (tuple(point) + (20 * i,))
                            for i, point in enumerate(points)))


def test_own_recordings_are_measured_and_each_person_is_recognised_by_the_others(tmp_path):
    random = np.random.RandomState(1)
    for person in ('anna', 'ben', 'cleo'):
        (tmp_path / 'people' / person).mkdir(parents=True)
        for shape in ('circle', 'to-the-right', 'up'):
            write_drawing(tmp_path / 'people' / person / (shape + '.csv'), shape, random)
    run = section_run(tmp_path / 'out', rig=RIG, gestures=str(tmp_path / 'people'))
    gestures.tell(run)
    assert not (tmp_path / 'out' / 'drawings').exists(), 'nobody is made up'
    right, rejected = run.figures
    assert (right.value, right.samples, right.simulated) == (100.0, 9, False)
    assert rejected.value == 0.0 and not rejected.simulated
    table, = [each for each in run.contents if isinstance(each, section.Table)]
    assert table.rows == [['circle', 3, 0, 0], ['to-the-right', 0, 3, 0], ['up', 0, 0, 3]]
    assert any('simulated' in each.markdown for each in run.contents
               if isinstance(each, section.Text))


# --- Identification

def tries(length, labelled, seconds):
    count = len(length)
    return {'length_ms': np.array(length, dtype=float), 'labelled': np.array(labelled),
            'wrong': np.zeros(count), 'ever_wrong': np.zeros(count), 'cameras': np.full(count, 4.0),
            'scheme': np.array(['paper'] * count), 'time_s': np.array(seconds, dtype=float)}


def test_the_shortest_period_is_the_one_above_which_nearly_all_succeed():
    line = identification.Line(tries([50, 60, 60, 80, 80], [4, 4, 3, 4, 4], [1, 2, 9, 3, 4]),
                               'paper', 4)
    assert line.shortest() == 80.0  # 50 ms by chance, since 60 ms fails
    assert line.right == [1, 1, 2] and line.tries == [1, 2, 2]
    assert list(line.seconds[1]) == [2.0], 'times are those of successes'
    assert identification.Line(tries([80], [3], [1]), 'paper', 4).shortest() is None
    of_twenty = tries([80] * 20 + [90] * 20, [3] * 2 + [4] * 18 + [3] + [4] * 19, [1] * 40)
    assert identification.Line(of_twenty, 'paper', 4).shortest() == 90.0  # 19 of 20 are enough


# --- Live

def test_circle_errors_of_a_tilted_circle():
    angle = np.linspace(0.0, 6.0, 500)
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(0.2), -np.sin(0.2)],
                     [0.0, np.sin(0.2), np.cos(0.2)]])
    path = 0.7 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1) @ tilt.T + [1, 2, 3]
    centre, radial, height = circles.errors_of(path, 0.75)
    assert centre == pytest.approx([1.0, 2.0, 3.0])
    assert radial == pytest.approx(np.full(500, -0.05))
    assert height == pytest.approx(np.zeros(500), abs=1e-12)


@pytest.mark.parametrize('way', [1.0, -1.0])
def test_the_newest_point_lags_in_the_direction_of_motion(way):
    def at(angle):
        return np.array([np.cos(angle), np.sin(angle), 0.3])
    assert latency.behind(at(0.1 * way), at(0.3 * way), [0.0, 0.0, 2.0 * way]) == pytest.approx(0.2)


def seen(positions, tracked=True):
    return [(0.01 * i, [running_tracker.Led(1, 'led', 0.0, tracked, np.array(position))])
            for i, position in enumerate(positions)]


def test_a_place_is_one_led_that_lies_still():
    still = np.tile([1.0, 2.0, 0.5], (100, 1)) + 1e-3 * np.random.RandomState(1).randn(100, 3)
    place = running_tracker.RunningTracker._place(seen(still))
    assert place.position == pytest.approx(still.mean(axis=0))
    assert place.scatter == pytest.approx(1e-3 * np.sqrt(3.0), rel=0.2) and place.points == 100
    assert running_tracker.RunningTracker._place(seen(still[:5])) is None, 'too few'
    assert running_tracker.RunningTracker._place(seen(still, tracked=False)) is None, 'hidden'
    moved = still + np.linspace(0.0, 0.05, 100)[:, np.newaxis]
    assert running_tracker.RunningTracker._place(seen(moved)) is None, 'it moves'
    two = [(stamp, leds * 2) for stamp, leds in seen(still)]
    assert running_tracker.RunningTracker._place(two) is None, 'which one?'


def test_a_live_measurement_needs_a_master(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:1')
    with pytest.raises(Refusal, match='at http://localhost:1: start the tracker first'):
        running_tracker.RunningTracker()


@pytest.mark.parametrize('namespace, command', [
    ('/', 'rosrun wiimote_tracker_calibration calibrate'),
    ('/hall/second', 'ROS_NAMESPACE=/hall/second rosrun wiimote_tracker_calibration calibrate')])
def test_the_advice_to_calibrate_names_the_namespace(monkeypatch, namespace, command):
    monkeypatch.setattr(running_tracker, 'THERE', 0.0)
    monkeypatch.setattr(rospy, 'get_namespace', lambda: namespace)
    tracker = object.__new__(running_tracker.RunningTracker)
    tracker._rospy, tracker._rig, tracker._seen = rospy, None, []
    with pytest.raises(Refusal, match=rf'calibrate first \({command}\)'):
        tracker.rig()
    with pytest.raises(Refusal, match=f'no points come; see {command} for'):
        tracker.wait_for_points()


def test_a_number_is_requested_until_it_is_valid():
    said = io.StringIO()
    person = dialogue.Dialogue(io.StringIO('far\nnan\n300\n2.5\n\n'), said)
    assert person.ask_number('How far?', 0.01, 100.0) == 2.5
    assert said.getvalue().count('How far?') == 4
    assert person.ask_number('How far?', 0.01, 100.0) is None


def test_distances_of_the_same_current_are_averaged(tmp_path):
    run = section_run(tmp_path)
    distance.tell(run, 'wiimote_1', [(560.0, 10.0), (560.0, 9.0), (100.0, 4.0)])
    written = yaml.safe_load((tmp_path / 'distances.yaml').read_text())['distances']
    assert written == {0.56: 9.5, 0.1: 4.0}


# --- Arrivals of real remotes

def test_exposures_and_clock_on_arrivals_that_were_polled(tmp_path):
    random = np.random.RandomState(1)
    poll, files, errors = 0.0056, [], []
    for number in (1, 2):
        phase = np.cumsum(1.2e-4 * random.randn(8000))
        exposures = 0.003 * number + 0.010035 * np.arange(8000) + phase
        kept = random.uniform(size=8000) > 0.03
        sent = exposures[kept] + random.exponential(0.001, kept.sum())
        arrivals = np.unique(np.round(1e3 * poll * np.ceil(sent / poll)))
        files.append(str(tmp_path / f'remote_{number}.txt'))
        np.savetxt(files[-1], arrivals, '%d')
        last = np.searchsorted(sent, 1e-3 * arrivals + 0.0006) - 1
        errors.append((1e-3 * arrivals - exposures[kept][last])[arrivals > arrivals[0] + 1e4])
    subprocess.run([programs.find_program('evaluate_arrivals'), RIG] + files
                   + ['--json', tmp_path / 'table.json'], check=True)
    table = json.loads((tmp_path / 'table.json').read_text())['arrivals remote_1']
    found = [row['RMS_ms'] for row in table if row['name'].endswith(' arrivals')]
    assert found == pytest.approx([1e3 * np.std(own) for own in errors], rel=0.1)
    clock, grid = ([row[column] for row in table if column in row]
                   for column in ('clock/exact', 'grid/exact'))
    assert len(clock) == 4 and clock[0] < 1.1 and max(clock) < 1.3
    assert len(grid) == 4 and max(grid) < 1.2
