"""Messages and services whose fields all hold what nobody expects, made from their types."""

import ctypes
import dataclasses
import signal
import time

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.helper import Helper, wait_for_subscribers
from wiimote_tracker_evaluation.faults.of_messages import CAMERA, INTERVAL, NAN
from wiimote_tracker_evaluation.faults.of_processes import CALIBRATION, DRIVER, GESTURES, TRACKER

NODES = (TRACKER, CALIBRATION, GESTURES, DRIVER)
OF_ROSCPP = ('get_loggers', 'set_logger_level')
OF_NODELETS = ('load_nodelet', 'unload_nodelet')  # refuse without a reason
SENT = 3         # of each message
MANY = 10000     # elements or characters
PATIENCE = 90.0  # for all answers [s]


@dataclasses.dataclass(frozen=True)
class Content:
    """number: of floating point fields. high: whether integers and times are their highest, or
    their lowest. text: of strings. length: of lists; lists in lists have one element."""

    number: float
    high: bool = True
    text: str = CAMERA
    length: int = 1


CONTENTS = (Content(NAN), Content(float('inf'), False, length=3), Content(1e300, text='x' * MANY),
            Content(-1e300, False, text='../\0\n', length=2), Content(-1.0, length=MANY),
            Content(0.0, False, text='', length=0))


def filled(kind, content):
    """A value of a field's type, as in a message's _slot_types."""
    import genpy
    import roslib.message
    base, is_list, length = kind.rstrip(']').partition('[')
    if is_list:
        element = filled(base, dataclasses.replace(content, length=min(content.length, 1)))
        return [element] * (int(length) if length else content.length)
    if base in ('time', 'duration'):
        if not content.high:
            return genpy.Time() if base == 'time' else genpy.Duration(-2 ** 31)
        return genpy.Time(2 ** 32 - 1) if base == 'time' else genpy.Duration(2 ** 31 - 1)
    if base == 'string':
        return content.text
    if base == 'bool':
        return content.high
    if base.startswith('float'):
        return ctypes.c_float(content.number).value if base == 'float32' else content.number
    if '/' not in base:
        bits = int(base.partition('int')[2])
        lowest = 0 if base.startswith('u') else -2 ** (bits - 1)
        return lowest + 2 ** bits - 1 if content.high else lowest
    return filled_message(roslib.message.get_message_class(base), content)


def filled_message(kind, content):
    """A message of a class; its stamp is now, as nodes refuse any other without a look at the
    rest."""
    import rospy
    message = kind(*(filled(field, content) for field in kind._slot_types))
    if kind._has_header:
        message.header.stamp = rospy.Time.now()
    return message


def publish_all(pipe):
    """To each topic that the nodes read."""
    import roslib.message
    import rosgraph
    import rospy
    master = rosgraph.Master(rospy.get_name())
    kinds = dict(master.getTopicTypes())
    topics = [topic for topic, nodes in master.getSystemState()[1] if set(nodes) & set(NODES)]
    for topic in topics:
        kind = roslib.message.get_message_class(kinds[topic])
        publisher = rospy.Publisher(topic, kind, queue_size=100)
        wait_for_subscribers(publisher)
        for content in CONTENTS:
            message = filled_message(kind, content)
            for _ in range(SENT):
                publisher.publish(message)
                time.sleep(INTERVAL)
    pipe.send(topics)
    signal.pause()


def call_all(pipe):
    """Each service of the nodes that takes anything; answers what was wrong with the answers."""
    import rosgraph
    import rospy
    import rosservice
    problems = []
    for service, nodes in rosgraph.Master(rospy.get_name()).getSystemState()[2]:
        if not set(nodes) & set(NODES) or service.endswith(OF_ROSCPP):
            continue
        kind = rosservice.get_service_class_by_name(service)
        request = kind._request_class
        if not request.__slots__:
            continue
        call = rospy.ServiceProxy(service, kind)
        for number, content in enumerate(CONTENTS):
            if service.endswith('/save') and not content.text:
                continue  # saves the rig, as it should
            try:
                answer = call(filled_message(request, content))
            except rospy.ServiceException as error:
                if not service.endswith(OF_NODELETS):
                    problems.append(f'{service}, content {number}: {error}')
            else:
                reason = getattr(answer, 'message', '') or getattr(answer, 'status_message', '')
                if not getattr(answer, 'success', True) and not reason:
                    problems.append(f'{service}, content {number}: refused without a reason')
    pipe.send(problems)


@fault()
def hostile_messages(room):
    """To each topic that is read: NaN, infinite, huge, negative numbers, empty and long lists."""
    with Helper(publish_all) as helper:
        helper.answer(PATIENCE)
        yield 0.0


# What the services do with requests that they accept, such as a new session, is not taken back.
@fault(spends_room=True)
def hostile_services(room):
    """To each service the same."""
    with Helper(call_all) as helper:
        problems = helper.answer(PATIENCE)
        yield 0.0
    return problems
