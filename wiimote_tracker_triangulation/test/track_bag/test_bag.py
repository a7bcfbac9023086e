"""The bag that track_bag writes: of the same bytes for equal input, and as rosbag writes it."""

import re
import struct

import genpy
import numpy as np
import rosbag
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

import recording
from program import all_bytes, arrays, bytes_of, position, read, recorded, run, track, write
from recording import seconds_of, time_of, trigger


def test_the_recording_is_kept_without_earlier_results(bag, tmp_path):
    track(bag, tmp_path / 'first.bag')
    stranger = TransformStamped()
    stranger.header.frame_id, stranger.child_frame_id = 'world', 'robot'
    own = TransformStamped()
    own.header.frame_id, own.child_frame_id = 'world', 'led'
    entries = [(t, m, seconds_of(s)) for t, m, s in read(tmp_path / 'first.bag')]
    entries += [('/note', String(data='kept'), 0.5), ('/tf', TFMessage([stranger]), 0.6),
                ('/tf', TFMessage([own, stranger]), 0.7), ('/tf', TFMessage([own]), 0.8),
                ('/robot/point', String(data='not ours'), 0.9)]
    entries.sort(key=lambda e: e[2])
    write(tmp_path / 'in.bag', entries)
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    kept = read(tmp_path / 'out.bag')
    for topic in ('/points', '/led/point'):
        assert all_bytes(arrays(tmp_path / 'out.bag', topic)) == \
            all_bytes(arrays(tmp_path / 'first.bag', topic))
    assert [m.data for t, m, _ in kept if t == '/note'] == ['kept']
    assert [m.data for t, m, _ in kept if t == '/robot/point'] == ['not ours']
    others = [[t.child_frame_id for t in m.transforms] for t, m, _ in kept if t == '/tf']
    assert others.count(['robot']) == 2
    assert len(others) == 2 + len(arrays(tmp_path / 'first.bag', '/tf'))
    blobs = [(t, bytes_of(m), s) for t, m, s in kept if t.endswith('/ir_blobs')]
    assert blobs == [(t, bytes_of(m), s) for t, m, s in read(bag) if t.endswith('/ir_blobs')]

    track(tmp_path / 'in.bag', tmp_path / 'results.bag', '--results-only')
    assert {t for t, _, _ in read(tmp_path / 'results.bag')} == {'/points', '/led/point', '/tf'}


def times_of_chunks(bag):
    """The recorded times in each chunk, by the index."""
    times = {chunk.pos: [] for chunk in bag._chunks}
    for entries in bag._connection_indexes.values():
        for entry in entries:
            times[entry.chunk_pos].append(entry.time.to_nsec())
    return [times[chunk.pos] for chunk in bag._chunks]


def test_the_new_bag_is_like_those_of_rosbag(tmp_path):
    write(tmp_path / 'in.bag', recorded((recording.walk, recording.other), duration=2.5))
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')

    def raw(messages):
        return [(topic, message[0], message[1], message[2], time.to_nsec())
                for topic, message, time in messages]
    with rosbag.Bag(str(tmp_path / 'out.bag')) as out:
        expected = raw(out.read_messages(raw=True))
        assert len(out._chunks) > 1
        assert [(c.start_time.to_nsec(), c.end_time.to_nsec()) for c in out._chunks] == [
            (min(times), max(times)) for times in times_of_chunks(out)]
        # Random access by the index.
        middle = expected[len(expected) // 2][4]
        assert raw(out.read_messages(raw=True, start_time=genpy.Time(0, middle))) == \
            [m for m in expected if m[4] >= middle]
        counts = {topic: info.message_count
                  for topic, info in out.get_type_and_topic_info().topics.items()}
    assert counts == {topic: [m[0] for m in expected].count(topic) for topic in counts}
    # Without its index it is repaired as any other.
    content = bytearray((tmp_path / 'out.bag').read_bytes())
    start = content.index(b'index_pos=') + len(b'index_pos=')
    end = struct.unpack('<Q', content[start:start + 8])[0]
    content[start:start + 8] = bytes(8)
    (tmp_path / 'cut.bag').write_bytes(content[:end])
    with rosbag.Bag(str(tmp_path / 'cut.bag'), 'a', allow_unindexed=True) as cut:
        for _ in cut.reindex():
            pass
    with rosbag.Bag(str(tmp_path / 'cut.bag')) as cut:
        assert raw(cut.read_messages(raw=True)) == expected


def test_a_latched_rig_stays_latched(bag, tmp_path):
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as copy:
        for topic, message, time in read(bag):
            header = None
            if topic == '/calibration/rig':
                header = {'topic': topic, 'latching': '1', 'type': message._type,
                          'md5sum': message._md5sum, 'message_definition': message._full_text}
            copy.write(topic, message, time, connection_header=header)
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    with rosbag.Bag(str(tmp_path / 'out.bag')) as out:
        headers = [c.header for c in out._get_connections(['/calibration/rig'])]
    assert [h.get('latching') for h in headers] in (['1'], [b'1'])


def test_a_rig_file_serves_a_bag_without_rig(bag, tmp_path):
    write(tmp_path / 'in.bag', recorded()[1:])
    (tmp_path / 'rig.yaml').write_text(recording.rig_yaml())
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--rig', tmp_path / 'rig.yaml')
    track(bag, tmp_path / 'expected.bag')
    expected, found = arrays(tmp_path / 'expected.bag'), arrays(tmp_path / 'out.bag')
    assert len(expected) == len(found) > 100
    for a, b in zip(expected, found):
        assert a.header.stamp == b.header.stamp and len(a.points) == len(b.points)
        for p, q in zip(a.points, b.points):
            # The orientations went through text.
            assert np.linalg.norm(position(p.position) - position(q.position)) < 1e-9
    rigs = read(tmp_path / 'out.bag', '/calibration/rig')
    assert len(rigs) == 1 and rigs[0][1].id == found[0].rig_id
    # The new bag needs no file.
    track(tmp_path / 'out.bag', tmp_path / 'again.bag')
    assert all_bytes(arrays(tmp_path / 'again.bag')) == all_bytes(found)


def test_a_namespace_is_kept(tmp_path):
    write(tmp_path / 'in.bag', [('/hall' + t, m, s) for t, m, s in recorded()])
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert len(arrays(tmp_path / 'out.bag', '/hall/points')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/hall/led/point')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/tf')) > 300


def test_the_same_bag_gives_the_same_bytes(tmp_path):
    write(tmp_path / 'in.bag', recorded((recording.walk, recording.other)) +
          [('/trigger', trigger(1.0), 1.01)])
    contents = set()
    for i in range(3):
        out = [tmp_path / ('%d.%s' % (i, end)) for end in ('bag', 'csv')]
        track(tmp_path / 'in.bag', out[0], '--csv', out[1])
        contents.add(tuple(path.read_bytes() for path in out))
    assert len(contents) == 1


def test_images_before_the_first_rig_are_counted(bag, tmp_path):
    """The rig was calibrated while the bag was recorded. An image of a stranger does not count."""
    entries = recorded()
    entries[0] = entries[0][:2] + (0.805,)
    stranger = entries[1]
    entries.append(('/stranger/ir_blobs',) + stranger[1:])
    write(tmp_path / 'in.bag', sorted(entries, key=lambda e: e[2]))
    early = sum(t.endswith('ir_blobs') and s < 0.805 for t, _, s in recorded())
    output = track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert output.startswith('Images: %d (' % (len(entries) - 2))  # without rig and stranger
    assert ('Images before the first rig, without points: %d; name a rig with --rig' % early
            in output)
    assert 'before the first rig' not in track(bag, tmp_path / 'whole.bag')
    assert len(arrays(tmp_path / 'out.bag')) < len(arrays(tmp_path / 'whole.bag'))


def test_a_clock_that_was_set_back_is_told(tmp_path):
    entries = recorded()
    for _, image, seconds in entries[1:]:
        if seconds > 0.8 and image.camera == 'camera_2':
            image.header.stamp -= genpy.Duration(0, 300000000)
            image.arrival -= genpy.Duration(0, 300000000)
    write(tmp_path / 'in.bag', entries)
    status, _, errors = run(tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert status == 0
    assert re.search(r'from 1600000000\.5\d+ s on, images of two times are mixed on '
                     r'/camera_2/ir_blobs', errors)


def test_only_arrivals_decide_the_order(bag, tmp_path):
    """Neither the order of recording nor the recorder's clock."""
    track(bag, tmp_path / 'out.bag')
    expected = all_bytes(arrays(tmp_path / 'out.bag'))
    entries = recorded()
    random = np.random.RandomState(2)
    # Every message is recorded up to 0.1 s late, and the recorder's clock is a day ahead.
    shifted = [entries[0]] + [(topic, message, time + random.uniform(0, 0.1))
                              for topic, message, time in entries[1:]]
    with rosbag.Bag(str(tmp_path / 'disorder.bag'), 'w') as disorder:
        for topic, message, time in sorted(shifted, key=lambda e: e[2]):
            disorder.write(topic, message, time_of(time) + genpy.Duration(86400))
    assert [m.arrival for t, m, _ in read(tmp_path / 'disorder.bag') if 'ir_blobs' in t] != \
        [m.arrival for t, m, _ in read(bag) if 'ir_blobs' in t]
    track(tmp_path / 'disorder.bag', tmp_path / 'out2.bag')
    assert all_bytes(arrays(tmp_path / 'out2.bag')) == expected
