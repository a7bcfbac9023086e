"""master_watch tells of a master that is gone or was started again, and makes way for the next."""

import os
import shutil
import subprocess
import sys

import pytest
import rosbag
import rosgraph
from wiimote_tracker_msgs.msg import RigCalibration, ZoneEvent

from wiimote_tracker_bringup.processes import Processes, free_port
from wiimote_tracker_bringup.waiting import wait_until

WATCH = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../launch/master_watch')
REPLAY = os.path.join(os.path.dirname(WATCH), 'replay.launch')
CHECK_REPLAY = os.path.join(os.path.dirname(WATCH), 'check_replay')
PATIENCE = 60.0  # on a busy computer [s]

# Stands in for roslaunch, which its master_watch ends.
LAUNCHER = 'import subprocess, sys; subprocess.call([sys.executable] + sys.argv[1].split("|"))'


class Programs:
    """Starts programs on a master of their own, that of ROS_MASTER_URI."""

    def __init__(self, folder, port):
        self._launcher = folder / 'roslaunch'
        self._launcher.write_text(LAUNCHER)
        self.output = folder / 'output'
        self._port = port
        self.processes = Processes()

    def master(self):
        return self.processes.start_master(self._port, str(self.output), PATIENCE)

    def watch(self, *arguments, parameters=()):
        """arguments: of its roslaunch; parameters: its own."""
        return self.processes.start(
            'roslaunch', [sys.executable, str(self._launcher), '|'.join((WATCH, *parameters)),
                          *arguments], str(self.output))

    def wait(self, condition):
        wait_until(condition, PATIENCE, self.output.read_text)

    def address(self):
        """Of the watch that the master knows and that has started; None: of none."""
        master = rosgraph.Master('/test')
        try:
            publishers = dict(master.getSystemState()[0]).get('/diagnostics', [])
            return master.lookupNode('/master_watch') if publishers else None
        except (OSError, rosgraph.MasterException):
            return None

    def says(self, word):
        return word in self.output.read_text()


@pytest.fixture
def programs(tmp_path, monkeypatch):
    port = free_port()
    monkeypatch.setenv('ROS_MASTER_URI', f'http://localhost:{port}')
    monkeypatch.setenv('ROS_HOSTNAME', 'localhost')
    monkeypatch.setenv('ROS_HOME', str(tmp_path))
    started = Programs(tmp_path, port)
    yield started
    started.processes.stop_all()


def test_a_master_that_ends_and_comes_back(programs):
    master = programs.master()
    first = programs.watch()
    programs.wait(programs.address)
    assert not programs.says('master')

    master.kill()
    programs.processes.stop(master)
    programs.wait(lambda: programs.says('There is no ROS master'))

    programs.master()
    programs.wait(lambda: programs.says('does not know the nodes'))
    assert first.poll() is None

    programs.watch()
    programs.wait(programs.address)
    second = programs.address()
    programs.wait(lambda: first.poll() is not None)
    assert programs.address() == second


def test_a_replay_beside_the_tracker(programs):
    programs.master()
    programs.watch()
    programs.wait(programs.address)
    rosgraph.Master('/test').setParam('/use_sim_time', True)
    programs.wait(lambda: programs.says('use_sim_time is true, as a replay'))


def test_a_misspelt_argument_is_told(programs):
    programs.master()
    programs.watch('wiimote_tracker_bringup', 'tracker.launch', 'cemeras:=cameras.yaml')
    programs.wait(lambda: programs.says('cemeras:= has no effect: write cameras:='))


def test_parameters_that_nobody_reads_are_told(programs, tmp_path):
    (tmp_path / 'my.yaml').write_text('calibraton: {yaw: 1.0}\n')
    programs.master()
    programs.watch(parameters=(str(tmp_path / 'my.yaml'), 'calibration'))
    programs.wait(lambda: programs.says('no node of this launch file is called "calibraton"'))


# A tracker, for a replay: no recording has this topic.
STATUS = """
import rospy
from wiimote_tracker_msgs.msg import CalibrationStatus
rospy.init_node('calibration')
publisher = rospy.Publisher('calibration/status', CalibrationStatus, queue_size=1)
rospy.spin()
"""


def test_a_replay_is_refused_beside_a_tracker(programs):
    def replay():
        return subprocess.run(['roslaunch', '--nodes', REPLAY, 'bag:=x'], capture_output=True,
                              text=True, timeout=PATIENCE)
    assert replay().returncode == 0, 'without a master'
    programs.master()
    assert replay().returncode == 0, 'without a tracker'
    tracker = programs.processes.start('tracker', [sys.executable, '-c', STATUS, '__ns:=/second'],
                                       str(programs.output))
    master = rosgraph.Master('/test')
    programs.wait(lambda: ['/second/calibration/status', ['/second/calibration']]
                  in master.getSystemState()[0])
    refused = replay()
    assert refused.returncode == 1
    assert ('a tracker runs at this ROS master (/second/calibration) and would take the time of '
            'the replay: end it') in refused.stderr
    master.setParam('/use_sim_time', True)
    assert replay().returncode == 0, 'the tracker is one for the replay'
    master.setParam('/use_sim_time', False)
    tracker.kill()
    programs.processes.stop(tracker)
    assert replay().returncode == 0, 'a killed tracker'


def test_a_bag_is_looked_at_before_its_replay(tmp_path):
    def said(bag, rate='1.0', delay='2.0'):
        done = subprocess.run([sys.executable, CHECK_REPLAY, bag, rate, delay],
                              capture_output=True, text=True, timeout=PATIENCE,
                              env=dict(os.environ, ROS_MASTER_URI='http://:1'))
        assert (done.returncode, done.stdout) in ((0, 'true'), (1, ''))
        return done.returncode, done.stderr
    path, unfinished = str(tmp_path / 'my.bag'), str(tmp_path / 'my.bag.active')
    assert said(path) == (0, ''), 'rosbag says that it is not there'
    for rate in ('0', '-1', 'fast', 'nan', 'inf'):
        assert f'rate:={rate} is no speed: give a number above 0' in said(path, rate)[1]
    for delay in ('-1', 'soon'):
        assert f'delay:={delay} is no time: give seconds' in said(path, '0.5', delay)[1]
    with rosbag.Bag(path, 'w') as bag:
        bag.write('zone_events', ZoneEvent())
    returned, words = said(path)
    assert returned == 0 and f'{path} holds no rig' in words
    with rosbag.Bag(path, 'w') as bag:
        bag.write('lab/calibration/rig', RigCalibration())
        bag.flush()
        shutil.copy(path, unfinished)
    assert said(path) == (0, '')
    returned, words = said(unfinished)
    assert returned == 1 and 'repair it with rosbag reindex' in words
