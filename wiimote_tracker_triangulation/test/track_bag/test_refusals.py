"""What track_bag refuses: in one sentence, with status 1, and without an output bag."""

import fcntl
import os
import resource
import signal
import subprocess
import time

import pytest
import rosbag

from program import PROGRAM, arrays, read, recorded, refused, run, track, write
from recording import rig


def test_no_rig(tmp_path):
    write(tmp_path / 'in.bag', recorded()[1:])
    assert 'holds no rig: name a saved one with --rig' in refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_a_bag_of_another_version_is_refused_in_words(bag, tmp_path):
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as old:
        for topic, message, received in read(bag):
            definition = message._full_text.replace('uint64 frame\n', '')
            old.write(topic, message, received, connection_header={
                'topic': topic, 'type': message._type, 'message_definition': definition,
                'md5sum': '0' * 32 if topic.endswith('/ir_blobs') else message._md5sum})
    sentence = refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert 'another version of wiimote_tracker_msgs/IrBlobArray: convert' in sentence


def test_no_images(tmp_path):
    write(tmp_path / 'in.bag', recorded()[:1])
    assert 'holds no images' in refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_no_such_file_and_no_bag(tmp_path):
    assert 'name a bag' in refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')
    (tmp_path / 'in.bag').write_text('not a bag')
    assert 'cannot be read as a bag' in refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')
    (tmp_path / 'loop.bag').symlink_to('loop.bag')
    assert 'name a bag' in refused(tmp_path, tmp_path / 'loop.bag', tmp_path / 'out.bag')


def test_a_recording_that_was_cut_off(bag, tmp_path):
    content = bytearray(bag.read_bytes())
    # As while recording: the header does not say yet where the index is.
    start = content.index(b'index_pos=') + len(b'index_pos=')
    content[start:start + 8] = bytes(8)
    (tmp_path / 'cut.bag').write_bytes(content)
    assert 'repair it with rosbag reindex' in refused(tmp_path, tmp_path / 'cut.bag',
                                                      tmp_path / 'out.bag')


def test_the_same_file_twice(bag, tmp_path):
    before = bag.read_bytes()
    assert 'write to another one' in refused(tmp_path, bag, bag)
    (tmp_path / 'link.bag').symlink_to(bag)
    assert 'write to another one' in refused(tmp_path, bag, tmp_path / 'link.bag')
    assert bag.read_bytes() == before


def test_a_table_over_another_file(bag, tmp_path):
    before = bag.read_bytes()
    (tmp_path / 'rig.yaml').write_text('rig')
    out = tmp_path / 'out.bag'
    for arguments in [('--csv', bag), ('--mat', out), ('--rig', tmp_path / 'rig.yaml', '--c3d',
                                                       tmp_path / 'rig.yaml'),
                      ('--csv', tmp_path / 'a', '--trc', str(tmp_path) + '/./a')]:
        assert 'write to another one' in refused(tmp_path, bag, out, *arguments)
    assert bag.read_bytes() == before and (tmp_path / 'rig.yaml').read_text() == 'rig'


def test_a_table_over_a_file_of_bodies(bag, tmp_path):
    """Also over one that the parameters name, and over a body's trajectory."""
    bodies = tmp_path / 'bodies.yaml'
    bodies.write_text('format: wiimote_tracker_bodies\nversion: 1\nbodies: [{name: wand, leds: '
                      '[[0, 0, 0], [0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.15]]}]\n')
    before = bodies.read_text()
    (tmp_path / 'p.yaml').write_text('bodies: {file: "%s"}\n' % bodies)
    for arguments in [('--bodies', bodies, '--csv', bodies),
                      ('--params', tmp_path / 'p.yaml', '--csv', bodies),
                      ('--params', tmp_path / 'p.yaml', '--tum', tmp_path / 'poses', '--trc',
                       tmp_path / 'poses' / 'wand.tum')]:
        assert 'write to another one' in refused(tmp_path, bag, tmp_path / 'out.bag', *arguments)
    assert bodies.read_text() == before


def test_rigs_of_two_trackers(tmp_path):
    write(tmp_path / 'in.bag', [('/%s%s' % (room, t), m, s) for room in ('a', 'b')
                                for t, m, s in recorded()])
    assert 'say whose with --namespace' in refused(tmp_path, tmp_path / 'in.bag',
                                                   tmp_path / 'out.bag')
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--namespace', 'b')
    assert len(arrays(tmp_path / 'out.bag', '/b/points')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/a/points')) == 0
    (tmp_path / 'out.bag').unlink()
    refusal = refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag', '--namespace', 'c', '--csv',
        tmp_path / 'out.csv', '--trc', tmp_path / 'out.trc')
    assert ('no rig is on /c/calibration/rig, but on /a/calibration/rig, /b/calibration/rig'
            in refusal)


def test_an_unusable_rig(tmp_path):
    entries = recorded()
    entries[0][1].cameras[0].fx = -1.0
    write(tmp_path / 'in.bag', entries)
    assert 'no rig can be used' in refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_a_rig_file_that_does_not_exist(bag, tmp_path):
    assert 'No such file or directory); check its name' in refused(
        tmp_path, bag, tmp_path / 'out.bag', '--rig', tmp_path / 'missing.yaml')


def test_a_rig_of_other_cameras(tmp_path):
    write(tmp_path / 'in.bag', [(t.replace('camera', 'foreign'), m, s) for t, m, s in recorded()])
    assert 'no image is of a camera of the rig' in refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag', '--csv', tmp_path / 'out.csv')


def test_images_of_other_devices_of_these_names(tmp_path):
    entries = recorded()
    for camera in entries[0][1].cameras:
        camera.identity = '00:1f:32:00:00:01'
    for _, image, _ in entries[1:]:
        image.identity = '00:1f:32:00:00:02'
    write(tmp_path / 'in.bag', entries)
    assert 'no image could be used, as said above: name the rig of its cameras' in refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_a_rig_after_all_images(tmp_path):
    entries = recorded()
    write(tmp_path / 'in.bag', entries[1:] + [entries[0][:2] + (9.0,)])
    assert 'the rig comes after all images of its cameras: name a rig with --rig' in refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_parameters_that_the_node_would_refuse(bag, tmp_path):
    for text, words in [('lables: [led]\n', 'unknown parameter'), ('mode: guess\n', 'one of'),
                        ('zones: {hysteresis: -1}\n', 'zones/hysteresis is -1'),
                        ('triangulation: {mod: x}\n', 'p.yaml/triangulation/mod'),
                        ('calibraton: {sounds: true}\n', 'p.yaml/calibraton/sounds'),
                        ('tracks: 1\ntracks/gat: 2\n', 'p.yaml/tracks/gat'),
                        ('mode: tracks\n---\nmode: x\n', 'holds several YAML documents'),
                        ('a: [\n', 'cannot be read as YAML'), ('mode:\n', 'without a value')]:
        (tmp_path / 'p.yaml').write_text(text)
        errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--params', tmp_path / 'p.yaml')
        assert words in errors and 'p.yaml' in errors
    assert 'none.yaml' in refused(tmp_path, bag, tmp_path / 'out.bag', '--params', 'none.yaml')


@pytest.mark.parametrize('left', [200000, 0])
def test_a_disk_that_is_full(bag, tmp_path, left):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (left, left))
    errors = refused(tmp_path, bag, tmp_path / 'out.bag', preexec_fn=limit, restore_signals=False)
    assert 'make room there' in errors


def test_a_folder_that_cannot_be_created(bag, tmp_path):
    (tmp_path / 'file').write_text('')
    assert 'choose another place' in refused(tmp_path, bag, tmp_path / 'file' / 'out.bag')


@pytest.mark.parametrize('name', ['out.bag', 'out.csv'])
def test_two_programs_do_not_write_one_file(bag, tmp_path, name):
    out, part, other = tmp_path / 'out.bag', tmp_path / (name + '.part'), {
        'out.bag': 'out.csv', 'out.csv': 'out.bag'}[name]
    with open(str(part), 'w') as file:
        file.write('of the other program')
        file.flush()
        fcntl.flock(file, fcntl.LOCK_EX)
        status, _, errors = run(bag, out, '--csv', tmp_path / 'out.csv')
        assert status == 1 and 'another program writes' in errors and not out.exists()
        assert part.read_text() == 'of the other program'
        assert not (tmp_path / (other + '.part')).exists()
    track(bag, out, '--csv', tmp_path / 'out.csv')  # over what it left
    assert not part.exists() and len(arrays(out)) > 300
    assert (tmp_path / 'out.csv.part.bak').exists() == (name == 'out.csv')


def test_ctrl_c_leaves_no_part_of_a_file(tmp_path):
    newer = rig()
    newer.format_version += 1
    # Said to the test, which does not listen yet: the program cannot end before the signal.
    refusals = [('/calibration/rig', newer, 0.001 * i) for i in range(1500)]
    write(tmp_path / 'in.bag', recorded() + refusals)
    process = subprocess.Popen(
        [PROGRAM, str(tmp_path / 'in.bag'), str(tmp_path / 'out.bag'), '--csv',
         str(tmp_path / 'out.csv')], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    while not (tmp_path / 'out.csv.part').exists():
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    process.communicate()
    assert process.returncode == -signal.SIGINT
    assert not list(tmp_path.glob('out*'))


def test_a_pipe_is_not_replaced(bag, tmp_path):
    os.mkfifo(str(tmp_path / 'pipe'))
    errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--csv', tmp_path / 'pipe')
    assert 'it is a device or a pipe: name a file' in errors
    assert 'name a file' in refused(tmp_path, bag, tmp_path / 'pipe')
    assert 'name a file' in refused(tmp_path, bag, tmp_path / 'out.bag', '--csv',
                                    tmp_path / 'made.csv', '--trc', tmp_path / 'pipe')
    assert (tmp_path / 'pipe').is_fifo()


def test_usage():
    for arguments in [(), ('a.bag',), ('a.bag', 'b.bag', 'c.bag'), ('a.bag', 'b.bag', '--mode'),
                      ('a.bag', 'b.bag', '--rate', '0'), ('a.bag', 'b.bag', '--fast')]:
        status, _, errors = run(*arguments)
        assert status == 2 and 'usage: track_bag' in errors
    status, _, errors = run('a.bag', 'b.bag', '--mode', 'track')
    assert status == 2 and '--mode must be tracks or instant' in errors
    status, output, _ = run('--help')
    assert status == 0 and 'usage: track_bag' in output
