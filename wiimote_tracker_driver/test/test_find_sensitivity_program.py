"""What find_sensitivity does when something fails, without a driver."""

import io
import os
import re
import signal
import subprocess
import sys
import threading
import time
import types

import pytest
import rospy

from conftest import SCRIPTS, load

program = load('find_sensitivity')


def test_without_a_master_it_ends_with_what_to_do():
    done = subprocess.run([sys.executable, os.path.join(SCRIPTS, 'find_sensitivity'), 'room'],
                          timeout=60, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True,
                          env=dict(os.environ, ROS_MASTER_URI='http://localhost:1'))
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr == ('find_sensitivity: there is no ROS master at http://localhost:1: start '
                           'the driver with roslaunch\n')


def test_every_sensitivity_of_the_driver_is_tried():
    with open(os.path.join(SCRIPTS, '../config/driver.yaml')) as file:
        names = re.search(r'\[(wii_1, .*), custom\]', file.read()).group(1)
    assert sorted(program.LEVELS) == sorted(names.split(', '))


class FakeCamera:
    """Stands in for the driver; `watched` is called for its images."""

    def __init__(self, watched=lambda: [[]]):
        self.sensitivity = 'wii_2'
        self._watched = watched

    def set_sensitivity(self, name):
        self.sensitivity = name

    def watch(self, settle, seconds):
        return self._watched()


@pytest.fixture
def run(monkeypatch):
    def run(camera, answers):
        monkeypatch.setattr(program, 'master_problem', lambda _: '')
        monkeypatch.setattr(program, 'Camera', lambda name: camera)
        monkeypatch.setattr(program.rospy, 'init_node', lambda *_, **__: None)
        monkeypatch.setattr(sys, 'argv', ['find_sensitivity', 'room'])
        monkeypatch.setattr(sys, 'stdin', io.StringIO(answers))
        return program.main()
    before = {number: signal.getsignal(number)
              for number in (signal.SIGHUP, signal.SIGINT, signal.SIGTERM)}
    # Where the tests run in the background, a shell has Ctrl-C ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield run
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize('answers', ['', '\n'])
def test_the_end_of_the_input_is_said_and_the_driver_left_as_it_was(run, capsys, answers):
    camera = FakeCamera()
    assert run(camera, answers) == 1
    assert 'the input has ended' in capsys.readouterr().err
    assert camera.sensitivity == 'wii_2'


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGHUP, signal.SIGTERM])
def test_a_signal_leaves_the_driver_as_it_was(run, number):
    def watched():
        os.kill(os.getpid(), number)
        time.sleep(10.0)
    camera = FakeCamera(watched)
    assert run(camera, '\n') == 130
    assert camera.sensitivity == 'wii_2'


@pytest.mark.parametrize('number', [signal.SIGHUP, signal.SIGTERM])
def test_further_signals_do_not_keep_the_driver_from_being_restored(run, number):
    class Camera(FakeCamera):
        is_interrupted = False

        def watch(self, settle, seconds):
            self.is_interrupted = True
            os.kill(os.getpid(), number)
            time.sleep(10.0)

        def set_sensitivity(self, name):
            if self.is_interrupted:
                os.kill(os.getpid(), number)
            super().set_sensitivity(name)

    camera = Camera()
    assert run(camera, '\n') == 130
    assert camera.sensitivity == 'wii_2'


@pytest.mark.parametrize('error', [
    rospy.ServiceException('no service'), rospy.exceptions.TransportTerminated('broken pipe'),
    ConnectionResetError('reset by peer')])
def test_a_driver_that_ends_meanwhile_is_named(error):
    def update_configuration(changes):
        raise error
    camera = program.Camera.__new__(program.Camera)
    camera._driver = types.SimpleNamespace(update_configuration=update_configuration)
    with pytest.raises(program.SensitivityError, match='does not take sensitivity wii_3'):
        camera.set_sensitivity('wii_3')


def test_a_step_of_the_clock_does_not_prolong_a_measurement():
    camera = program.Camera.__new__(program.Camera)
    camera._name, camera._images, camera._changed = '/room', None, threading.Condition()
    done = threading.Event()

    def send():
        for second in range(1000, 0, -1):
            if done.wait(0.01):
                return
            camera._on_image(types.SimpleNamespace(arrival=rospy.Time(second), blobs=[]))
    sender = threading.Thread(target=send)
    sender.start()
    try:
        # By the stamps it would wait until no more images come, and raise an error.
        assert camera.watch(settle=0.05, seconds=0.1)
    finally:
        done.set()
        sender.join()
