#!/usr/bin/env python3
"""A simulated person switches blinking LEDs as `evaluate --live` prompts, on a terminal."""

import json
import os
import pty
import shutil
import subprocess
import tempfile
import threading
import unittest

import rospy
import rostest
import yaml
from evaluate_live_rostest import DEADLINE, Person
from wiimote_tracker_evaluation import scene, true_rig
from wiimote_tracker_evaluation.live.identification import LABEL_TIMEOUT, QUICK_TRIES
from wiimote_tracker_msgs.msg import RigCalibration, TrackedPointArray
from wiimote_tracker_msgs.srv import SetLedRequest

EVALUATE = ['rosrun', 'wiimote_tracker_bringup', 'evaluate', '--live', '--quick', '--sections',
            'identification', '--output']
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


class EvaluateLiveBlinking(unittest.TestCase):

    def test_blinking_leds_are_switched_and_get_their_names(self):
        rospy.init_node('evaluate_live_rostest')
        path = rospy.get_param('~description')
        with open(path) as file:
            description = yaml.safe_load(file)
        rig = true_rig.true_rig(scene.read_scene(path), {
            name: camera['identity'] for name, camera in description['cameras'].items()})
        publisher = rospy.Publisher('calibration/rig', RigCalibration, queue_size=1, latch=True)
        publisher.publish(rig)
        rospy.wait_for_message('points', TrackedPointArray, DEADLINE)

        output = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, output)
        terminal, other_end = pty.openpty()
        process = subprocess.Popen(EVALUATE + [output], stdin=other_end, stdout=other_end,
                                   stderr=other_end)
        os.close(other_end)
        self.addCleanup(process.kill)
        said = Switcher(terminal, list(description['leds'])).obey(process)
        self.assertEqual(process.returncode, 0, said[-2000:])

        with open(os.path.join(output, 'figures.json')) as file:
            figures = {figure['name']: figure for figure in json.load(file)['figures']}
        self.assertTrue(all(figure['simulated'] for figure in figures.values()))
        self.assertEqual((figures['live_success']['value'], figures['live_success']['samples']),
                         (100.0, QUICK_TRIES))
        self.assertGreater(figures['live_time']['value'], 0.0)
        self.assertLess(figures['live_time']['value'], LABEL_TIMEOUT)


if __name__ == '__main__':
    rostest.rosrun('wiimote_tracker_bringup', 'evaluate_live_blinking', EvaluateLiveBlinking)
