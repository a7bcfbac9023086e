#!/usr/bin/env python3
"""A simulated person follows the prompts of `evaluate --live` on a terminal, with the LED of a
simulated rig; the report's figures are compared with expected ones."""

import json
import os
import pty
import re
import select
import shutil
import subprocess
import tempfile
import threading
import unittest

import numpy as np
import rosgraph
import rospy
import rostest
from point_bounds import point_bound
from std_msgs.msg import Header
from wiimote_tracker_bringup import experiment, scene
from wiimote_tracker_bringup.true_rig import publish, true_rig
from wiimote_tracker_msgs.msg import IrBlobArray, TrackedPointArray
from wiimote_tracker_msgs.srv import SetLed, SetLedRequest

EVALUATE = ['rosrun', 'wiimote_tracker_bringup', 'evaluate', '--live', '--quick', '--sections']
DEADLINE = 150.0                   # [s]
SPEED = 4.0                        # of the hand [m/s]
CHOSEN = (1, 10)                   # of the ten points; the others are skipped
LAP_CENTRE, LAP_RADIUS, LAP_SPEED = (1.25, 1.25, 0.5), 0.4, 4.0  # [m], [m], [m/s]
RADIUS, CIRCLE_SPEED = 0.75, 1.5   # of the circle [m], [m/s]
CURRENT, DISTANCE = 560.0, 10.0    # [mA], [m]
SIGMAS = 4.0


class Person:
    """Reads the terminal, moves the LED, types."""

    def __init__(self, terminal):
        self._terminal = terminal
        rospy.wait_for_service('simulation/set_led', DEADLINE)
        self._service = rospy.ServiceProxy('simulation/set_led', SetLed)
        self._trigger = rospy.Publisher('trigger', Header, queue_size=10)
        self._images = 0
        self._walks = 0
        self.ages = []      # age of the newest point at each trigger [s]
        self.readers = set()  # nodes that subscribe to the simulation's truth
        self._points = []   # stamp and arrival [s]
        rospy.Subscriber('points', TrackedPointArray, self._on_points)
        rospy.Subscriber('wiimote_1/ir_blobs', IrBlobArray, self._on_image)
        self._does = (
            (r'(\d+)  Put the LED at x = (\S+) m, y = (\S+) m, z = (\S+) m\.', self.place),
            (r'Waiting for \d+ laps', self.laps),
            (r'Its radius in metres.*?: ', self.circle),
            (r'Name of that camera.*?: ', lambda: self.type('wiimote_1')),
            (r'Current through the LED.*?: ', self.current),
            (r'Start near the LED', self.walk),
            (r'Distance to the LED in metres.*?: ', self.distance),
            (r'Labels of the LEDs.*?: ', lambda: self.type('')))

    def _on_points(self, message):
        if message.points:
            self._points.append((message.header.stamp.to_sec(), rospy.get_time()))

    def _on_image(self, message):
        self._images += bool(message.blobs)

    def obey(self, process):
        """Follows the prompts until the program has ended; returns its output."""
        text, done = '', 0
        deadline = rospy.get_time() + DEADLINE
        while process.poll() is None:
            if rospy.get_time() > deadline:
                raise AssertionError('the program waits for something: ' + text[-500:])
            if not select.select([self._terminal], [], [], 0.05)[0]:
                continue
            try:
                text += os.read(self._terminal, 4096).decode()
            except OSError:  # the program has ended
                break
            while True:
                found = [(match.end(), match, action) for pattern, action in self._does
                         for match in [re.compile(pattern).search(text, done)] if match]
                if not found:
                    break
                done, match, action = min(found, key=lambda each: each[0])
                action(*match.groups())
        process.wait()
        return text

    def type(self, text):
        os.write(self._terminal, (text + '\n').encode())

    def _set_led(self, **request):
        target = request.pop('target')
        self.readers |= {node for topic, nodes in rosgraph.Master('/person').getSystemState()[1]
                         if topic.startswith('/simulation/') for node in nodes}
        message = SetLedRequest(led='led', **request)
        message.target.x, message.target.y, message.target.z = target
        answer = self._service(message)
        assert answer.success, answer.message
        return answer.arrival.to_sec()

    @staticmethod
    def _until(time):
        while rospy.get_time() < time:
            rospy.sleep(0.005)

    # --- Tasks

    def place(self, number, *position):
        if int(number) not in CHOSEN:
            self.type('s')
            return
        self._set_led(on=True, motion=SetLedRequest.LINE, speed=SPEED,
                      target=[float(each) for each in position])

    def laps(self):
        threading.Thread(target=self._count_laps, daemon=True).start()

    def _count_laps(self):
        first = self._set_led(on=True, motion=SetLedRequest.CIRCLE, target=LAP_CENTRE,
                              speed=LAP_SPEED, radius=LAP_RADIUS)
        for lap in range(1, 10):
            crossing = first + lap * 2.0 * np.pi * LAP_RADIUS / LAP_SPEED
            self._until(crossing)
            self._trigger.publish(Header(stamp=rospy.Time.from_sec(crossing)))
            # Among all: after a pause of this program, the last ones were heard after the crossing.
            self.ages.append(crossing - max(stamp for stamp, heard in list(self._points)
                                            if heard <= crossing))

    def circle(self):
        self._until(self._set_led(on=True, motion=SetLedRequest.CIRCLE, target=(1.25, 1.25, 0.95),
                                  speed=CIRCLE_SPEED, radius=RADIUS))
        rospy.sleep(0.1)
        self.type(f'{RADIUS:g}')

    def current(self):
        self._walks += 1
        self.type(f'{CURRENT:g}' if self._walks == 1 else '')

    def walk(self):
        self._set_led(on=True, motion=SetLedRequest.CIRCLE, target=(1.25, 1.25, 1.0), speed=0.5,
                      radius=0.1)
        begin = self._images
        while self._images < begin + 30:
            rospy.sleep(0.01)
        self._set_led(on=False, motion=SetLedRequest.HOLD, target=(0.0, 0.0, 0.0))

    def distance(self):
        self._set_led(on=True, motion=SetLedRequest.HOLD, target=(0.0, 0.0, 0.0))
        self.type(f'{DISTANCE:g}')


class LiveEvaluation(unittest.TestCase):
    """The tracker has the true rig of the file ~description."""

    def setUp(self):
        rospy.init_node('evaluate_live_rostest')
        self.path = rospy.get_param('~description')
        rig = true_rig(self.path)
        rig.square_sides = [experiment.SIDE, experiment.SIDE]
        self.publisher = publish(rig)
        rospy.wait_for_message('points', TrackedPointArray, DEADLINE)

    def evaluate(self, sections, person_at):
        """The person, and the figures by section and name. person_at: makes one for a terminal."""
        output = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, output)
        terminal, other_end = pty.openpty()
        process = subprocess.Popen(EVALUATE + [sections, '--output', output], stdin=other_end,
                                   stdout=other_end, stderr=other_end)
        os.close(other_end)
        self.addCleanup(process.kill)
        person = person_at(terminal)
        said = person.obey(process)
        self.assertEqual(process.returncode, 0, said[-2000:])
        with open(os.path.join(output, 'figures.json')) as file:
            content = json.load(file)
        for each in [content] + content['figures']:
            self.assertTrue(each['simulated'],
                            'the remotes are virtual, and the report must say so')
        return person, {(each['section'], each['name']): each for each in content['figures']}


class EvaluateLive(LiveEvaluation):
    def test_a_person_is_guided_to_a_report(self):
        person, figures = self.evaluate('distance,latency,identification,positions,circles', Person)
        self.assertEqual(person.readers, set(),
                         'neither the tracker nor the evaluation knows the truth')

        def value(section, name):
            return figures[section, name]['value']
        # The mean over a place is better than one image's point, to which the bound applies.
        places = experiment.TEST_POINTS[[number - 1 for number in CHOSEN]]
        described = scene.read_scene(self.path)
        bound = 1e3 * point_bound(described.cameras, described.effective_noise(), places)
        self.assertEqual(figures['positions', 'live_rms']['samples'], len(CHOSEN))
        self.assertLess(value('positions', 'live_largest'), SIGMAS * bound)
        self.assertGreater(value('positions', 'live_rms'), 0.0)
        self.assertLess(value('circles', 'live_radial'), SIGMAS * bound)
        self.assertLess(value('circles', 'live_height'), SIGMAS * bound)
        self.assertAlmostEqual(value('circles', 'live_speed'), CIRCLE_SPEED, delta=0.1)
        # The latency by the angle, compared with the age of the newest point known to another
        # process. On a busy computer the two receive it at different times.
        spread = 1e3 * np.std(person.ages) / np.sqrt(len(person.ages))
        self.assertAlmostEqual(value('latency', 'live_mean'), 1e3 * np.mean(person.ages),
                               delta=SIGMAS * spread + 5.0)
        self.assertGreater(value('latency', 'live_least'), 0.0)
        self.assertEqual(value('distance', 'live_560_mA'), DISTANCE)


if __name__ == '__main__':
    rostest.rosrun('wiimote_tracker_bringup', 'evaluate_live', EvaluateLive)
