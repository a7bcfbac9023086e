"""The conductor measures an LED that is at rest, also where stamps are late."""

import pytest

from wiimote_tracker_bringup.conductor import SETTLE, Conductor
from wiimote_tracker_evaluation.demo.published import LiveRecorder

ARRIVAL, SPEED = 100.0, 1.0  # [s], [m/s]


class LateRecorder(LiveRecorder):
    """Gets a point of an LED every 4 ms, with a stamp that is late."""

    def __init__(self, delay):
        self._points, self._delay, self.newest_stamp = [], delay, ARRIVAL - 0.5

    def receive(self):
        self.newest_stamp += 0.004
        away = SPEED * max(0.0, ARRIVAL - (self.newest_stamp - self._delay))
        self._points.append((self.newest_stamp, away, 0.0, 0.0, 0.0, 0.0, 0.0, 4, 0.0))


@pytest.mark.parametrize('delay', [0.0, 0.3])
def test_a_place_is_measured_when_the_points_are_at_rest(delay):
    recorder = LateRecorder(delay)
    conductor = Conductor.__new__(Conductor)  # without a master
    conductor._recorder = recorder
    conductor.move = lambda place, speed: ARRIVAL

    def wait(condition, *_):
        while not condition():
            recorder.receive()
    conductor.wait = wait
    segment = conductor.dwell('test', 'P1', (0.0, 0.0, 0.0), SPEED, 0.5)
    assert segment.start == pytest.approx(ARRIVAL + delay + SETTLE, abs=0.03)
    assert segment.start >= ARRIVAL + SETTLE
    assert segment.end == pytest.approx(segment.start + 0.5)
