"""Runs track_bag, and reads and writes its bags."""

import io
import os
import subprocess

import numpy as np
import rosbag

import recording
from recording import images, rig, seconds_of, time_of

PROGRAM = os.environ['TRACK_BAG']
DURATION = 1.6


def run(*arguments, **keywords):
    """(exit status, standard output, error output)"""
    process = subprocess.run([PROGRAM] + [str(a) for a in arguments], stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE, universal_newlines=True, **keywords)
    return process.returncode, process.stdout, process.stderr


def track(*arguments):
    status, output, errors = run(*arguments)
    assert status == 0, errors
    return output


def refused(tmp_path, *arguments, **keywords):
    """The sentence, after which there is no output bag, and no part of a file."""
    status, _, errors = run(*arguments, **keywords)
    assert status == 1, errors
    assert not (tmp_path / 'out.bag').exists()
    assert not list(tmp_path.glob('*.part'))
    assert 'Traceback' not in errors and errors.startswith('track_bag: ')
    return errors


def write(path, entries):
    """entries: (topic, message, recorded time [s after START])"""
    with rosbag.Bag(str(path), 'w') as bag:
        for topic, message, seconds in entries:
            bag.write(topic, message, time_of(seconds))


def entries_of(images_, delay=0.001):
    return [('/%s/ir_blobs' % i.camera, i, seconds_of(i.arrival) + delay) for i in images_]


def recorded(ways=(recording.walk,), duration=DURATION, **keywords):
    return ([('/calibration/rig', rig(**keywords), -0.1)] +
            entries_of(images(duration, ways)))


def read(path, *topics):
    with rosbag.Bag(str(path)) as bag:
        return [(topic, message, time) for topic, message, time in
                bag.read_messages(topics=list(topics) or None)]


def arrays(path, topic='/points'):
    return [message for _, message, _ in read(path, topic)]


def bytes_of(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def all_bytes(messages):
    return [bytes_of(m) for m in messages]


def position(p):
    return np.array([p.x, p.y, p.z])
