#!/usr/bin/env python3
"""A simulated person switches blinking LEDs as `evaluate --live` prompts, on a terminal."""

import threading

import rospy
import rostest
from evaluate_live_rostest import LiveEvaluation, Person
from wiimote_tracker_bringup.files import read_yaml
from wiimote_tracker_evaluation.live.identification import LABEL_TIMEOUT, QUICK_TRIES
from wiimote_tracker_msgs.srv import SetLedRequest

DARK = 0.6  # time without points after which the LEDs count as off [s]


class Switcher(Person):
    """Switches all LEDs; they move by themselves."""

    def __init__(self, terminal, leds):
        super().__init__(terminal)
        self._leds = leds
        self._does = (
            (r'Labels of the LEDs.*?: ', lambda: self.type(', '.join(leds))),
            (r'Switch all LEDs off; then on', self.off_and_on))

    def off_and_on(self):
        threading.Thread(target=self._off_and_on, daemon=True).start()

    def _off_and_on(self):
        self._switch(False)
        off = rospy.get_time()
        while rospy.get_time() < max([off] + [heard for _, heard in self._points[-1:]]) + DARK:
            rospy.sleep(0.01)
        self._switch(True)

    def _switch(self, on):
        for led in self._leds:
            answer = self._service(SetLedRequest(led=led, on=on, motion=SetLedRequest.HOLD))
            assert answer.success, answer.message


class EvaluateLiveBlinking(LiveEvaluation):
    def test_blinking_leds_are_switched_and_get_their_names(self):
        leds = list(read_yaml(self.path)['leds'])
        _, figures = self.evaluate('identification', lambda terminal: Switcher(terminal, leds))
        success, time = (figures['identification', name] for name in ('live_success', 'live_time'))
        self.assertEqual((success['value'], success['samples']), (100.0, QUICK_TRIES))
        self.assertGreater(time['value'], 0.0)
        self.assertLess(time['value'], LABEL_TIMEOUT)


if __name__ == '__main__':
    rostest.rosrun('wiimote_tracker_bringup', 'evaluate_live_blinking', EvaluateLiveBlinking)
