"""What the node answers, without a node."""

import queue

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus

from guide import commands, node as node_module
from guide.node import Node


class LostCapture:
    """A client of an action whose server was started again after it took the goal."""

    def wait_for_server(self, timeout):
        return True

    def send_goal(self, goal, done_cb, feedback_cb):
        done_cb(GoalStatus.LOST, None)

    def get_result(self):
        return None


class EndedCapture:
    """A client of an action whose server ends after it took the goal."""

    def __init__(self):
        self._is_there = True

    def wait_for_server(self, timeout):
        return self._is_there

    def send_goal(self, goal, done_cb, feedback_cb):
        self._is_there = False


def answer_of(capture):
    """The event that follows a request to capture."""
    node = Node.__new__(Node)
    node.events = queue.Queue()
    node._capture = capture
    node.send('capture', commands.request('capture_corner', 'CaptureCorner'))
    return node.events.get(timeout=10.0)


def test_a_capture_that_its_server_has_lost_is_answered():
    event, word, good, text = answer_of(LostCapture())
    assert (event, word, good) == ('answer', 'capture', False)
    assert 'the calibration node was started again' in text


def test_a_capture_whose_server_has_ended_is_answered(monkeypatch):
    monkeypatch.setattr(node_module, 'CHECK_PERIOD', 0.01)
    event, word, good, text = answer_of(EndedCapture())
    assert (event, word, good) == ('answer', 'capture', False)
    assert 'check that the calibration node runs' in text


@pytest.mark.parametrize('error', [
    rospy.exceptions.TransportTerminated('broken pipe'), ConnectionResetError('reset by peer'),
    rospy.ServiceException('broken pipe')])
def test_a_request_during_which_the_node_ends_is_answered(monkeypatch, error):
    def call(name, request):
        raise error
    node = Node.__new__(Node)
    node.events = queue.Queue()
    monkeypatch.setattr(node, '_call', call)
    node.send('solve', commands.request('solve', 'SolveCalibration'))
    assert node.events.get(timeout=10.0) == (
        'answer', 'solve', False, f'calibration/solve failed: {error}')


@pytest.mark.parametrize('namespace, topics, said', [
    ('/', ['/second/calibration/status', '/first/calibration/status', '/rosout'],
     'a calibration node runs in /first and /second: type  ROS_NAMESPACE=/first rosrun '
     'wiimote_tracker_calibration calibrate'),
    ('/second/', ['/calibration/status'],
     'a calibration node runs in /: type  ROS_NAMESPACE=/ rosrun '
     'wiimote_tracker_calibration calibrate'),
    ('/second/', ['/calibration/status', '/second/calibration/status'], ''),
    ('/', ['/rosout'], '')])
def test_calibration_nodes_of_other_namespaces_are_named(monkeypatch, namespace, topics, said):
    monkeypatch.setattr(rospy, 'resolve_name', lambda name: namespace + name)
    monkeypatch.setattr(rospy, 'get_published_topics', lambda: [(each, '') for each in topics])
    assert node_module.elsewhere() == said

    def call(name, request):
        raise rospy.ROSException()
    node = Node.__new__(Node)
    node.events = queue.Queue()
    monkeypatch.setattr(node, '_call', call)
    node.send('start', commands.request('start', 'StartCalibration'))
    assert node.events.get(timeout=10.0)[3] == (
        f'{namespace}calibration/start does not answer: ' +
        (said or 'check that the calibration node runs, in the same version'))
