"""Damaged files, through the service that loads them."""

import random

from wiimote_tracker_evaluation.faults.helper import Helper
from wiimote_tracker_evaluation.faults.row import fault

STEP = 5         # of truncation [%]
FLIPS = 100      # files with a few changed bytes
SEED = 1
PATIENCE = 30.0  # for the answer about one file [s]


def answer_loads(pipe):
    """Loads each rig file whose path comes; answers whether it was loaded, and the sentence."""
    import rospy
    from wiimote_tracker_msgs.srv import LoadRig
    rospy.wait_for_service('calibration/load', 30.0)
    load = rospy.ServiceProxy('calibration/load', LoadRig)
    while True:
        response = load(pipe.recv())
        pipe.send((response.success, response.message))


def load_all(room, contents):
    """Loads damaged files, by name, and then the whole one. Returns the names of those that were
    loaded, and what went wrong."""
    loaded, problems = [], []
    path = room.file('damaged.yaml')
    with Helper(answer_loads) as helper:
        for name, content in contents:
            with open(path, 'wb') as file:
                file.write(content)
            success, sentence = helper.ask(path, PATIENCE)
            if success:
                loaded.append(name)
                helper.ask(room.file('rig.yaml'), PATIENCE)
            elif not sentence:
                problems.append(f'{name}: refused without a reason')
        if not helper.ask(room.file('rig.yaml'), PATIENCE)[0]:
            problems.append('the whole file is refused afterwards')
    return loaded, problems


def rig_bytes(room):
    with open(room.file('rig.yaml'), 'rb') as file:
        return file.read()


@fault(quick=True)
def truncated_rig_files(room):
    """Rig files cut off at every 5 %."""
    yield 0.0
    whole = rig_bytes(room)
    loaded, problems = load_all(room, (
        (f'cut at {percent} %', whole[:len(whole) * percent // 100])
        for percent in range(0, 100, STEP)))
    return problems + [f'{name}: loaded' for name in loaded]


@fault(wrong_allowed=True)
def changed_rig_files(room):
    """Rig files with random bytes changed; another digit is another rig, which cannot be told."""
    yield 0.0
    whole, randomness = rig_bytes(room), random.Random(SEED)

    def changed():
        content = bytearray(whole)
        for _ in range(randomness.randint(1, 8)):
            content[randomness.randrange(len(content))] = randomness.randrange(256)
        return bytes(content)
    return load_all(room, ((f'change {number}', changed()) for number in range(FLIPS)))[1]
