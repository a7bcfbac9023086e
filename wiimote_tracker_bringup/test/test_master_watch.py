"""master_watch tells of a master that is gone or was started again, and makes way for the next."""

import os
import signal
import subprocess
import sys
import time

import pytest
import rosgraph

from wiimote_tracker_bringup.processes import free_port

HERE = os.path.dirname(os.path.realpath(__file__))
PATIENCE = 60.0  # on a busy computer [s]


# Stands in for roslaunch, which its master_watch ends.
LAUNCHER = 'import subprocess, sys; subprocess.call([sys.executable, sys.argv[1]])'


class Programs:
    """Starts programs on a master of their own."""

    def __init__(self, folder):
        self._launcher = folder / 'roslaunch'
        self._launcher.write_text(LAUNCHER)
        self.output = folder / 'output'
        self._port = free_port()
        self._uri = f'http://localhost:{self._port}'
        self._environment = dict(os.environ, ROS_MASTER_URI=self._uri, ROS_HOSTNAME='localhost',
                                 ROS_HOME=str(folder))
        self._started = []

    def start(self, command):
        with open(self.output, 'ab') as file:
            self._started.append(subprocess.Popen(command, stdout=file, stderr=file,
                                                  env=self._environment, start_new_session=True))
        return self._started[-1]

    def master(self):
        return self.start(['rosmaster', '--core', '-p', str(self._port)])

    def watch(self, *arguments):
        return self.start([sys.executable, str(self._launcher),
                           os.path.join(HERE, '../launch/master_watch'), *arguments])

    def wait(self, condition):
        deadline = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < deadline, self.output.read_text()
            time.sleep(0.05)

    def address(self):
        """Of the watch that the master knows and that has started; None: of none."""
        master = rosgraph.Master('/test', self._uri)
        try:
            publishers = dict(master.getSystemState()[0]).get('/diagnostics', [])
            return master.lookupNode('/master_watch') if publishers else None
        except (OSError, rosgraph.MasterException):
            return None

    def says(self, word):
        return word in self.output.read_text()

    def stop(self):
        for process in self._started:
            try:
                os.killpg(process.pid, signal.SIGKILL)  # with a launcher's child
            except ProcessLookupError:
                pass
            process.wait()


@pytest.fixture
def programs(tmp_path):
    started = Programs(tmp_path)
    yield started
    started.stop()


def test_a_master_that_ends_and_comes_back(programs):
    master = programs.master()
    programs.wait(lambda: rosgraph.is_master_online(programs._uri))
    first = programs.watch()
    programs.wait(programs.address)
    assert not programs.says('master')

    master.kill()
    master.wait()
    programs.wait(lambda: programs.says('There is no ROS master'))

    programs.master()
    programs.wait(lambda: programs.says('does not know the nodes'))
    assert first.poll() is None

    programs.watch()
    programs.wait(programs.address)
    second = programs.address()
    programs.wait(lambda: first.poll() is not None)
    assert programs.address() == second


def test_a_misspelt_argument_is_told(programs):
    programs.master()
    programs.wait(lambda: rosgraph.is_master_online(programs._uri))
    programs.watch('wiimote_tracker_bringup', 'tracker.launch', 'cemeras:=cameras.yaml')
    programs.wait(lambda: programs.says('cemeras:= has no effect: write cameras:='))
