"""What the fault matrix calls wrong, and since when all is normal."""

import numpy as np

from wiimote_tracker_evaluation.faults.figures import figures, is_tracked, normal_since
from wiimote_tracker_evaluation.faults.listener import Window

RATE = 100.0  # of the points [Hz]


def window(seconds=10.0, error=lambda time: 0.001, present=lambda time: True, stddev=0.001):
    """One LED that moves along x at 1 m/s, with points that lie this much beside it [m]."""
    times = np.arange(0.0, seconds, 1.0 / RATE)
    rows = np.array([(t + 0.01, t, t, error(t), 0.0, stddev) for t in times if present(t)])
    truth = np.array([(t, t, 0.0, 0.0) for t in np.arange(-1.0, seconds + 1.0, 0.02)])
    return Window(rows, np.array(['a'] * len(rows)), np.array(['left right'] * len(rows)),
                  {'one': truth}, [])


def test_rate_error_age_names_and_cameras():
    found = figures(window(), 10.0)
    assert abs(found.rate - RATE) < 1.0
    assert abs(found.error - 0.001) < 1e-6 and abs(found.age - 0.01) < 1e-6
    assert found.names == {'one': 'a'} and found.cameras == ['left', 'right']
    assert found.wrong == 0


def test_a_point_is_wrong_beyond_its_own_claim_only():
    far = window(error=lambda time: 0.2 if time > 9.0 else 0.0)
    assert figures(far, 10.0).wrong == 99 and abs(figures(far, 10.0).worst - 0.2) < 1e-6
    assert figures(window(error=lambda time: 0.2, stddev=0.1), 10.0).wrong == 0


def test_points_without_truth_do_not_count():
    found = window()
    truth = found.truth['one']
    found.truth['one'] = truth[(truth[:, 0] < 4.0) | (truth[:, 0] > 6.0)]
    assert abs(figures(found, 10.0).number - 800) < 5


def test_points_during_a_leap_of_the_truth_do_not_count():
    found = window(error=lambda time: 0.2 if time > 5.0 else 0.0)
    truth = found.truth['one']
    truth[truth[:, 0] > 5.05, 2] += 0.2
    assert figures(found, 10.0).wrong == 4  # before the leap
    truth[truth[:, 0] > 5.005, 2] = 0.2
    assert figures(found, 10.0).wrong == 0


def test_a_room_is_not_tracked_while_a_camera_is_missing():
    assert is_tracked(window(), 10.0, 1, ['left', 'right'])
    assert not is_tracked(window(), 10.0, 1, ['left', 'right', 'late'])
    assert not is_tracked(window(), 10.0, 2, ['left', 'right'])


def test_a_room_with_wrong_or_few_points_is_not_tracked():
    assert not is_tracked(window(error=lambda time: 0.2 if time > 9.9 else 0.0), 10.0, 1, [])
    assert not is_tracked(window(present=lambda time: time < 1.0), 10.0, 1, [])


def test_late_points_and_a_camera_that_does_not_see_are_not_normal():
    before, late, blind = figures(window(), 10.0), window(), window()
    late.points[300:500, 0] += 0.2
    assert abs(normal_since(late, 0.0, 10.0, before) - 5.0) < 0.3
    blind.cameras[200:400] = 'left'
    assert abs(normal_since(blind, 0.0, 10.0, before) - 4.0) < 0.3


def test_normal_since_the_end_of_the_last_disturbance():
    before = figures(window(), 10.0)
    gap = window(present=lambda time: not 2.0 < time < 5.0)
    assert abs(normal_since(gap, 0.0, 10.0, before) - 5.0) < 0.3
    off = window(error=lambda time: 0.1 if 3.0 < time < 4.0 else 0.0, stddev=1.0)
    assert abs(normal_since(off, 0.0, 10.0, before) - 4.0) < 0.3
    assert normal_since(window(seconds=8.0), 0.0, 10.0, before) is None
