"""What the tests of calibrate share: a guide and a dialogue without a node and a terminal."""

import queue

from wiimote_tracker_msgs.msg import CalibrationCameraStatus, CalibrationStatus

from guide import commands
from guide.dialogue import Dialogue
from guide.guide import Guide

NAN = float('nan')


def camera(name='wiimote_1', **fields):
    values = dict(connected=True, rate=99.6, blobs=1, sees_led=True, x=10.0, y=20.0,
                  image_coverage=NAN, speed=NAN, wave_seconds=NAN)
    values.update(fields)
    return CalibrationCameraStatus(name=name, **values)


def status(step, request='', label='', **fields):
    values = dict(corners_needed=4, cameras=[camera()], next_sentence='Do this.',
                  next_request=request, next_label=label, next_corner=-1)
    values.update(fields)
    return CalibrationStatus(step=step, **values)


def guide_at(*statuses, **options):
    guide = Guide(0.0, **options)
    guide.image_sizes = {each.name: (1024, 768) for message in statuses for each in message.cameras}
    for number, each in enumerate(statuses):
        guide.on_status(each, float(number))
    return guide


class FakeNode:
    """Answers with what it is told to, or not at all."""

    def __init__(self, answers=None):
        self.events = queue.Queue()
        self.sent = []
        self.called_off = 0
        self._answers = answers

    def send(self, word, request):
        self.sent.append(request)
        if self._answers is not None:
            self.events.put(('answer', word) + self._answers.get(word, (True, word + ' done')))

    def call_off_capture(self):
        self.called_off += 1


def dialogue_with(node, *statuses):
    guide = Guide(0.0)
    for each in statuses:
        node.events.put(('status', each))
    dialogue = Dialogue(guide, node, commands.RIG, guide.advice)
    dialogue.take_events(0.0)
    return dialogue
