"""Child processes that end with their owner, with all their children."""

import contextlib
import ctypes
import os
import signal
import socket
import subprocess
import time
from typing import List, Sequence

import psutil

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.waiting import wait_until

PR_SET_PDEATHSIG = 1
PR_SET_CHILD_SUBREAPER = 36


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def prctl(option, value):
    ctypes.CDLL(None, use_errno=True).prctl(option, value, 0, 0, 0)


def spawn(command: List[str], output: str) -> subprocess.Popen:
    """Starts a command with its output in the file `output`, in a session of its own; it ends with
    this process."""
    with open(output, 'ab') as file:
        return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=file,
                                stderr=subprocess.STDOUT, start_new_session=True,
                                preexec_fn=lambda: prctl(PR_SET_PDEATHSIG, signal.SIGTERM))


def descendants() -> List[psutil.Process]:
    """All processes below this one, except zombies."""
    def runs(process):
        try:
            return process.status() != psutil.STATUS_ZOMBIE
        except psutil.NoSuchProcess:
            return False
    return [each for each in psutil.Process().children(recursive=True) if runs(each)]


class Processes:
    """Starts processes in sessions of their own, so that a terminal's Ctrl-C reaches only this one.

    Orphaned grandchildren become our children, so that stop_all() finds them.
    """

    def __init__(self):
        prctl(PR_SET_CHILD_SUBREAPER, 1)
        self._started = []  # (name, Popen, path of its output)

    def start(self, name: str, command: List[str], output: str) -> subprocess.Popen:
        process = spawn(command, output)
        self._started.append((name, process, output))
        return process

    def start_master(self, port: int, output: str, patience: float = 30.0) -> subprocess.Popen:
        """Starts a ROS master, that of ROS_MASTER_URI, and waits until it answers.
        @raise Refusal: it does not within patience [s]."""
        import rosgraph
        master = self.start('rosmaster', ['rosmaster', '--core', '-p', str(port)], output)
        wait_until(rosgraph.is_master_online, patience,
                   f'no ROS master within {patience:.0f} s; see {output}', self.check)
        return master

    def check(self) -> None:
        """@raise Refusal: a started process has ended."""
        for name, process, output in self._started:
            if process.poll() is not None:
                raise Refusal(f'{name} ended unexpectedly (status {process.returncode}); '
                              f'see {output}')

    def stop(self, process: subprocess.Popen, patience: float = 15.0) -> None:
        """Asks a process to end and waits for it."""
        self._started = [entry for entry in self._started if entry[1] is not process]
        self._signal_group(process, signal.SIGINT)
        try:
            process.wait(patience)
        except subprocess.TimeoutExpired:
            self._signal_group(process, signal.SIGKILL)
            process.wait()

    def stop_all(self, patience: Sequence[float] = (6.0, 2.0, 2.0)) -> None:
        """Ends every process below this one: by SIGINT, then SIGTERM, then SIGKILL."""
        for _, process, _ in self._started:
            self._signal_group(process, signal.SIGINT)
        for number, seconds in zip((signal.SIGTERM, signal.SIGKILL, None), patience):
            deadline = time.monotonic() + seconds
            while descendants() and time.monotonic() < deadline:
                self._reap()
                time.sleep(0.02)
            if number is not None:
                for process in descendants():
                    with contextlib.suppress(psutil.NoSuchProcess):
                        process.send_signal(number)
        self._reap()
        self._started = []

    @staticmethod
    def _signal_group(process, number):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)

    def _reap(self):
        for _, process, _ in self._started:
            process.poll()
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
