"""The whole evaluation with --quick; figures are compared with bounds that are computed here."""

import csv
import json
import os
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np
import pytest
import yaml

HERE = os.path.dirname(os.path.realpath(__file__))
EVALUATION = os.path.join(HERE, '..', 'evaluation')
sys.path.insert(0, EVALUATION)

from wiimote_tracker_evaluation import bound, experiment, scene, sections  # noqa: E402

PAPER_RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')
SEED = 3
LIMIT = 900.0  # of the whole run, on a busy computer [s]
LAP = 1.4883   # of the latency section [s]


class Results:
    def __init__(self, folder, output):
        self.folder, self.output = folder, output
        with open(os.path.join(folder, 'figures.json'), encoding='utf-8') as file:
            self.content = json.load(file)

    def figure(self, section, name):
        found = [each for each in self.content['figures']
                 if (each['section'], each['name']) == (section, name)]
        assert len(found) == 1, f'{name} of {section} is there {len(found)} times'
        return found[0]

    def value(self, section, name):
        return self.figure(section, name)['value']

    def table(self, section, name):
        """Rows of a table, as dictionaries of strings."""
        with open(os.path.join(self.folder, section, name + '.csv'), newline='') as file:
            return list(csv.DictReader(file))


@pytest.fixture(scope='module')
def results(tmp_path_factory):
    folder = str(tmp_path_factory.mktemp('evaluation'))
    done = subprocess.run(
        [sys.executable, os.path.join(EVALUATION, 'evaluate'), '--quick', '--seed', str(SEED),
         '--rig', PAPER_RIG, '--output', folder], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        universal_newlines=True, timeout=LIMIT)
    assert done.returncode == 0, done.stdout
    return Results(folder, done.stdout)


def column(rows, name):
    return np.array([float(row[name]) for row in rows])


def test_every_section_has_figures_and_plots(results):
    assert results.content['failed'] == []
    names = [name for name in sections.names() if name not in ('recordings', 'faults')]  # need files
    assert {each['section'] for each in results.content['figures']} == set(names)
    for name in names:
        files = os.listdir(os.path.join(results.folder, name))
        assert name + '.mat' in files
        drawings = [each for each in files if each.endswith('.svg')]
        assert drawings
        for drawing in drawings:
            root = xml.etree.ElementTree.parse(os.path.join(results.folder, name, drawing)).getroot()
            texts = [text for each in root.iter('{http://www.w3.org/2000/svg}text')
                     for text in each.itertext()]
            assert texts, f'{drawing} has no text'


def test_everything_is_marked_as_simulated(results):
    assert results.content['simulated'] is True
    assert all(each['simulated'] and each['seed'] == SEED for each in results.content['figures'])
    page = open(os.path.join(results.folder, 'report.md'), encoding='utf-8').read()
    assert 'Simulated, rig `paper_rig.yaml`, seed %d, quick run' % SEED in page


def test_intervals_contain_their_values(results):
    for each in results.content['figures']:
        if each['interval'] is not None:
            low, high = each['interval']
            assert low <= high, each
            assert each['samples'] >= 2, each


# --- Latency: measured in two ways, and the simulation's own delay

@pytest.mark.parametrize('case, cameras', [('four', 'four Wiimotes'), ('two', 'two Wiimotes')])
def test_the_laps_counter_finds_the_age_of_the_newest_point(results, case, cameras):
    """The age of the newest point is its latency plus the time since it arrived. The laps counter
    samples it at times that are independent of the points."""
    rows = [row for row in results.table('latency', 'points') if row['cameras'] == cameras]
    published, total = column(rows, 'published_s'), 1e-3 * column(rows, 'total_ms')
    gap = np.diff(published)
    age = total[:-1] + 0.5 * gap  # mean over the time until the next point comes
    mean = (age * gap).sum() / gap.sum()
    spread = np.sqrt(((age - mean) ** 2 * gap).sum() / gap.sum() + (gap ** 3).sum() / gap.sum() / 12)
    crossings = [row for row in results.table('latency', 'crossings') if row['cameras'] == cameras]
    answer, angle = column(crossings, 'answer_rad'), column(crossings, 'angle_rad')
    answered = np.isfinite(answer)
    assert answered.sum() >= 6
    measured = ((answer - angle) * LAP / (2.0 * np.pi))[answered]
    # A filtered position has an error of some millimetres; at 1.69 m/s half a millisecond for each.
    off = 0.005 / (2.0 * np.pi * 0.4 / LAP)
    assert abs(measured.mean() - mean) < 4.0 * np.hypot(spread, off) / np.sqrt(len(measured))
    assert results.value('latency', case + '_by_answer_ms') == pytest.approx(
        1e3 * measured.mean(), rel=1e-6)


def test_parts_of_the_latency_add_up(results):
    for cameras in ('four Wiimotes', 'two Wiimotes'):
        mean = {row['part']: float(row['mean_ms']) for row in results.table('latency', 'parts')
                if row['cameras'] == cameras}
        whole = mean.pop('exposure to published point')
        own = mean.pop('total without Bluetooth')
        assert sum(mean.values()) == pytest.approx(whole, abs=1e-6)
        assert whole - own == pytest.approx(mean['Bluetooth (an input of the simulation)'], abs=1e-6)
        assert min(mean.values()) > 0.0


def test_bluetooth_is_the_delay_of_the_description(results):
    with open(PAPER_RIG) as file:
        delay = yaml.safe_load(file)['cameras']['wiimote_1']['delay']
    assert delay['shape'] == 'bell'
    # Normal with this mean, then until the next slot: half a slot more on average. Waiting for the
    # report before is rare; a delayed simulation only adds time.
    least = delay['constant'] + 3.4 * delay['jitter'] + 0.5 * delay['slot']
    for cameras in ('four Wiimotes', 'two Wiimotes'):
        rows = [row for row in results.table('latency', 'images') if row['cameras'] == cameras]
        bluetooth = 1e-3 * column(rows, 'bluetooth_ms')
        assert bluetooth.min() > delay['constant']
        assert bluetooth.mean() > least - 4.0 * delay['jitter'] / np.sqrt(len(bluetooth))


# --- Cost

def test_the_cost_counts_all_images_that_the_cameras_send(results):
    with open(PAPER_RIG) as file:
        camera = yaml.safe_load(file)['cameras']['wiimote_1']
    sent = (1.0 - camera['delay']['drops']) / camera['clock']['period']  # 1/s
    for row in results.table('cost', 'nodes'):
        cameras, seconds = int(row['cameras']), 4.0
        expected = cameras * sent
        # Losses come in bursts of 1 / (1 - burst) images on average.
        burst = 1.0 / (1.0 - camera['delay']['burst'])
        spread = np.sqrt(2.0 * burst * camera['delay']['drops'] * cameras * seconds
                         / camera['clock']['period']) / seconds
        assert abs(float(row['images_1_per_s']) - expected) < 5.0 * spread + 2.0 * cameras / seconds


def test_shares_of_the_processor_add_up(results):
    for row in results.table('cost', 'nodes'):
        whole = (int(row['cameras']) * float(row['driver_per_camera_percent'])
                 + float(row['tracker_percent']) + float(row['calibration_percent']))
        assert float(row['all_percent']) == pytest.approx(whole, rel=1e-6)
        assert 0.0 < whole < 100.0 * os.cpu_count()


# --- Positions and circles: against bounds of Cramér and Rao

def paper_scene(cameras):
    rig = scene.read_scene(PAPER_RIG)
    return scene.Scene(rig.cameras[:cameras], rig.pixel_noise)


def sums_by_session(results, cameras, method, model='calibrated'):
    """Squared errors of the ten points from where the LED was, and the traces of the covariances."""
    rows = [row for row in results.table('positions', 'points')
            if (row['cameras'], row['method'], row['ray_model']) == (cameras, method, model)]

    def triple(name):
        return np.array([[float(row[f'{name}_{axis}_m'] or 'nan') for axis in 'xyz']
                         for row in rows])
    squared = ((triple('measured') - triple('true')) ** 2).sum(axis=1)
    traces = sum(np.array([float(row[f'var_{axes}_m_2'] or 'nan') for row in rows])
                 for axes in ('xx', 'yy', 'zz'))
    return squared.reshape(-1, 10).sum(axis=1), traces.reshape(-1, 10).sum(axis=1)


@pytest.mark.parametrize('cameras', ['1 2', '1 2 3 4'])
def test_our_calibrations_reach_their_bounds_and_the_papers_first_does_not(results, cameras):
    for method in ('square', 'wave', 'wand'):
        squared, _ = sums_by_session(results, cameras, method)
        _, least = sums_by_session(results, cameras, 'bound_' + method)
        # A sum of squares of Gaussian errors with covariance S has the variance 2 tr(S^2), at most
        # 2 tr(S)^2: three standard deviations of the mean over the sessions.
        by_chance = 3.0 * np.sqrt(2.0 / len(squared))
        assert squared.mean() < (1.0 + by_chance) * least.mean(), method
        first, _ = sums_by_session(results, cameras, 'C1', 'image_center')
        assert first.mean() > (1.0 + by_chance) * least.mean(), method


def test_with_two_cameras_the_correction_repairs_rays_from_the_image_centre(results):
    before, _ = sums_by_session(results, '1 2', 'C1', 'image_center')
    after, _ = sums_by_session(results, '1 2', 'C3', 'image_center')
    assert (after < before / 4.0).all()


@pytest.mark.parametrize('cameras, number', [('1 2', 2), ('1 2 3 4', 4)])
def test_the_bound_agrees_with_another_implementation(results, cameras, number):
    """bound.py has its own camera model and derivatives; the description's rig is another draw."""
    _, least = sums_by_session(results, cameras, 'bound_square')
    drawn = np.sqrt(least / 10.0)
    rig = paper_scene(number)
    corner_pixel = 0.2  # as in the sessions [px]
    other = bound.position_bounds(
        rig, experiment.CORNERS, experiment.TEST_POINTS, experiment.alignment_points(1),
        (rig.effective_noise() / corner_pixel) ** 2, 100, 100,
        bound.Knowledge(focal_ratio=0.005))['absolute'].rms
    assert abs(other - drawn.mean()) < 4.0 * drawn.std(ddof=1)


def test_tracks_are_better_than_the_bound_of_single_images(results):
    """Exactly known cameras, slow circles: radial and height error, compared with the bound for one
    image of each camera."""
    rig = paper_scene(4)
    least = []
    for center in experiment.CIRCLE_CENTERS:
        for angle in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False):
            outwards = np.array([np.cos(angle), np.sin(angle), 0.0])
            point = center + experiment.CIRCLE_RADIUS * outwards
            by_point = np.concatenate([bound.point_derivative(camera, point)
                                       for camera in rig.cameras])
            covariance = rig.effective_noise() ** 2 * np.linalg.inv(by_point.T @ by_point)
            least.append(outwards @ covariance @ outwards + covariance[2, 2])
    measured = sum(results.value('circles', f'four_exact_tracks_{which}_0_5') ** 2
                   for which in ('radial', 'height'))
    assert 0.0 < measured < 1e6 * np.mean(least)
