"""Interpolation between samples, and where there is none."""

import numpy as np

from wiimote_tracker_bringup import timeseries

TIMES = np.array([0.0, 1.0, 2.0, 5.0])


def test_values_of_any_shape_are_interpolated():
    values = np.stack([TIMES, -TIMES], axis=1)
    found = timeseries.at(TIMES, values, [-1.0, 0.5, 4.0, 9.0])
    assert found.tolist() == [[0.0, 0.0], [0.5, -0.5], [4.0, -4.0], [5.0, -5.0]]
    assert timeseries.at(TIMES, np.ones((4, 3, 2)), [0.5]).shape == (1, 3, 2)
    assert timeseries.at(TIMES, np.ones((4, 3, 2)), []).shape == (0, 3, 2)


def test_gaps_and_ends_are_not_covered():
    wanted = np.array([-0.1, 0.0, 0.5, 2.0, 2.5, 5.0, 5.1])
    assert timeseries.covers(TIMES, wanted, 1.0).tolist() == [
        False, True, True, True, False, False, False]
    assert timeseries.covers(TIMES, wanted, 3.0).tolist() == [
        False, True, True, True, True, True, False]


def test_the_nearest_sample_may_be_before_or_after():
    assert timeseries.to_nearest(np.array([-1.0, 0.25, 4.0, 6.0]), TIMES).tolist() == [
        1.0, 0.25, 1.0, 1.0]
