"""What the node answers, without a node."""

import queue

from actionlib_msgs.msg import GoalStatus

from guide import commands
from guide.node import Node


class LostCapture:
    """A client of an action whose server was started again after it took the goal."""

    def wait_for_server(self, timeout):
        return True

    def send_goal(self, goal, done_cb, feedback_cb):
        done_cb(GoalStatus.LOST, None)

    def get_result(self):
        return None


def test_a_capture_that_its_server_has_lost_is_answered():
    node = Node.__new__(Node)
    node.events = queue.Queue()
    node._capture = LostCapture()
    node.send('capture', commands.request('capture_corner', 'CaptureCorner'))
    event, word, good, text = node.events.get(timeout=10.0)
    assert (event, word, good) == ('answer', 'capture', False)
    assert 'the calibration node was started again' in text
