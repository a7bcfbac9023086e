"""The calibration node, as seen from a terminal: what it tells, and requests to it.

Nothing here waits: what comes in is put into a queue, each request runs in a thread of its own.
"""

import importlib
import queue
import threading

import actionlib
import rospy
from wiimote_tracker_msgs.msg import (BoardStatus, CalibrationStatus, CalibrationVerdict,
                                      CaptureCornerAction, CaptureCornerGoal, PrincipalPointTrace)

SERVICE_TIMEOUT = 1.0   # [s] In which a service that exists is found.
ACTION_TIMEOUT = 5.0    # [s] In which the action's server is found.
ACTION_PATIENCE = 1.0   # [s] Between looks at a capture that goes on.


class Node(object):
    """events: a queue.Queue of ('status', message), ('verdict', message), ('board', message),
    ('trace', message), ('feedback', text, share) and ('answer', word, good, text)."""

    def __init__(self):
        self.events = queue.Queue()
        self._capture = actionlib.SimpleActionClient('calibration/capture_corner',
                                                     CaptureCornerAction)
        for event, topic, type_ in (('status', 'status', CalibrationStatus),
                                    ('verdict', 'verdict', CalibrationVerdict),
                                    ('board', 'board', BoardStatus),
                                    ('trace', 'principal_point_trace', PrincipalPointTrace)):
            rospy.Subscriber('calibration/' + topic, type_,
                             lambda message, event=event: self.events.put((event, message)))

    def send(self, word, request):
        """Carries out a request; its answer becomes an event."""
        def run():
            try:
                good, text = self._carry_out(request)
            except rospy.ROSException:
                good, text = False, ('%s does not answer: see whether the calibration node runs, '
                                     'and whether it is of this version'
                                     % rospy.resolve_name('calibration/' + request.name))
            except (rospy.ServiceException, ValueError) as error:
                good, text = False, 'calibration/%s failed: %s' % (request.name, error)
            self.events.put(('answer', word, good, text))
        threading.Thread(target=run, daemon=True).start()

    def call_off_capture(self):
        """The corner that is being captured is not captured."""
        self._capture.cancel_all_goals()

    def _carry_out(self, request):
        """(success, text) of the node's answer."""
        if request.type == 'CaptureCorner':
            return self._capture_corner(request)
        name = 'calibration/' + request.name
        rospy.wait_for_service(name, SERVICE_TIMEOUT)
        package = 'std_srvs' if request.type in ('Trigger', 'SetBool') else 'wiimote_tracker_msgs'
        type_ = getattr(importlib.import_module(package + '.srv'), request.type)
        message = type_._request_class()
        fill(message, request.fields)
        response = rospy.ServiceProxy(name, type_)(message)
        return response.success, sentence(response)

    def _capture_corner(self, request):
        if not self._capture.wait_for_server(rospy.Duration(ACTION_TIMEOUT)):
            raise rospy.ROSException()
        goal = CaptureCornerGoal()
        fill(goal, request.fields)
        done = threading.Event()
        self._capture.send_goal(
            goal, done_cb=lambda state, result: done.set(),
            feedback_cb=lambda feedback: self.events.put(
                ('feedback', feedback.message, feedback.progress)))
        while not done.wait(ACTION_PATIENCE):
            if rospy.is_shutdown():
                raise rospy.ROSException()
        result = self._capture.get_result()
        return result.success, result.message


def fill(message, fields):
    """Sets the fields of a message; three numbers are a point."""
    for name, value in fields.items():
        if name == 'known':
            message.known.x, message.known.y, message.known.z = value
        else:
            setattr(message, name, value)


def sentence(response):
    """What the node answered, as it is; a table below."""
    table = getattr(response, 'table', '')
    return '\n'.join(part for part in (response.message, table) if part) or (
        'done' if response.success else 'refused, without a reason')
