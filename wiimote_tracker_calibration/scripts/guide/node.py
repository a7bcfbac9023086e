"""The calibration node, as seen from a terminal: its messages, and requests to it.

Nothing here waits: messages go into a queue, and each request runs in its own thread.
"""

import importlib
import queue
import threading
from typing import Any, Dict, Tuple

import actionlib
import rospy
from std_msgs.msg import String
from wiimote_tracker_msgs.msg import (BoardStatus, CalibrationStatus, CalibrationVerdict,
                                      CaptureCornerAction, CaptureCornerGoal, IrBlobArray,
                                      PrincipalPointTrace)

from .commands import Request

SERVICE_TIMEOUT = 1.0   # [s] Longest search for a service.
ACTION_TIMEOUT = 5.0    # [s] Longest search for the action's server.
CHECK_PERIOD = 1.0      # [s] Between checks during a capture that both sides still run.

STATUS = '/calibration/status'

TOPICS = (('status', 'status', CalibrationStatus), ('verdict', 'verdict', CalibrationVerdict),
          ('board', 'board', BoardStatus), ('trace', 'principal_point_trace', PrincipalPointTrace),
          ('sound', 'sound', String))


class Node:
    """events: a queue.Queue of (event, message) for the events of TOPICS, ('image_size', camera,
    (width, height)), ('feedback', text, share), ('answer', word, good, text) and, at the start,
    ('elsewhere', what to do if calibration nodes run in other namespaces only)."""

    def __init__(self):
        self.events: queue.Queue = queue.Queue()
        self._capture = actionlib.SimpleActionClient('calibration/capture_corner',
                                                     CaptureCornerAction)
        self._images: Dict[str, rospy.Subscriber] = {}
        for event, topic, type_ in TOPICS:
            rospy.Subscriber(f'calibration/{topic}', type_, self._on_message, event)
        threading.Thread(target=lambda: self.events.put(('elsewhere', elsewhere())),
                         daemon=True).start()

    def send(self, word: str, request: Request) -> None:
        """Sends a request; its answer becomes an event."""
        def run():
            name = f'calibration/{request.name}'
            try:
                good, text = self._call(name, request)
            except rospy.ROSException:
                good, text = False, (f'{rospy.resolve_name(name)} does not answer: ' + (
                    elsewhere() or 'check that the calibration node runs, in the same version'))
            # Also errors of sockets and rospy's internal ones, when the node ends meanwhile:
            # without an answer nothing more could be sent.
            except Exception as error:
                good, text = False, f'{name} failed: {error}'
            self.events.put(('answer', word, good, text))
        threading.Thread(target=run, daemon=True).start()

    def call_off_capture(self) -> None:
        """Gives up the corner that is being captured."""
        self._capture.cancel_all_goals()

    def _on_message(self, message, event: str) -> None:
        self.events.put((event, message))
        if event == 'status':
            for camera in message.cameras:
                if camera.name not in self._images:
                    self._images[camera.name] = rospy.Subscriber(
                        f'{camera.name}/ir_blobs', IrBlobArray, self._on_image, camera.name)

    def _on_image(self, message, camera: str) -> None:
        """One image tells the size of all."""
        self.events.put(('image_size', camera, (message.width, message.height)))
        subscriber = self._images.get(camera)
        if subscriber is not None:
            subscriber.unregister()

    def _call(self, name: str, request: Request) -> Tuple[bool, str]:
        """(success, text) of the node's answer."""
        if request.type == 'CaptureCorner':
            return self._capture_corner(request)
        rospy.wait_for_service(name, SERVICE_TIMEOUT)
        package = 'std_srvs' if request.type in ('Trigger', 'SetBool') else 'wiimote_tracker_msgs'
        type_ = getattr(importlib.import_module(package + '.srv'), request.type)
        message = type_._request_class()
        fill(message, request.fields)
        response = rospy.ServiceProxy(name, type_)(message)
        return response.success, sentence(response)

    def _capture_corner(self, request: Request) -> Tuple[bool, str]:
        if not self._capture.wait_for_server(rospy.Duration(ACTION_TIMEOUT)):
            raise rospy.ROSException()
        goal = CaptureCornerGoal()
        fill(goal, request.fields)
        done = threading.Event()
        self._capture.send_goal(
            goal, done_cb=lambda state, result: done.set(),
            feedback_cb=lambda feedback: self.events.put(
                ('feedback', feedback.message, feedback.progress)))
        while not done.wait(CHECK_PERIOD):
            # A server that has ended says nothing; one that was started again disowns the goal.
            if rospy.is_shutdown() or not self._capture.wait_for_server(
                    rospy.Duration(ACTION_TIMEOUT)) and not done.is_set():
                raise rospy.ROSException()
        result = self._capture.get_result()
        if result is None:  # the server does not know the goal
            return False, 'the calibration node was started again: capture again'
        return result.success, sentence(result)


def elsewhere() -> str:
    """What to do where calibration nodes run in other namespaces only; else empty."""
    try:
        topics = [topic for topic, _ in rospy.get_published_topics()]
    except Exception:  # of the connection: the master ends
        return ''
    spaces = sorted(topic[:-len(STATUS)] or '/' for topic in topics if topic.endswith(STATUS))
    if not spaces or rospy.resolve_name(STATUS[1:]) in topics:
        return ''
    return (f'a calibration node runs in {" and ".join(spaces)}: type  ROS_NAMESPACE={spaces[0]} '
            'rosrun wiimote_tracker_calibration calibrate')


def fill(message: Any, fields: Dict[str, Any]) -> None:
    """Sets the fields of a message; `known` is a point of three numbers."""
    for name, value in fields.items():
        if name == 'known':
            message.known.x, message.known.y, message.known.z = value
        else:
            setattr(message, name, value)


def sentence(response: Any) -> str:
    """The node's answer, and its table if it has one."""
    parts = [response.message, getattr(response, 'table', '')]
    return '\n'.join(part for part in parts if part) or (
        'done' if response.success else 'refused, without a reason')
