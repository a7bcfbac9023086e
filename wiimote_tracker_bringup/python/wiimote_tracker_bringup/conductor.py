"""Leads a simulated rig through an experiment by the services that a person would use."""

import dataclasses
import logging
from typing import Sequence

import actionlib
import rospy
from geometry_msgs.msg import Point, Vector3
from wiimote_tracker_msgs.msg import (CalibrationStatus, CaptureCornerAction, CaptureCornerGoal,
                                      TrackedPoint, TrackedPointArray)
from wiimote_tracker_msgs.srv import (CheckConnection, SaveRig, SetLed, SetLedRequest,
                                      SolveCalibration, StartCalibration)

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.waiting import wait_until

SETTLE = 0.1  # between arrival of an LED and measurement [s]
REST = 0.02   # spread of the points of an LED at rest within that time [m]
CAPTURE_ATTEMPTS = 3


@dataclasses.dataclass(eq=False)
class Segment:
    """A time span of one motion of the LED. kind: 'test', 'alignment' or 'circle'; target: the
    place or the circle's centre [m]; start, end [s since 1970]."""

    kind: str
    name: str
    target: Sequence[float]
    start: float
    end: float


class Conductor:
    def __init__(self, led, recorder, check=lambda: None, progress=lambda text: None):
        """led: name of the LED. recorder: a LiveRecorder. check: called while waiting; raises if
        waiting is useless. progress: called with a description of the present step."""
        self._led = led
        self._recorder = recorder
        self._check = check
        self._progress = progress
        self.status = None  # the newest CalibrationStatus
        rospy.Subscriber('calibration/status', CalibrationStatus, self._on_status)
        self._capture = actionlib.SimpleActionClient('calibration/capture_corner',
                                                     CaptureCornerAction)
        # actionlib logs this as an error when a goal is accepted before send_goal() has returned.
        logging.getLogger('rosout').addFilter(
            lambda record: 'Got a transition callback' not in record.getMessage())

    def _on_status(self, message):
        self.status = message

    # --- Waiting

    def wait(self, condition, timeout, what):
        """Waits until the condition holds. what: for what, or a function that tells it.
        @raise Refusal: not within timeout [s]."""
        def check():
            self._check()
            if rospy.is_shutdown():
                raise Refusal('interrupted')
        wait_until(condition, timeout, lambda: f'waited {timeout:.0f} s in vain for '
                   f'{what() if callable(what) else what}', check, period=0.01)

    def _call(self, service, type_, *arguments, **named):
        """Response of a service that returns success and a sentence."""
        def there():
            try:
                rospy.wait_for_service(service, timeout=0.1)
                return True
            except rospy.ROSException:
                return False
        self.wait(there, 30.0, f'the service {rospy.resolve_name(service)}; is its node running?')
        try:
            return rospy.ServiceProxy(service, type_)(*arguments, **named)
        except rospy.ServiceException as error:
            raise Refusal(f'the service {service} failed: {error}')

    def _succeed(self, what, response):
        if not response.success:
            raise Refusal(f'{what} was refused: {response.message}')
        return response

    # --- The LED

    def move(self, target, speed):
        """Moves the LED straight to a place [m]. Returns its arrival [s since 1970]."""
        return self._set_led(motion=SetLedRequest.LINE, target=target, speed=speed)

    def circle_from(self, center, radius, speed):
        """Moves the LED on a circle. Returns the start of its first lap, on the +x side [s since
        1970]."""
        return self._set_led(motion=SetLedRequest.CIRCLE, target=center, speed=speed, radius=radius)

    def wave(self, led, middle, side, speed, path):
        """Waves an LED through a cube of this side around its middle [m]."""
        self._succeed('waving the LED', self._call(
            'simulation/set_led', SetLed, led=led, on=True, motion=SetLedRequest.WAVE, speed=speed,
            path=path, target=Point(*middle), box=Vector3(side, side, side)))

    def switch(self, led, on):
        """Switches an LED, which then stays where it is."""
        self._succeed('switching the LED', self._call('simulation/set_led', SetLed, led=led, on=on))

    def _set_led(self, target, **request):
        response = self._call('simulation/set_led', SetLed, led=self._led, on=True,
                              target=Point(*target), **request)
        arrival = self._succeed('moving the LED', response).arrival.to_sec()
        self.wait(lambda: rospy.get_time() >= arrival, 60.0, 'the LED to arrive')
        return arrival

    # --- The steps of a calibration

    def wait_for_cameras(self, names):
        def missing():
            connected = {camera.name.strip('/') for camera in self.status.cameras
                         if camera.connected} if self.status else set()
            return sorted(set(names) - connected)
        self.wait(lambda: not missing(), 40.0, lambda: (
            f"images from {', '.join(missing())}; see the drivers' messages"))

    def wait_until_seen(self, names):
        def seeing():
            return {camera.name.strip('/') for camera in self.status.cameras if camera.sees_led}
        self.wait(lambda: seeing().issuperset(names), 10.0, 'all cameras to see the LED')

    def wait_for_leds(self, number):
        """Waits until this number of LEDs is tracked at once."""
        tracked = []
        subscriber = rospy.Subscriber('points', TrackedPointArray, lambda message: tracked.append(
            sum(point.state == TrackedPoint.TRACKED for point in message.points)))
        self.wait(lambda: number in tracked, 20.0, f'the tracker to find {number} LEDs')
        subscriber.unregister()

    def check_connection(self, duration=1.0):
        """The node's answer about which cameras see the LED."""
        return self._call('calibration/check_connection', CheckConnection, duration)

    def start(self, side):
        return self._succeed('starting the calibration', self._call(
            'calibration/start', StartCalibration, side_x=side, side_y=0.0, cameras=[]))

    def capture(self, place, speed):
        """Moves the LED to a place and captures it as the next corner. Returns the action's result.
        Tries again after a refusal, as that asks for."""
        self.move(place, speed)
        rospy.sleep(SETTLE)
        for attempt in range(CAPTURE_ATTEMPTS):
            result = self._capture_once()
            if result.success:
                break
            self._progress(result.message)
        return self._succeed('capturing a corner', result)

    def _capture_once(self):
        self.wait(lambda: self._capture.wait_for_server(rospy.Duration(0.1)), 10.0,
                  'the action calibration/capture_corner; does the calibration node run?')
        results = []

        def on_feedback(feedback):
            self._progress('corner %d: %3.0f %%  %s' % (
                feedback.corner + 1, 100.0 * feedback.progress, feedback.message))
        self._capture.send_goal(CaptureCornerGoal(), feedback_cb=on_feedback,
                                done_cb=lambda state, result: results.append(result))
        self.wait(lambda: results, 60.0, 'the corner to be captured')
        return results[0]

    def solve(self):
        return self._succeed('solving', self._call('calibration/solve', SolveCalibration))

    def save(self, path=''):
        return self._succeed('saving', self._call('calibration/save', SaveRig, path=path))

    # --- Measuring

    def dwell(self, kind, name, place, speed, duration):
        """Moves the LED to a place and leaves it there for a duration [s], from when its points are
        at rest: a busy computer may stamp images of the motion too late."""
        arrival = self.move(place, speed)
        self.wait(lambda: self._rests(arrival), 30.0, 'points of an LED at rest')
        start = self._recorder.newest_stamp
        return self._measure(Segment(kind, name, place, start, start + duration))

    def circle(self, name, center, radius, speed, duration):
        """Moves the LED on a circle for a duration [s]."""
        start = self.circle_from(center, radius, speed) + SETTLE
        return self._measure(Segment('circle', name, center, start, start + duration))

    def _rests(self, arrival):
        since = self._recorder.newest_stamp - SETTLE
        return since >= arrival and self._recorder.spread(since) < REST

    def _measure(self, segment):
        self.wait(lambda: self._recorder.newest_stamp > segment.end,
                  30.0 + segment.end - segment.start, 'tracked points on the topic points')
        return segment
