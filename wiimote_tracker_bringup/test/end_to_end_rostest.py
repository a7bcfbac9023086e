#!/usr/bin/env python3
"""From HID reports to points: a simulated rig is calibrated by its four corners and measures.

How well it may do is what the bound says for this rig: the placement of the corners and the lenses
are one draw (fixed seeds), so the measured RMS must lie below the upper end of the range that holds
95 % of all draws.
"""

import os
import shutil
import sys
import unittest

import numpy as np
import rospkg
import rospy
import rostest
from wiimote_tracker_evaluation import alignment, bound, experiment, scene, scoring
from wiimote_tracker_evaluation.conductor import Conductor
from wiimote_tracker_evaluation.recording import LiveRecorder

DWELL = 0.5  # [s]
RATE = 100.0  # images a second of one camera [Hz]
TEST_POINTS = experiment.TEST_POINTS[[0, 2, 5, 7, 9]]
ALIGNMENT_POINTS = experiment.alignment_points(2, 8)


class EndToEnd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('end_to_end_rostest')
        cls.rig_file = rospy.get_param('~rig_file')
        cls.scene = scene.read_scene(os.path.join(
            rospkg.RosPack().get_path('wiimote_tracker_bringup'), 'simulation/paper_rig.yaml'))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(os.path.dirname(cls.rig_file), ignore_errors=True)

    def test_calibrated_by_four_corners_it_measures_as_well_as_can_be(self):
        recorder = LiveRecorder('led')
        conductor = Conductor('led', recorder)
        conductor.wait_for_cameras([camera.name for camera in self.scene.cameras])
        checked = conductor.check_connection(0.5)
        self.assertTrue(checked.success, checked.message)

        conductor.start(experiment.SIDE)
        samples = []
        for place in experiment.placed_corners(1):
            result = conductor.capture(place, 5.0)
            samples += [camera.samples[result.corner] for camera in result.cameras]
        self.assertEqual(len(samples), 16)
        rig = conductor.solve().rig
        self.assertEqual(len(rig.cameras), 4)
        conductor.save()
        self.assertTrue(os.path.exists(self.rig_file))

        segments = [conductor.dwell('test', 'P%d' % i, place, 5.0, DWELL)
                    for i, place in enumerate(TEST_POINTS)]
        segments += [conductor.dwell('alignment', 'A%d' % i, place, 5.0, DWELL)
                     for i, place in enumerate(ALIGNMENT_POINTS)]
        recording = recorder.recording()
        score = scoring.score(recording, segments)

        bounds = bound.position_bounds(self.scene, experiment.CORNERS, TEST_POINTS,
                                       ALIGNMENT_POINTS, min(samples), DWELL * RATE, DWELL * RATE)
        for kind in alignment.KINDS:
            rospy.loginfo('%s: %.2f mm, bound %.2f mm, 95 %% below %.2f mm', kind,
                          1e3 * score.position_rms[kind], 1e3 * bounds[kind].rms,
                          1e3 * bounds[kind].high)
            self.assertLess(score.position_rms[kind], bounds[kind].high, kind)
            self.assertGreater(score.position_rms[kind], 0.0)

        # A single frame scatters as its four pixels do.
        expected = []
        for point in TEST_POINTS:
            calibration = np.zeros((4 * bound.PER_CAMERA,) * 2)
            _, covariance = bound.point_sensitivity(self.scene, calibration, point, 1)
            expected.append(np.trace(covariance))
        ratio = score.scatter / np.sqrt(np.mean(expected))
        self.assertGreater(ratio, 0.7)
        self.assertLess(ratio, 1.3)

        # All cameras took part in the points.
        inside = recording.between(segments[0].start, segments[0].end)
        self.assertEqual(int(np.median(recording.rays[inside])), 4)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'end_to_end', EndToEnd))
