"""track_bag on simulated recordings: results are compared with the truth, output is read by other
programs, and equal input gives equal bytes."""

import csv
import math
import os
import resource
import signal
import struct
import subprocess

import genpy
import numpy as np
import pytest
import rosbag
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from wiimote_tracker_msgs.msg import TrackedPoint, ZoneEvent

import recording
from recording import images, rig, seconds_of, time_of, trigger

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
    import io
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def all_bytes(messages):
    return [bytes_of(m) for m in messages]


def position(p):
    return np.array([p.x, p.y, p.z])


@pytest.fixture
def bag(tmp_path):
    """One LED for two seconds."""
    path = tmp_path / 'recorded.bag'
    write(path, recorded())
    return path


def test_one_led_is_found_where_it_was(bag, tmp_path):
    out = tmp_path / 'out.bag'
    output = track(bag, out)
    count = len(images(DURATION))
    assert '%d images' % count in output and ' 1 LEDs' in output
    points = arrays(out)
    assert len(points) > 0.9 * count
    tracked = 0
    for array in points:
        assert array.header.frame_id == 'world'
        assert array.method == 'track'
        t = seconds_of(array.header.stamp)
        for point in array.points:
            if point.state != TrackedPoint.TRACKED:
                continue
            tracked += 1
            assert point.label == 'led'
            error = position(point.position) - recording.walk(t)
            covariance = np.array(point.position_covariance).reshape(3, 3)
            # 0.2 px where the parameters say 0.5: far within five standard deviations.
            assert error @ np.linalg.solve(covariance, error) < 25
            assert np.linalg.norm(error) < 0.005
    assert tracked > 0.9 * count
    stamps = [a.header.stamp for a in points]
    assert stamps == sorted(set(stamps))


def test_every_point_has_its_topic_and_transform(bag, tmp_path):
    out = tmp_path / 'out.bag'
    track(bag, out)
    expected = [(a.header.stamp, position(p.position).tolist()) for a in arrays(out)
                for p in a.points if p.state == TrackedPoint.TRACKED]
    alone = arrays(out, '/led/point')
    assert [(p.header.stamp, position(p.point).tolist()) for p in alone] == expected
    transforms = [t for message in arrays(out, '/tf') for t in message.transforms]
    assert [(t.header.stamp, position(t.transform.translation).tolist()) for t in transforms] == \
        expected
    assert {(t.header.frame_id, t.child_frame_id) for t in transforms} == {('world', 'led')}


def test_two_leds_keep_their_identities(tmp_path):
    write(tmp_path / 'in.bag', recorded((recording.walk, recording.other)))
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    ways = {}
    for array in arrays(tmp_path / 'out.bag'):
        t = seconds_of(array.header.stamp)
        for point in array.points:
            if point.state == TrackedPoint.TRACKED:
                p = position(point.position)
                way = min((recording.walk, recording.other),
                          key=lambda w: np.linalg.norm(w(t) - p))
                assert np.linalg.norm(way(t) - p) < 0.01
                ways.setdefault(point.id, set()).add(way)
    assert sorted(len(w) for w in ways.values()) == [1, 1]


def fast(t):
    """3 m/s, 23 m/s^2."""
    return np.array([0.4 * math.cos(7.5 * t), 0.4 * math.sin(7.5 * t), 1.1 + 0.05 * math.sin(2 * t)])


def test_smoothing_changes_positions_and_velocities_only(tmp_path):
    write(tmp_path / 'in.bag', recorded((fast, recording.other), 4.0) +
          [('/trigger', trigger(1.0), 1.01)])
    (tmp_path / 'p.yaml').write_text(
        'pixel_stddev: 0.2\nlabels: [hand, foot]\ntracks: {stamp_stddev: 0.0}\n')
    for name, options in (('plain', []), ('smooth', ['--smooth'])):
        track(tmp_path / 'in.bag', tmp_path / (name + '.bag'), '--params', tmp_path / 'p.yaml',
              '--csv', tmp_path / (name + '.csv'), *options)
    squares = {}
    distances = []
    for plain, smooth in zip(arrays(tmp_path / 'plain.bag'), arrays(tmp_path / 'smooth.bag')):
        assert len(plain.points) == len(smooth.points)
        t = seconds_of(plain.header.stamp)
        for a, b in zip(plain.points, smooth.points):
            if a.state == TrackedPoint.TRACKED and 0.5 < t < 3.5:
                way = min((fast, recording.other),
                          key=lambda w: np.linalg.norm(w(t) - position(a.position)))
                error = position(b.position) - way(t)
                covariance = np.array(b.position_covariance).reshape(3, 3)
                distances.append(error @ np.linalg.solve(covariance, error))
                sums = squares.setdefault(way, np.zeros(2))
                sums += [np.sum((position(a.position) - way(t)) ** 2), error @ error]
            for field in ('position', 'position_covariance', 'velocity', 'velocity_covariance'):
                setattr(b, field, getattr(a, field))
        assert bytes_of(plain) == bytes_of(smooth)  # in all else
    assert len(squares) == 2
    for before, after in squares.values():
        assert after < 0.8 ** 2 * before
    assert 0.93 < np.mean(np.array(distances) < 7.815) < 0.985
    expected = [(a.header.stamp, position(p.position).tolist())
                for a in arrays(tmp_path / 'smooth.bag')
                for p in a.points if p.state == TrackedPoint.TRACKED and p.label == 'hand']
    assert expected == [(p.header.stamp, position(p.point).tolist())
                        for p in arrays(tmp_path / 'smooth.bag', '/hand/point')]
    answer, = arrays(tmp_path / 'smooth.bag', '/triggered_points')
    assert min(np.linalg.norm(fast(1.0) - position(p.position)) for p in answer.points) < 0.001
    rows = list(csv.DictReader(open(str(tmp_path / 'smooth.csv'), newline='')))
    assert len(rows) == len(list(open(str(tmp_path / 'plain.csv')))) - 1


def test_only_tracks_at_the_times_of_images_are_smoothed(bag, tmp_path):
    for parameters in ('mode: instant', 'output: {predict_to_now: true}'):
        (tmp_path / 'p.yaml').write_text(parameters + '\n')
        errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--smooth', '--params',
                         tmp_path / 'p.yaml')
        assert '--smooth' in errors


def test_the_same_bag_gives_the_same_bytes_with_any_number_of_threads(tmp_path):
    write(tmp_path / 'in.bag', recorded((recording.walk, recording.other)) +
          [('/trigger', trigger(1.0), 1.01)])
    contents = set()
    for i, threads in enumerate([1, 1, 2, 3, 8]):
        out = [tmp_path / ('%d.%s' % (i, end)) for end in ('bag', 'csv')]
        track(tmp_path / 'in.bag', out[0], '--csv', out[1], '--threads', threads)
        contents.add(tuple(path.read_bytes() for path in out))
    assert len(contents) == 1


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


def test_a_trigger_is_answered_at_its_exact_time(tmp_path):
    times = [0.5, 1.2345678, 1.5]
    write(tmp_path / 'in.bag', recorded() + [('/trigger', trigger(t), t + 0.02) for t in times])
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    answers = arrays(tmp_path / 'out.bag', '/triggered_points')
    assert [a.header.stamp for a in answers] == [time_of(t) for t in times]
    for answer, t in zip(answers, times):
        assert [p.label for p in answer.points] == ['led']
        assert np.linalg.norm(position(answer.points[0].position) - recording.walk(t)) < 0.005


def test_an_impossible_trigger_is_named(tmp_path):
    write(tmp_path / 'in.bag', recorded() + [('/trigger', trigger(-50), 1.0)])
    status, output, errors = run(tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert status == 0
    assert '0 triggers answered' in output
    assert 'older than the stored snapshots' in errors


def test_zones_are_entered_and_left(tmp_path):
    # The LED begins at x = 0.5 and crosses x = 0 upwards along y after pi / 2 s.
    write(tmp_path / 'in.bag', recorded(zones=[('right', (0, -1, 0), (1, 1, 2)),
                                               ('left', (-1, -1, 0), (0, 1, 2))], duration=2.5))
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    events = arrays(tmp_path / 'out.bag', '/zone_events')
    assert {(e.zone, e.event, e.label) for e in events} == {
        ('right', ZoneEvent.ENTERED, 'led'), ('right', ZoneEvent.LEFT, 'led'),
        ('left', ZoneEvent.ENTERED, 'led')}
    assert len(events) == 3
    for event in events:
        if (event.zone, event.event) != ('right', ZoneEvent.ENTERED):
            # At 0.5 m/s and an error of 5 mm.
            assert abs(seconds_of(event.header.stamp) - np.pi / 2) < 0.01
            assert abs(event.position.x) < 1e-9


def test_a_rig_takes_effect_where_it_was_recorded(tmp_path):
    """The second rig is twice as large, and from then on so is the world."""
    entries = recorded()
    change = 1 + len(entries) // 2
    entries.insert(change, ('/calibration/rig', rig(distance=8.0), entries[change][2] - 1e-5))
    write(tmp_path / 'in.bag', entries)
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    ids = [a.rig_id for a in arrays(tmp_path / 'out.bag')]
    assert len(set(ids)) == 2
    assert ids == sorted(ids, key=lambda i: i != ids[0])
    first_image = entries[change + 1][1]
    first = next(a for a in arrays(tmp_path / 'out.bag') if a.rig_id != ids[0])
    # The tracker counts seconds since 1970 in steps of 0.24 us.
    assert abs((first.latest_arrival - first_image.arrival).to_sec()) < 1e-6


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


def test_per_instant_mode(bag, tmp_path):
    track(bag, tmp_path / 'out.bag', '--mode', 'instant')
    points = [(seconds_of(a.header.stamp), p) for a in arrays(tmp_path / 'out.bag')
              for p in a.points]
    assert {a.method for a in arrays(tmp_path / 'out.bag')} == {'maximum_likelihood'}
    assert len(points) > 300
    for t, point in points:
        assert np.linalg.norm(position(point.position) - recording.walk(t)) < 0.01


def test_parameters_are_the_nodes(bag, tmp_path):
    (tmp_path / 'p.yaml').write_text('labels: [anna]\nmode: instant\n'
                                     'instant: {method: mean_closest}\nzones: {hysteresis: 1}\n')
    track(bag, tmp_path / 'out.bag', '--params', tmp_path / 'p.yaml')
    assert {a.method for a in arrays(tmp_path / 'out.bag')} == {'mean_closest'}
    assert len(arrays(tmp_path / 'out.bag', '/anna/point')) > 300
    shipped = os.path.join(os.environ['CONFIG'], 'triangulation.yaml')
    track(bag, tmp_path / 'shipped.bag', '--params', shipped)
    track(bag, tmp_path / 'default.bag')
    assert (tmp_path / 'shipped.bag').read_bytes() == (tmp_path / 'default.bag').read_bytes()


def test_a_namespace_is_kept(tmp_path):
    write(tmp_path / 'in.bag', [('/hall' + t, m, s) for t, m, s in recorded()])
    track(tmp_path / 'in.bag', tmp_path / 'out.bag')
    assert len(arrays(tmp_path / 'out.bag', '/hall/points')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/hall/led/point')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/tf')) > 300


def csv_rows(path):
    with open(str(path), newline='') as stream:
        return list(csv.DictReader(stream))


def expected_rows(out):
    """(stamp [ns], triggered, point) in the order of the bag."""
    rows = []
    for topic, array, _ in read(out, '/points', '/triggered_points'):
        rows += [(array.header.stamp.to_nsec(), topic == '/triggered_points', p)
                 for p in array.points]
    return rows


def same(a, b):
    """Bit for bit, but for the kind of NaN."""
    return struct.pack('<d', a) == struct.pack('<d', b) or (a != a and b != b)


def test_csv_holds_exactly_what_the_bag_holds(tmp_path):
    write(tmp_path / 'in.bag', recorded() + [('/trigger', trigger(1.0), 1.02)])
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--csv', tmp_path / 'out.csv')
    rows = csv_rows(tmp_path / 'out.csv')
    expected = expected_rows(tmp_path / 'out.bag')
    assert len(rows) == len(expected) > 300
    # A trigger's row may stand before or after the others of the same image.
    key = lambda r: (r[0], r[1], r[2].id)
    rows.sort(key=lambda r: (int(r['time [s]'].replace('.', '')), r['triggered'] == '1',
                             int(r['id'])))
    assert [r['triggered'] for r in rows].count('1') == 1
    states = ['tentative', 'tracked', 'predicted', 'lost']
    for row, (stamp, triggered, point) in zip(rows, sorted(expected, key=key)):
        assert int(row['time [s]'].replace('.', '')) == stamp
        assert (row['triggered'] == '1') == triggered
        assert (int(row['id']), row['label'], row['state']) == \
            (point.id, point.label, states[point.state])
        assert same(float(row['label_confidence']), point.label_confidence)
        assert row['label_since [s]'] == 'nan'
        for axis in 'xyz':
            assert same(float(row['%s [m]' % axis]), getattr(point.position, axis))
            assert same(float(row['v%s [m/s]' % axis]), getattr(point.velocity, axis))
        assert same(float(row['cov_xz [m^2]']), point.position_covariance[2])
        assert same(float(row['vcov_yz [m^2/s^2]']), point.velocity_covariance[5])
        assert same(float(row['residual [px]']), point.residual)
        assert same(float(row['age [s]']), point.age)


def test_matlab_file_holds_exactly_what_the_bag_holds(tmp_path):
    io = pytest.importorskip('scipy.io')
    write(tmp_path / 'in.bag', recorded() + [('/trigger', trigger(1.0), 1.02)])
    status, _, errors = run(tmp_path / 'in.bag', tmp_path / 'out.bag', '--mat', tmp_path / 'out.mat')
    if 'built without matio' in errors:
        pytest.skip('built without matio')
    assert status == 0, errors
    found = io.loadmat(str(tmp_path / 'out.mat'))
    key = lambda r: (r[0], r[1], r[2].id)
    expected = sorted(expected_rows(tmp_path / 'out.bag'), key=key)
    order = sorted(range(len(expected)),
                   key=lambda i: (found['stamp'][i, 0], found['triggered'][i, 0],
                                  found['id'][i, 0]))
    assert found['position'].shape == (len(expected), 3)
    labels = [found['labels'][i, 0][0] for i in range(len(found['labels']))]
    states = [found['states'][i, 0][0] for i in range(len(found['states']))]
    words = ['tentative', 'tracked', 'predicted', 'lost']
    for i, (stamp, triggered, point) in zip(order, expected):
        assert found['stamp'][i, 0] == stamp
        assert abs(found['time'][i, 0] - 1e-9 * stamp) < 1e-6
        assert found['triggered'][i, 0] == triggered
        assert found['id'][i, 0] == point.id
        assert labels[found['label'][i, 0] - 1] == point.label
        assert states[found['state'][i, 0] - 1] == words[point.state]
        assert same(found['label_confidence'][i, 0], point.label_confidence)
        assert found['label_since'][i, 0] == point.label_since.to_nsec()
        for axis, name in enumerate('xyz'):
            assert same(found['position'][i, axis], getattr(point.position, name))
            assert same(found['velocity'][i, axis], getattr(point.velocity, name))
        covariance = np.array(point.position_covariance).reshape(3, 3)
        assert np.array_equal(found['position_covariance'][:, :, i], covariance)
        assert found['rays_used'][i, 0] == point.rays_used
        assert same(found['residual'][i, 0], point.residual)
        assert found['last_observed'][i, 0] == point.last_observed.to_nsec()


# What goes wrong: one sentence, status 1, and no output bag.

def refused(tmp_path, *arguments, **keywords):
    status, _, errors = run(*arguments, **keywords)
    assert status == 1, errors
    assert not (tmp_path / 'out.bag').exists()
    assert not (tmp_path / 'out.bag.part').exists()
    assert 'Traceback' not in errors and errors.startswith('track_bag: ')
    return errors


def test_no_rig(tmp_path):
    write(tmp_path / 'in.bag', recorded()[1:])
    assert 'holds no rig: name a saved one with --rig' in refused(
        tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_a_bag_of_another_version_is_refused_in_words(bag, tmp_path):
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as old:
        for topic, message, time in read(bag):
            definition = message._full_text.replace('uint64 frame\n', '')
            old.write(topic, message, time, connection_header={
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


def test_rigs_of_two_trackers(tmp_path):
    write(tmp_path / 'in.bag', [('/%s%s' % (room, t), m, s) for room in ('a', 'b')
                                for t, m, s in recorded()])
    assert 'say whose with --namespace' in refused(tmp_path, tmp_path / 'in.bag',
                                                   tmp_path / 'out.bag')
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--namespace', 'b')
    assert len(arrays(tmp_path / 'out.bag', '/b/points')) > 300
    assert len(arrays(tmp_path / 'out.bag', '/a/points')) == 0


def test_an_unusable_rig(tmp_path):
    entries = recorded()
    entries[0][1].cameras[0].fx = -1.0
    write(tmp_path / 'in.bag', entries)
    assert 'no rig can be used' in refused(tmp_path, tmp_path / 'in.bag', tmp_path / 'out.bag')


def test_a_rig_of_other_cameras(tmp_path):
    write(tmp_path / 'in.bag', [(t.replace('camera', 'foreign'), m, s) for t, m, s in recorded()])
    assert 'no image is of a camera of the rig' in refused(tmp_path, tmp_path / 'in.bag',
                                                           tmp_path / 'out.bag')


def test_parameters_that_the_node_would_refuse(bag, tmp_path):
    for text, words in [('lables: [led]\n', 'unknown parameter'), ('mode: guess\n', 'one of'),
                        ('zones: {hysteresis: -1}\n', 'zones/hysteresis is -1'),
                        ('a: [\n', 'cannot be read as YAML'), ('mode:\n', 'without a value')]:
        (tmp_path / 'p.yaml').write_text(text)
        errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--params', tmp_path / 'p.yaml')
        assert words in errors and 'p.yaml' in errors
    assert 'none.yaml' in refused(tmp_path, bag, tmp_path / 'out.bag', '--params', 'none.yaml')


def test_a_disk_that_is_full(bag, tmp_path):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (200000, 200000))
    for threads in (1, 3):
        errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--threads', threads,
                         preexec_fn=limit, restore_signals=False)
        assert 'make room there' in errors


def test_a_folder_that_cannot_be_created(bag, tmp_path):
    (tmp_path / 'file').write_text('')
    assert 'choose another place' in refused(tmp_path, bag, tmp_path / 'file' / 'out.bag')


def test_usage():
    for arguments in [(), ('a.bag',), ('a.bag', 'b.bag', 'c.bag'), ('a.bag', 'b.bag', '--mode'),
                      ('a.bag', 'b.bag', '--threads', '0'), ('a.bag', 'b.bag', '--fast')]:
        status, _, errors = run(*arguments)
        assert status == 2 and 'usage: track_bag' in errors
    status, output, _ = run('--help')
    assert status == 0 and 'usage: track_bag' in output
