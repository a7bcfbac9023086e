"""Processes that are ROS nodes for a while.

The program itself is no node: it must outlive the master, and a process can be a node only once.
"""

import multiprocessing
import os
import signal
import time

_FORK = multiprocessing.get_context('fork')


class Helper:
    """Runs function(pipe, *arguments) in a process of its own, as a node. `pipe` leads here."""

    def __init__(self, function, *arguments):
        self.pipe, there = _FORK.Pipe()
        self._process = _FORK.Process(target=_be_node, args=(function, there) + arguments,
                                      daemon=True)
        self._process.start()

    @property
    def pid(self):
        return self._process.pid

    def ask(self, question, patience=30.0):
        """Sends a question and returns the answer. @raise TimeoutError: none came."""
        self.pipe.send(question)
        return self.answer(patience)

    def answer(self, patience=30.0):
        if not self.pipe.poll(patience):
            raise TimeoutError(f'no answer within {patience:.0f} s')
        return self.pipe.recv()

    def stop(self):
        self._process.kill()
        self._process.join()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def wait_for_subscribers(publisher):
    """Waits until all nodes that subscribe to the publisher's topic are connected to it."""
    import rosgraph
    import rospy
    master = rosgraph.Master(rospy.get_name())
    while True:
        subscribers = dict(master.getSystemState()[1]).get(publisher.resolved_name, [])
        if publisher.get_num_connections() >= len(subscribers) > 0:
            return
        time.sleep(0.02)


def _be_node(function, pipe, *arguments):
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of the terminal; the program ends this process
    import rospy
    rospy.init_node('fault_matrix_%d' % os.getpid(), disable_signals=True)
    function(pipe, *arguments)
