"""C3D, TRC and TUM files of track_bag on simulated recordings, read by readers of their own."""

import os
import subprocess

import numpy as np
import pytest
import rosbag
import yaml

import c3d
import recording
from recording import images, rig, seconds_of, time_of
from wiimote_tracker_msgs.msg import TrackedBody, TrackedBodyArray

PROGRAM = os.environ['TRACK_BAG']
RATE = 60.0
HIDDEN = (1.0, 1.3)
NOWHERE = np.array([0.0, 0.0, -50.0])  # below the floor, where no camera looks


def hidden_for_a_while(t):
    return NOWHERE if HIDDEN[0] <= t < HIDDEN[1] else recording.other(t)


@pytest.fixture(scope='module')
def files(tmp_path_factory):
    """The folder with in.bag and what track_bag made of it."""
    folder = tmp_path_factory.mktemp('trajectories')
    with rosbag.Bag(str(folder / 'in.bag'), 'w') as bag:
        bag.write('/calibration/rig', rig(), time_of(-0.1))
        for image in images(2.0, (recording.walk, hidden_for_a_while)):
            bag.write('/%s/ir_blobs' % image.camera, image, image.arrival)
    (folder / 'parameters.yaml').write_text(yaml.safe_dump({'labels': ['left', 'right']}))
    said = subprocess.check_output([PROGRAM, 'in.bag', 'out.bag', '--params', 'parameters.yaml',
                                    '--c3d', 'out.c3d', '--trc', 'out.trc', '--rate', str(RATE)],
                                   cwd=str(folder), universal_newlines=True)
    (folder / 'said').write_text(said)
    return folder


def first_stamp(files):
    """Of the first frame: of the first tracked LED."""
    with rosbag.Bag(str(files / 'out.bag')) as bag:
        return next(m.header.stamp for _, m, _ in bag.read_messages('/points')
                    if any(p.state == p.TRACKED for p in m.points))


def start_of(files):
    """Time of the first frame [s after START]."""
    return seconds_of(first_stamp(files))


def check(labels, positions, start):
    """Positions [m], frames x LEDs x 3: those of the truth, and gaps where an LED was hidden."""
    assert sorted(labels) == ['left', 'right']
    times = start + np.arange(len(positions)) / RATE
    assert times[-1] == pytest.approx(2.0, abs=0.05)
    truths = [np.array([way(t) for t in times]) for way in (recording.walk, recording.other)]
    ways = []
    for column in positions.transpose(1, 0, 2):
        errors = [np.linalg.norm(column - truth, axis=1) for truth in truths]
        way = int(np.nanmedian(errors[0]) > np.nanmedian(errors[1]))
        assert np.nanmax(errors[way]) < 0.01
        known = np.isfinite(column).all(axis=1)
        assert np.isnan(column[~known]).all(), 'a position is whole or missing'
        was_hidden = (times > HIDDEN[0] + 0.06) & (times < HIDDEN[1])
        if way == 0:
            assert known[times > 0.2].all()
        else:
            assert not known[was_hidden].any()
            assert known[(times > 0.2) & (times < HIDDEN[0] - 0.02)].all()
            assert known[times > HIDDEN[1] + 0.3].all()
        ways.append(way)
    assert sorted(ways) == [0, 1]


def test_c3d(files):
    found = c3d.read(files / 'out.c3d')
    assert (found.rate, found.units, found.analog) == (RATE, 'mm', 0)
    stamp = first_stamp(files)
    assert found.start == '%d.%09d' % (stamp.secs, stamp.nsecs)
    for name in ('out.c3d', 'out.trc'):
        assert f'{name}: frame 1 is at {found.start} s since 1970.' in (files / 'said').read_text()
    check(found.labels, found.positions / 1000.0, start_of(files))


def read_trc(path):
    """Header, labels and frames x LEDs x 3 positions, by OpenSim's description: three lines of
    header, names, axes, an empty line, rows."""
    lines = path.read_text().split('\n')
    assert lines[0].split('\t') == ['PathFileType', '4', '(X/Y/Z)', path.name]
    header = dict(zip(lines[1].split('\t'), lines[2].split('\t')))
    names = lines[3].split('\t')
    assert names[:2] == ['Frame#', 'Time']
    labels = [name for name in names[2:] if name]
    assert lines[4].split('\t')[2:] == [
        f'{axis}{i + 1}' for i in range(len(labels)) for axis in 'XYZ']
    assert lines[5] == '' and lines[-1] == ''
    rows = [line.split('\t') for line in lines[6:-1]]
    assert len(rows) == int(header['NumFrames']) and len(labels) == int(header['NumMarkers'])
    assert [int(row[0]) for row in rows] == list(range(1, len(rows) + 1))
    times = np.arange(len(rows)) / float(header['DataRate'])
    assert np.allclose([float(row[1]) for row in rows], times, atol=1e-6)
    positions = np.array([[float(cell) if cell else np.nan for cell in row[2:]] for row in rows])
    return header, labels, positions.reshape(len(rows), -1, 3)


def test_trc(files):
    header, labels, positions = read_trc(files / 'out.trc')
    assert header['Units'] == 'm'
    assert float(header['DataRate']) == float(header['CameraRate']) == RATE
    check(labels, positions, start_of(files))


BODY = np.array([[0.05, 0.09, 0.07], [-0.02, 0.02, -0.05],
                 [-0.07, -0.07, 0.03], [0.06, -0.05, -0.05]])


@pytest.fixture
def wand(tmp_path):
    """The folder with in.bag and bodies.yaml."""
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as bag:
        bag.write('/calibration/rig', rig(), time_of(-0.1))
        bag.write('/bodies', TrackedBodyArray(bodies=[TrackedBody(name='wand')]), time_of(0.0))
        for image in images(1.0, [lambda t, led=led: recording.walk(t) + led for led in BODY]):
            bag.write('/%s/ir_blobs' % image.camera, image, image.arrival)
    (tmp_path / 'bodies.yaml').write_text(yaml.safe_dump({
        'format': 'wiimote_tracker_bodies', 'version': 1,
        'bodies': [{'name': 'wand', 'leds': BODY.tolist()}]}))
    return tmp_path


def test_leds_of_a_body(wand):
    """They are where its pose has them, from the first pose on."""
    subprocess.check_call([PROGRAM, 'in.bag', 'out.bag', '--bodies', 'bodies.yaml', '--c3d',
                           'out.c3d', '--trc', 'out.trc'], cwd=str(wand),
                          stdout=subprocess.DEVNULL)
    found = c3d.read(wand / 'out.c3d')
    with rosbag.Bag(str(wand / 'out.bag')) as bag:
        first = next(m for _, m, _ in bag.read_messages('/bodies') if m.bodies)
    assert found.start == '%d.%09d' % (first.header.stamp.secs, first.header.stamp.nsecs)
    times = seconds_of(first.header.stamp) + np.arange(len(found.positions)) / 100.0
    assert times[-1] == pytest.approx(1.0, abs=0.05)
    leds = [f'wand:{i}' for i in range(len(BODY))]
    for labels, positions in [(found.labels, found.positions / 1000.0),
                              read_trc(wand / 'out.trc')[1:]]:
        assert labels == leds
        truth = np.array([recording.walk(t) + BODY for t in times])
        assert np.linalg.norm(positions - truth, axis=2)[20:].max() < 0.01


def test_tum_of_a_body(wand):
    """Without --bodies its LEDs are single ones, and the user is told."""
    def track(*arguments):
        return subprocess.run([PROGRAM, 'in.bag', 'out.bag', '--tum', 'poses', *arguments],
                              cwd=str(wand), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              universal_newlines=True)

    assert "had a body 'wand'" in track().stderr
    assert not (wand / 'poses').exists()
    assert 'no file other.yaml' in track('--bodies', 'other.yaml').stderr
    (wand / 'p.yaml').write_text(yaml.safe_dump({'bodies': {'file': 'misspelt.yaml'}}))
    assert f'There is no file {wand}/misspelt.yaml, so' in track('--params', 'p.yaml').stderr
    assert track('--bodies', 'bodies.yaml').stderr == ''
    rows = np.loadtxt(wand / 'poses' / 'wand.tum')[20:]
    times = rows[:, 0] - recording.START
    assert len(rows) > 300 and times[-1] > 0.9
    errors = rows[:, 1:4] - np.array([recording.walk(t) for t in times])
    assert np.sqrt((errors ** 2).sum(axis=1).mean()) < 0.003
    assert np.abs(rows[:, 4:7]).max() < 0.05 and rows[:, 7].min() > 0.99


def test_an_empty_recording_gives_empty_files(tmp_path):
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as bag:
        bag.write('/calibration/rig', rig(), time_of(-0.1))
        for image in images(0.1, (lambda t: NOWHERE,)):
            bag.write('/%s/ir_blobs' % image.camera, image, image.arrival)
    subprocess.check_call([PROGRAM, 'in.bag', 'out.bag', '--c3d', 'out.c3d', '--trc', 'out.trc',
                           '--tum', 'poses'], cwd=str(tmp_path), stdout=subprocess.DEVNULL)
    found = c3d.read(tmp_path / 'out.c3d')
    assert (found.labels, found.start) == ([], None)
    assert '\t0\t0\tm\t' in (tmp_path / 'out.trc').read_text()
    assert not (tmp_path / 'poses').exists()


def test_tum_without_bodies_says_that_it_writes_nothing(files, tmp_path):
    done = subprocess.run([PROGRAM, str(files / 'in.bag'), 'out.bag', '--tum', 'tum'],
                          cwd=str(tmp_path), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                          universal_newlines=True)
    assert done.returncode == 0
    assert '--tum writes nothing without bodies: name their file with --bodies' in done.stderr
    assert not (tmp_path / 'tum').exists()


def test_tum_says_that_no_body_was_tracked(files, wand):
    said = subprocess.check_output([PROGRAM, str(files / 'in.bag'), 'out.bag', '--tum', 'poses',
                                    '--bodies', 'bodies.yaml'],
                                   cwd=str(wand), universal_newlines=True)
    assert 'poses: no files, since no body was tracked: check' in said
    assert not (wand / 'poses').exists()
