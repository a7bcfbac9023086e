"""The sections of the quick evaluation that start nodes and measure times."""

import os

import numpy as np
import pytest
import yaml

from quick_evaluation import PAPER_RIG, TIMED, check, column, evaluate

LAP = 1.4883   # of the latency section [s]


@pytest.fixture(scope='module')
def results(tmp_path_factory):
    return evaluate(TIMED, str(tmp_path_factory.mktemp('evaluation')))


def test_every_section_is_complete(results):
    check(results, TIMED)


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
    spread = np.sqrt((((age - mean) ** 2 * gap).sum() + (gap ** 3).sum() / 12) / gap.sum())
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
        bluetooth = mean['Bluetooth (an input of the simulation)']
        assert whole - own == pytest.approx(bluetooth, abs=1e-6)
        assert min(mean.values()) > 0.0


def test_bluetooth_is_the_delay_of_the_description(results):
    with open(PAPER_RIG) as file:
        delay = yaml.safe_load(file)['cameras']['wiimote_1']['delay']
    assert delay['shape'] == 'normal'
    # Normal with this mean, then until the next slot: half a slot more on average. Waiting for the
    # report before is rare; a delayed simulation only adds time.
    least = delay['constant'] + 3.4 * delay['jitter'] + 0.5 * delay['slot']
    for cameras in ('four Wiimotes', 'two Wiimotes'):
        rows = [row for row in results.table('latency', 'images') if row['cameras'] == cameras]
        bluetooth = 1e-3 * column(rows, 'bluetooth_ms')
        assert bluetooth.min() > delay['constant']
        assert bluetooth.mean() > least - 4.0 * delay['jitter'] / np.sqrt(len(bluetooth))


# --- Cost

def costs(results):
    """Rows of all settings of the quick run."""
    rows = results.table('cost', 'nodes')
    assert [(row['cameras'], row['LEDs'], row['busy_processes']) for row in rows] == [
        ('2', '1', '0'), ('4', '1', '0'), ('4', '1', '2'), ('4', '4', '0')]
    return rows


def test_the_cost_counts_all_images_that_the_cameras_send(results):
    with open(PAPER_RIG) as file:
        camera = yaml.safe_load(file)['cameras']['wiimote_1']
    sent = (1.0 - camera['delay']['drops']) / camera['clock']['period']  # 1/s
    for row in costs(results):
        cameras, seconds = int(row['cameras']), 4.0
        expected = cameras * sent
        # Losses come in bursts of 1 / (1 - burst) images on average.
        burst = 1.0 / (1.0 - camera['delay']['burst'])
        spread = np.sqrt(2.0 * burst * camera['delay']['drops'] * cameras * seconds
                         / camera['clock']['period']) / seconds
        assert abs(float(row['images_1_per_s']) - expected) < 5.0 * spread + 2.0 * cameras / seconds


def test_shares_of_the_processor_add_up(results):
    for row in costs(results):
        whole = (int(row['cameras']) * float(row['driver_per_camera_percent'])
                 + float(row['tracker_percent']) + float(row['calibration_percent']))
        assert float(row['all_percent']) == pytest.approx(whole, rel=1e-6)
        assert 0.0 < whole < 100.0 * os.cpu_count()
