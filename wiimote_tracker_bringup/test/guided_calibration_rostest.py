#!/usr/bin/env python3
"""A simulated person calibrates a simulated rig as the program calibrate prompts; the result's
errors agree with its covariance."""

import fcntl
import os
import pty
import queue
import re
import select
import shutil
import struct
import subprocess
import sys
import termios
import threading
import time
import unittest

import numpy as np
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Vector3
from scipy.optimize import least_squares
from sensor_msgs.msg import CameraInfo
from wiimote_tracker_bringup import experiment, scene
from wiimote_tracker_evaluation.recordings.solved_rig import camera_of
from wiimote_tracker_msgs.msg import (BoardStatus, CalibrationVerdict, IrBlobArray,
                                      RigCalibration)
from wiimote_tracker_msgs.srv import (SetLed, SetLedRequest, SolveBoard,
                                      SolveBoardRequest)

CALIBRATE = ['rosrun', 'wiimote_tracker_calibration', 'calibrate']
DEADLINE = 60.0   # [s]
ATTEMPTS = 5
CARRY_SPEED = 5.0  # [m/s]
BOARD_STILL = 6.0  # [s] three cycles of the board
SIGMAS = 4.0
KNOWN_PLACES = ((0.3, 0.3, 0.2), (2.2, 0.3, 0.4), (2.2, 2.2, 0.2), (0.3, 2.2, 1.4),
                (2.2, 0.3, 1.6), (1.2, 1.3, 1.0), (0.4, 0.5, 1.5), (1.9, 2.0, 1.5))
WAVE_SPEED = 1.3  # [m/s]
WAVE_MIDDLE, WAVE_BOX = (1.25, 1.25, 1.2), (2.3, 2.3, 2.1)  # [m]
# Square root of the 99.9 % and 0.1 % quantiles of chi-squared / degrees of freedom, for three
# degrees: the fewest possible, when the errors of all places are fully correlated.
LARGEST, SMALLEST = 2.33, 0.09


class Program:
    """calibrate --plain, used as a person would."""

    def __init__(self, *arguments):
        self._process = subprocess.Popen(CALIBRATE + ['--plain'] + list(arguments),
                                         stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                         stderr=subprocess.STDOUT, text=True)
        self._lines = queue.Queue()
        self.heard = []
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self._process.stdout:
            self._lines.put(line.rstrip('\n'))
        self._lines.put(None)

    def type(self, line):
        self._process.stdin.write(line + '\n')
        self._process.stdin.flush()

    def expect(self, pattern):
        """The next line that matches the pattern; None stands for the end."""
        end = time.monotonic() + DEADLINE
        while True:
            try:
                line = self._lines.get(timeout=max(end - time.monotonic(), 0.0))
            except queue.Empty:
                raise AssertionError('no "%s" within %.0f s of:\n%s' % (
                    pattern, DEADLINE, '\n'.join(self.heard)))
            if line is None:
                raise AssertionError('it ended without "%s":\n%s' % (pattern,
                                                                     '\n'.join(self.heard)))
            self.heard.append(line)
            if re.search(pattern, line):
                return line

    def end(self):
        """Exit status."""
        self._process.stdin.close()
        return self._process.wait(DEADLINE)


class Screen:
    """calibrate on a terminal of 80 x 24."""

    def __init__(self, *arguments):
        self._terminal, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack('HHHH', 24, 80, 0, 0))
        self._process = subprocess.Popen(CALIBRATE + list(arguments),
                                         stdin=slave, stdout=slave, stderr=slave,
                                         env=dict(os.environ, TERM='xterm'), start_new_session=True)
        os.close(slave)
        self.seen = ''

    def type(self, text):
        os.write(self._terminal, text.encode())

    def expect(self, pattern):
        end = time.monotonic() + DEADLINE
        while not re.search(pattern, self.seen):
            if time.monotonic() > end:
                raise AssertionError(f'no "{pattern}" on the screen: {self.seen[-4000:]!r}')
            if select.select([self._terminal], [], [], 0.1)[0]:
                try:
                    text = os.read(self._terminal, 65536).decode(errors='replace')
                except OSError:
                    raise AssertionError(f'it ended without "{pattern}": {self.seen[-4000:]!r}')
                # Moves of the cursor separate words that were drawn at different times.
                self.seen += re.sub(r'\x1b\[[0-9;?]*[A-Za-z]|\x1b\([A-Z]', ' ', text)

    def end(self):
        return self._process.wait(DEADLINE)


def ask(program, line, answer):
    """Repeats a refused command, as the refusal advises: on a slow computer the LED may still be
    moving in the images, or a driver late. @return the number of refusals."""
    for refused in range(ATTEMPTS):
        program.type(line)
        if 'refused' not in program.expect(f'^({answer}|refused)'):
            return refused
    raise AssertionError('\n'.join(program.heard))


def triangulated(cameras, pixels):
    """The point with the least reprojection error [m]. cameras: CameraCalibration."""
    def residuals(place):
        return np.concatenate([camera_of(camera).project(place)[0] - pixel
                               for camera, pixel in zip(cameras, pixels)])
    return least_squares(residuals, [1.25, 1.25, 1.0], method='lm').x


class GuidedCalibration(unittest.TestCase):
    """The rig is calibrated and saved once; each case begins and ends with a saved rig."""

    @classmethod
    def setUpClass(cls):
        rospy.init_node('guided_calibration_rostest')
        cls.rig_file = rospy.get_param('~rig_file')
        cls.scene = scene.read_scene(os.path.join(
            rospkg.RosPack().get_path('wiimote_tracker_bringup'), 'simulation/paper_rig.yaml'))
        rospy.wait_for_service('simulation/set_led', DEADLINE)
        cls.set_led = staticmethod(rospy.ServiceProxy('simulation/set_led', SetLed))
        cls.wait_for_cameras()
        cls.calibrate()
        cls.rig = rospy.wait_for_message('calibration/rig', RigCalibration, DEADLINE)
        cls.verdict = rospy.wait_for_message('calibration/verdict', CalibrationVerdict, DEADLINE)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(os.path.dirname(cls.rig_file), ignore_errors=True)

    @classmethod
    def led(cls, led='led', on=True, target=None, motion=SetLedRequest.HOLD, **more):
        """Switches or moves an LED; returns when it has arrived."""
        request = SetLedRequest(led=led, on=on, motion=motion, **more)
        if target is not None:
            request.target.x, request.target.y, request.target.z = target
        response = cls.set_led(request)
        assert response.success, response.message
        while rospy.get_time() < response.arrival.to_sec() + 0.1:
            rospy.sleep(0.01)

    @classmethod
    def carry(cls, target):
        cls.led(target=target, motion=SetLedRequest.LINE, speed=CARRY_SPEED)

    @classmethod
    def wave(cls, path):
        cls.led(target=WAVE_MIDDLE, motion=SetLedRequest.WAVE, speed=WAVE_SPEED,
                box=Vector3(*WAVE_BOX), path=path)

    @classmethod
    def wait_for_cameras(cls):
        """Waits until all drivers deliver, with a program of its own, which may fail: before that,
        calibrate asks to wait. It does not print a refusal again that is its last line, so the
        images are waited for first."""
        cls.carry(experiment.CORNERS[0])
        program = Program()
        program.expect('Switch the LED off.*The word connection goes on without')
        for camera in cls.scene.cameras:
            rospy.wait_for_message(camera.name + '/ir_blobs', IrBlobArray, DEADLINE)
        end = time.monotonic() + DEADLINE
        program.type('connection')
        while 'all 4 cameras' not in program.expect('see exactly one spot|refused: '):
            assert time.monotonic() < end, program.heard
            program.type('connection')
        program.end()

    @classmethod
    def calibrate(cls):
        """From the lamps to the saved rig. Leaves the number of refusals, what the program said,
        and its exit status."""
        cls.led('lamp', on=True)  # a lamp that was left on
        cls.led(on=False)
        program = Program('--side', f'{experiment.SIDE:g}')
        program.expect('The word next: start with 2.5 m')
        program.type('masks')
        program.expect('Switch the LED on')
        cls.led(on=True)
        cls.refused = ask(program, 'next', 'all 4 cameras see exactly one spot')
        program.expect('next: .*The word next: start with 2.5 m')
        program.type('next')
        for number, place in enumerate(experiment.placed_corners(1), 1):
            program.expect(f'Put the LED on corner {number}')
            cls.carry(place)
            cls.refused += ask(program, 'next', f'corner {number} captured by 4')
        program.expect('The word next: begin the wave')
        cls.wave(path=1)
        program.type('next')
        program.expect('Wave through the whole volume')
        program.type(f'wait {DEADLINE:g}')
        program.type('next')
        program.expect('The word next: solve')
        program.type('next')
        program.expect('next: Read the verdict')
        program.type('next')
        program.expect('The rig is calibrated')
        program.type('quit')
        print(program.expect('Calibrated and saved in'))
        cls.heard, cls.exit_status = program.heard, program.end()

    def test_saves_the_waved_rig(self):
        self.assertEqual(self.exit_status, 1 if self.refused else 0, self.heard)
        self.assertTrue(os.path.exists(self.rig_file))
        self.assertEqual(self.verdict.rig_id, self.rig.id)
        self.assertIn('wave', self.rig.method)
        self.assertEqual([len(camera.masks) for camera in self.rig.cameras], [1] * 4)

    def test_errors_are_as_foretold(self):
        by_name = {camera.name.strip('/'): camera for camera in self.rig.cameras}
        self.assertEqual(set(by_name), {camera.name for camera in self.scene.cameras})
        self.assertEqual(len(self.verdict.predicted_at), 8)
        ratios = []
        for at, sigma in zip(self.verdict.predicted_at, self.verdict.predicted_stddev):
            place = np.array([at.x, at.y, at.z])
            pixels = [camera.project(place)[0] for camera in self.scene.cameras]
            measured = triangulated([by_name[camera.name] for camera in self.scene.cameras], pixels)
            error = np.linalg.norm(measured - place)
            ratios.append(error / sigma)
            print('(%.2f, %.2f, %.2f): %.1f mm off, %.1f mm foretold' % (
                tuple(place) + (1e3 * error, 1e3 * sigma)))
        rms = np.sqrt(np.mean(np.square(ratios)))
        self.assertLess(rms, LARGEST)
        self.assertGreater(rms, SMALLEST)

    def test_checks_a_place_on_the_screen(self):
        """With keys."""
        self.carry((1.25, 1.25, 1.0))
        screen = Screen()
        screen.expect('wiimote_4')
        screen.type('c')
        screen.expect('Where is the LED')
        screen.seen = ''  # the rig's message has distances, too
        screen.type('1.25 1.25 1.0\n')
        screen.expect(r'\d mm from')
        screen.type('q')
        self.assertEqual(screen.end(), 0)

    def test_corrects_the_volume(self):
        program = Program()
        program.expect('The rig is calibrated')
        program.type('fit')
        program.expect('^refused: ')
        for number, place in enumerate(KNOWN_PLACES, 1):
            self.carry(place)
            ask(program, 'place %g %g %g' % place, f'place {number} measured at')
        ask(program, 'fit affine', r'the volume is corrected \(affine\)')
        self.carry((1.25, 1.25, 1.0))
        ask(program, 'check 1.25 1.25 1.0', 'measured')
        self.save(program)

    def test_recalibrates_a_camera(self):
        program = Program()
        program.expect('The rig is calibrated')
        self.wave(path=2)
        ask(program, 'recalibrate wiimote_2 8', 'wiimote_2')
        program.type(f'join {self.rig_file}')
        program.expect('^refused: all cameras of the second rig are in the first')
        self.save(program)

    def save(self, program):
        """As the other cases expect."""
        program.type('save')
        program.expect('The rig is calibrated')
        program.end()

    def test_solves_a_lens_by_the_board_on_the_screen(self):
        """calibrate --board, from the first view to the driver's new lens."""
        self.led(on=False)
        views = []
        rospy.Subscriber('calibration/board', BoardStatus,
                         lambda board: views.append((board.views, len(board.missing))))
        screen = Screen('--board', 'wiimote_1')
        screen.expect('Hold the 16-LED board in front of wiimote_1')
        screen.type(' ')
        # The screen draws changes only.
        screen.expect('board still for two seconds')
        self.show_board_until_enough(views)
        screen.expect('solves the lens')
        screen.type(' ')
        screen.expect('saves the lens')
        screen.type(' ')
        screen.expect('driver has it')
        screen.type('q')
        self.assertEqual(screen.end(), 0)
        self.led('board', on=False)
        self.led(on=True)
        while True:  # the driver's next images
            info = rospy.wait_for_message('wiimote_1/camera_info', CameraInfo, DEADLINE)
            if info.K[0] > 0.0:
                break
        # The views are still stored: the same lens again, and one with the simulated lens's model.
        # OpenCV's threads add up the views in any order, so the last digits differ.
        solve = rospy.ServiceProxy('calibration/board/solve', SolveBoard)
        np.testing.assert_allclose(info.K, solve(SolveBoardRequest.AUTOMATIC).camera_info.K,
                                   atol=1e-6)  # [px]
        lens = solve(SolveBoardRequest.K1)
        self.assertTrue(lens.success, lens.message)
        truth = self.scene.cameras[0].parameters
        for measured, true, sigma in zip((lens.camera_info.K[0], lens.camera_info.K[4]), truth,
                                         lens.stddev):
            print(f'focal length {measured:.1f} +- {sigma:.1f} px, truly {true:.1f} px')
            self.assertLess(abs(measured - true), SIGMAS * sigma)

    def show_board_until_enough(self, views):
        """One pose after the other; a slow computer gets more of them."""
        end = time.monotonic() + 2 * DEADLINE
        pose = 0
        while not views or views[-1][0] == 0 or views[-1][1] > 0:
            self.assertLess(time.monotonic(), end, views)
            pose += 1
            self.led('board', motion=SetLedRequest.SHOW, path=pose)
            before = views[-1][0] if views else 0
            still = time.monotonic() + BOARD_STILL
            while time.monotonic() < still and not (views and views[-1][0] > before):
                time.sleep(0.05)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'guided_calibration', GuidedCalibration))
