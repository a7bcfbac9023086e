"""Damaged files, through the service that loads them; a full disk, through the one that saves."""

import contextlib
import os
import random
import subprocess
import tempfile

from wiimote_tracker_evaluation.faults.fault import fault
from wiimote_tracker_evaluation.faults.helper import Helper

STEP = 5         # of truncation [%]
FLIPS = 2000     # files with a few changed bytes
SEED = 1
LARGE = 100 << 20  # of a file [bytes]
SAVES = 20


def answer_calls(pipe, verb):
    """Loads or saves (verb) the rig at each path that comes; answers success and sentence."""
    import rospy
    from wiimote_tracker_msgs.srv import LoadRig, SaveRig
    service = 'calibration/' + verb
    rospy.wait_for_service(service, 30.0)
    call = rospy.ServiceProxy(service, {'load': LoadRig, 'save': SaveRig}[verb])
    while True:
        response = call(pipe.recv())
        pipe.send((response.success, response.message))


def load_all(room, contents):
    """Loads damaged files, by name, and then the whole one. Returns the names of those that were
    loaded, and what went wrong."""
    loaded, problems = [], []
    path = room.file('damaged.yaml')
    with Helper(answer_calls, 'load') as helper:
        for name, content in contents:
            with open(path, 'wb') as file:
                file.write(content)
            success, sentence = helper.ask(path)
            if success:
                loaded.append(name)
                helper.ask(room.file('rig.yaml'))
            elif not sentence:
                problems.append(f'{name}: refused without a reason')
        if not helper.ask(room.file('rig.yaml'))[0]:
            problems.append('the whole file is refused afterwards')
    return loaded, problems


@fault(quick=True)
def truncated_rig_files(room):
    """Rig files cut off at every 5 %."""
    yield 0.0
    whole = room.rig_bytes()
    loaded, problems = load_all(room, (
        (f'cut at {percent} %', whole[:len(whole) * percent // 100])
        for percent in range(0, 100, STEP)))
    return problems + [f'{name}: loaded' for name in loaded]


@fault(wrong_allowed=True)
def changed_rig_files(room):
    """Rig files with random bytes changed; another digit is another rig, which cannot be told."""
    yield 0.0
    whole, randomness = room.rig_bytes(), random.Random(SEED)

    def changed():
        content = bytearray(whole)
        for _ in range(randomness.randint(1, 8)):
            content[randomness.randrange(len(content))] = randomness.randrange(256)
        return bytes(content)
    return load_all(room, ((f'change {number}', changed()) for number in range(FLIPS)))[1]


@fault(quick=True)
def files_that_are_no_rig(room):
    """Loaded are a pipe, a device, a folder, 100 MB, and rigs of the years 1969 and 3e10."""
    yield 0.0
    pipe, large = room.file('pipe.yaml'), room.file('large.yaml')
    os.mkfifo(pipe)
    whole = room.rig_bytes()
    with open(large, 'wb') as file:
        file.write(whole)
        file.truncate(LARGE)
    paths = [pipe, large, '/dev/zero', room.folder]
    for number, time in enumerate((b'-1.0', b'5e9', b'1e18')):
        paths.append(room.file(f'solved_{number}.yaml'))
        with open(paths[-1], 'wb') as file:
            file.write(whole.replace(b'solved_at: 0.0', b'solved_at: ' + time))
    with Helper(answer_calls, 'load') as helper:
        answers = {path: helper.ask(path) for path in paths}
    return [f'{path}: {sentence!r}' for path, (success, sentence) in answers.items()
            if success or not sentence]


@fault()
def two_saves_at_once(room):
    """Two programs save the rig to one file, 20 times each."""
    yield 0.0
    path = room.file('saved.yaml')
    problems = []
    with Helper(answer_calls, 'save') as one, Helper(answer_calls, 'save') as other:
        for _ in range(SAVES):
            for helper in (one, other):
                helper.pipe.send(path)
            for helper in (one, other):
                success, sentence = helper.answer()
                if not success:
                    problems.append(sentence)
    with Helper(answer_calls, 'load') as helper:
        problems += [f'{name} cannot be loaded' for name in sorted(os.listdir(room.folder))
                     if name.startswith('saved') and not helper.ask(room.file(name))[0]]
        helper.ask(room.file('rig.yaml'))
    return problems


@contextlib.contextmanager
def small_disk(folder):
    subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=256k', 'tmpfs', folder], check=True,
                   stderr=subprocess.PIPE)
    try:
        yield
    finally:
        subprocess.run(['umount', folder], check=True)


def why_no_disk():
    """Why there can be no small disk here; empty: there can."""
    if os.geteuid() != 0:
        return 'only root can make a small disk'
    with tempfile.TemporaryDirectory() as folder:
        try:
            with small_disk(folder):
                return ''
        except (OSError, subprocess.CalledProcessError) as error:
            return f'no small disk can be made: {error}'


def fill(path):
    with contextlib.suppress(OSError), open(path, 'wb', buffering=0) as file:
        while True:
            file.write(bytes(1024))


@fault(why_not=why_no_disk)
def full_disk(room):
    """The rig is saved to a full disk, over an older file."""
    yield 0.0
    folder = room.file('disk')
    os.mkdir(folder)
    path, filler = folder + '/rig.yaml', folder + '/filler'
    problems = []
    with small_disk(folder), Helper(answer_calls, 'save') as helper:
        if not helper.ask(path)[0]:
            problems.append('not saved before')
        with open(path, 'rb') as file:
            before = file.read()
        fill(filler)
        success, sentence = helper.ask(path)
        if success or 'space' not in sentence:
            problems.append(f'on a full disk: {sentence!r}')
        with open(path, 'rb') as file:
            if file.read() != before:
                problems.append('the older file was lost')
        problems += [f'left behind: {name}' for name in os.listdir(folder) if '.part' in name]
        os.remove(filler)
        if not helper.ask(path)[0]:
            problems.append('not saved afterwards')
    return problems
