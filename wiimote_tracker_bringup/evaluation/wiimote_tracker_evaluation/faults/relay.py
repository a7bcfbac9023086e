"""A camera whose images pass a relay, which can change them."""

import random

from wiimote_tracker_evaluation.faults.helper import Helper


class Relay(Helper):
    """Starts the camera's driver and the relay."""

    def __init__(self, room, camera):
        room.start_driver(camera, 'ir_blobs:=ir_blobs_true')
        super().__init__(_pass_on, camera)

    def change(self, clock_ahead=0.0, ghosts=0, drift=0.0):
        """clock_ahead: error of the camera's clock from now on [s]; drift: by how much it grows
        [s/s]. ghosts: spots at random places that each image gets."""
        self.pipe.send((clock_ahead, ghosts, drift))


def _pass_on(pipe, camera):
    import rospy
    from wiimote_tracker_msgs.msg import IrBlob, IrBlobArray
    publisher = rospy.Publisher(camera + '/ir_blobs', IrBlobArray, queue_size=100, tcp_nodelay=True)
    state = [0.0, 0, 0.0]
    since = rospy.Time.now()
    randomness = random.Random(1)

    def pass_on(image):
        clock_ahead, ghosts, drift = state
        ahead = rospy.Duration.from_sec(clock_ahead + drift * (image.arrival - since).to_sec())
        image.header.stamp += ahead
        image.arrival += ahead
        image.blobs += [IrBlob(x=randomness.uniform(0.0, 1023.0), y=randomness.uniform(0.0, 767.0),
                               size=3.0, intensity=float('nan')) for _ in range(ghosts)]
        image.max_blobs += ghosts
        publisher.publish(image)
    rospy.Subscriber(camera + '/ir_blobs_true', IrBlobArray, pass_on, tcp_nodelay=True)
    while True:
        change, since = pipe.recv(), rospy.Time.now()
        state[:] = change
