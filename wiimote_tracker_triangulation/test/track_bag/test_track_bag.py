"""track_bag on simulated recordings: results are compared with the truth."""

import csv
import math
import os

import numpy as np
from wiimote_tracker_msgs.msg import TrackedPoint, ZoneEvent

import recording
from program import DURATION, arrays, bytes_of, position, recorded, refused, run, track, write
from recording import images, rig, seconds_of, time_of, trigger


def test_one_led_is_found_where_it_was(bag, tmp_path):
    out = tmp_path / 'out.bag'
    output = track(bag, out)
    count = len(images(DURATION))
    assert 'Images: %d (' % count in output and ' LEDs: 1,' in output
    assert 'Images out of the order of their exposures (normal): ' in output
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
    return np.array([0.4 * math.cos(7.5 * t), 0.4 * math.sin(7.5 * t),
                     1.1 + 0.05 * math.sin(2 * t)])


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


def test_smoothing_uses_the_spots_that_began_a_track(tmp_path):
    """Two cameras see the LED in two images each, every half second."""
    entries = [entry for entry in recorded((fast,), 20.0)
               if not any(name in entry[0] for name in recording.NAMES[2:])]
    seen = set()
    for _, image, _ in entries[1:]:
        t = seconds_of(image.header.stamp)
        if t % 0.5 < 0.02:
            seen.add(round(t, 6))
        else:
            image.blobs = []
    write(tmp_path / 'in.bag', entries)
    (tmp_path / 'p.yaml').write_text(
        'pixel_stddev: 0.2\ntracks: {stamp_stddev: 0.0, birth_pixel_stddev: 10.0, '
        'confirmation_hits: 2, prediction_time: 0.1}\n')
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--params', tmp_path / 'p.yaml', '--smooth')
    errors = []
    for array in arrays(tmp_path / 'out.bag'):
        t = round(seconds_of(array.header.stamp), 6)
        errors += [np.linalg.norm(position(p.position) - fast(t)) for p in array.points
                   if t in seen and p.state != TrackedPoint.LOST]
    assert len(errors) > 120
    assert np.sqrt(np.mean(np.square(errors))) < 0.003


def test_smoothing_keeps_the_errors_of_the_calibration_where_the_led_is_hidden(tmp_path):
    """All cameras may be off by the same shift, which then shifts every point."""
    stddev, hidden_at = 0.05, 1.0
    messages = recorded((recording.walk,), 2.0)
    per_camera = 3 + 3 + 4 + 5 + 1
    covariance = np.zeros((len(recording.NAMES), per_camera, len(recording.NAMES), per_camera))
    for axis in (3, 4, 5):
        covariance[:, axis, :, axis] = stddev ** 2
    for _, message, _ in messages:
        if hasattr(message, 'cameras'):
            message.covariance = covariance.ravel().tolist()
        elif seconds_of(message.header.stamp) > hidden_at:
            message.blobs = []
    write(tmp_path / 'in.bag', messages)
    track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--smooth')
    after = [point for array in arrays(tmp_path / 'out.bag') for point in array.points
             if point.state == TrackedPoint.PREDICTED
             and seconds_of(array.header.stamp) > hidden_at]
    assert len(after) > 10
    for point in after:
        stated = np.array(point.position_covariance).reshape(3, 3)
        assert np.linalg.eigvalsh(stated)[0] > 0.99 * stddev ** 2


def test_only_tracks_at_the_times_of_images_are_smoothed(bag, tmp_path):
    for parameters in ('mode: instant', 'output: {predict_to_now: true}'):
        (tmp_path / 'p.yaml').write_text(parameters + '\n')
        errors = refused(tmp_path, bag, tmp_path / 'out.bag', '--smooth', '--params',
                         tmp_path / 'p.yaml')
        assert '--smooth' in errors


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
    assert 'triggers answered: 0' in output
    assert 'older than the stored snapshots' in errors


def test_a_trigger_with_a_fixed_stamp_is_named_twice(tmp_path):
    write(tmp_path / 'in.bag', recorded() +
          [('/trigger', trigger(-50), 0.5 + 0.005 * i) for i in range(200)])
    _, _, errors = run(tmp_path / 'in.bag', tmp_path / 'out.bag')
    first, second = [line for line in errors.splitlines() if 'no points for' in line]
    assert 'no points for the trigger at 1599999950' in first
    assert 'no points for 199 triggers' in second and 'all had one stamp' in second


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


def test_labels_of_the_recording_that_are_not_given(bag, tmp_path):
    (tmp_path / 'p.yaml').write_text('labels: [anna]\n')
    track(bag, tmp_path / 'anna.bag', '--params', tmp_path / 'p.yaml')
    again = [tmp_path / 'anna.bag', tmp_path / 'again.bag']
    assert "had an LED 'anna', which gets another name now" in run(*again)[2]
    assert run(*again, '--params', tmp_path / 'p.yaml')[2] == ''
    track(bag, tmp_path / 'led.bag')
    assert run(tmp_path / 'led.bag', tmp_path / 'again.bag')[2] == ''


def test_parameters_may_be_those_of_the_launch_file(bag, tmp_path):
    for number, text in enumerate((
            'triangulation: {mode: instant, labels: [anna]}\n', 'triangulation/labels: [anna]\n',
            '/triangulation: {labels: [anna]}\ntriangulation: {output/rate: 20}\n')):
        (tmp_path / 'p.yaml').write_text('calibration: {side_length: 2.0}\n' + text)
        status, _, errors = run(bag, tmp_path / f'{number}.bag', '--params', tmp_path / 'p.yaml')
        assert status == 0 and errors == ''
        assert len(arrays(tmp_path / f'{number}.bag', '/anna/point')) > 300


def test_parameters_that_nobody_reads_are_told(bag, tmp_path):
    for text, words in [
            ('triangulation: {mode: instant}\npixel_stddev: 0.2\nb: {c: 1}\n',
             'no node is called b, pixel_stddev: write parameters of triangulation below that'),
            ('calibration: {side_length: 2.0}\n', 'has no parameters of triangulation: write them'),
            ('calibration: {}\ntriangulation: 5\n', 'has no parameters of triangulation'),
            ('# none\n', 'has no parameters of triangulation')]:
        (tmp_path / 'p.yaml').write_text(text)
        status, _, errors = run(bag, tmp_path / 'out.bag', '--params', tmp_path / 'p.yaml')
        assert status == 0 and len(errors.splitlines()) == 1
        assert 'p.yaml' in errors and words in errors
