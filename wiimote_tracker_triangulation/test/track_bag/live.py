"""What the tests have in common that compare a running node with a recording."""

import io
import time

import rospy

DEADLINE = 60.0  # [s]


def wait_for(condition, what):
    end = time.monotonic() + DEADLINE
    while not condition():
        if time.monotonic() > end or rospy.is_shutdown():
            raise AssertionError('waited in vain for ' + what)
        time.sleep(0.0005)


def bytes_of(message):
    """Without the sequence numbers that a live publisher counts."""
    if hasattr(message, 'header'):
        message.header.seq = 0
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()
