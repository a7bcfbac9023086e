"""Damaged files, through the service that loads them; a full disk, through the one that saves."""

import contextlib
import os
import random
import subprocess

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


def answer_saves(pipe):
    """Saves the rig to each path that comes; answers whether it was saved, and the sentence."""
    import rospy
    from wiimote_tracker_msgs.srv import SaveRig
    rospy.wait_for_service('calibration/save', 30.0)
    save = rospy.ServiceProxy('calibration/save', SaveRig)
    while True:
        response = save(pipe.recv())
        pipe.send((response.success, response.message))


@contextlib.contextmanager
def small_disk(folder):
    os.mkdir(folder)
    subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=256k', 'tmpfs', folder], check=True)
    try:
        yield
    finally:
        subprocess.run(['umount', folder], check=True)


def fill(path):
    with contextlib.suppress(OSError), open(path, 'wb', buffering=0) as file:
        while True:
            file.write(bytes(1024))


@fault(missing=lambda: '' if os.geteuid() == 0 else 'only root can make a small disk')
def full_disk(room):
    """The rig is saved to a full disk, over an older file."""
    yield 0.0
    folder = room.file('disk')
    path, filler = folder + '/rig.yaml', folder + '/filler'
    problems = []
    with small_disk(folder), Helper(answer_saves) as helper:
        if not helper.ask(path, PATIENCE)[0]:
            problems.append('not saved before')
        with open(path, 'rb') as file:
            before = file.read()
        fill(filler)
        success, sentence = helper.ask(path, PATIENCE)
        if success or 'space' not in sentence:
            problems.append(f'on a full disk: {sentence!r}')
        with open(path, 'rb') as file:
            if file.read() != before:
                problems.append('the older file was lost')
        problems += [f'left behind: {name}' for name in os.listdir(folder) if '.new' in name]
        os.remove(filler)
        if not helper.ask(path, PATIENCE)[0]:
            problems.append('not saved afterwards')
    return problems
