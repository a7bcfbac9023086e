"""Messages that no driver sends, and receivers that do not read."""

import os
import signal
import threading
import time

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.helper import Helper, wait_for_subscribers
from wiimote_tracker_evaluation.faults.of_processes import in_one_manager

CAMERA = 'wiimote_4'
SENT = 10         # of each kind
INTERVAL = 0.025  # between two of them [s]
SPOTS = 100000
SLOW, STOPPED = 2.0, 5.0  # for how long subscribers are slow, and then do not read [s]
NAN = float('nan')


def unusable_images():
    """Images that cannot be used, each with one fault."""
    from wiimote_tracker_msgs.msg import IrBlob, IrBlobArray

    def image(blobs=1, x=500.0, **fields):
        message = IrBlobArray(camera=CAMERA, width=1024, height=768, max_blobs=4,
                              identity='00:1f:32:00:00:04', **fields)
        message.blobs = [IrBlob(x=x, y=400.0, size=3.0, intensity=NAN)] * blobs
        return message
    return [image(x=NAN), image(x=1e300), image(x=-5.0), image(blobs=5), image(blobs=SPOTS),
            image(stamp_stddev=NAN, x=float('inf')), image(stamp_stddev=-1.0)]


def publish_hostile_images(pipe):
    import rospy
    from wiimote_tracker_msgs.msg import IrBlobArray
    publisher = rospy.Publisher(CAMERA + '/ir_blobs', IrBlobArray, queue_size=100)
    messages = unusable_images()
    messages += [IrBlobArray(camera=CAMERA, width=7, height=0), IrBlobArray()]
    wait_for_subscribers(publisher)
    for _ in range(SENT):
        for message in messages:
            message.header.stamp = message.arrival = rospy.Time.now()
            publisher.publish(message)
            time.sleep(INTERVAL)
    early, late = IrBlobArray(camera=CAMERA), IrBlobArray(camera=CAMERA)
    late.header.stamp = late.arrival = rospy.Time(2 ** 32 - 1)
    for message in (early, late):
        publisher.publish(message)
    time.sleep(2.0 * INTERVAL)
    pipe.send('done')
    signal.pause()


@fault(quick=True, named=CAMERA)
def hostile_images_of_a_camera(room):
    """A second publisher of a camera: NaN, wrong sizes, 100,000 spots, years 1970 and 2106."""
    with Helper(publish_hostile_images) as helper:
        helper.answer(60.0)
        yield 0.0


hostile_images_in_one_manager = in_one_manager(hostile_images_of_a_camera,
                                               'hostile_images_in_one_manager')


def subscribe_slowly(pipe):
    import rospy
    from wiimote_tracker_msgs.msg import IrBlobArray, TrackedPointArray
    heard = []
    for topic, kind in (('points', TrackedPointArray), (CAMERA + '/ir_blobs', IrBlobArray)):
        hears = threading.Event()
        heard.append(hears)
        rospy.Subscriber(topic, kind, lambda _, hears=hears: (hears.set(), time.sleep(1.0)))
    for hears in heard:
        hears.wait()
    pipe.send('there')
    signal.pause()


# The master keeps the killed subscribers in its list: the next fault would wait for them.
@fault(spends_room=True)
def slow_subscribers(room):
    """Five subscribers that take 1 s a message, and then do not read at all for 5 s."""
    helpers = [Helper(subscribe_slowly) for _ in range(5)]
    try:
        for helper in helpers:
            helper.answer()
        time.sleep(SLOW)
        for helper in helpers:
            os.kill(helper.pid, signal.SIGSTOP)
        yield STOPPED
    finally:
        for helper in helpers:
            helper.stop()


slow_subscribers_in_one_manager = in_one_manager(slow_subscribers,
                                                 'slow_subscribers_in_one_manager')
