"""The tables that track_bag writes hold what its bag holds."""

import csv
import struct

import numpy as np
import pytest

from program import arrays, entries_of, read, recorded, run, track, write
from recording import images, rig, trigger, walk


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
        for axes, i in (('xx', 0), ('xy', 1), ('xz', 2), ('yy', 4), ('yz', 5), ('zz', 8)):
            assert same(float(row['cov_%s [m^2]' % axes]), point.position_covariance[i])
            assert same(float(row['vcov_%s [m^2/s^2]' % axes]), point.velocity_covariance[i])
        assert (int(row['rays_used']), int(row['rays_possible'])) == \
            (point.rays_used, point.rays_possible)
        assert same(float(row['residual [px]']), point.residual)
        assert int(row['last_observed [s]'].replace('.', '')) == point.last_observed.to_nsec()
        assert same(float(row['age [s]']), point.age)


BODIES = """
format: wiimote_tracker_bodies
version: 1
bodies:
  - {name: arm, leds: [[0.05, 0.09, 0.07], [-0.02, 0.02, -0.05], [-0.07, -0.07, 0.03]]}
"""
ARM = np.array([[0.05, 0.09, 0.07], [-0.02, 0.02, -0.05], [-0.07, -0.07, 0.03]])


@pytest.fixture
def arm(tmp_path):
    """A recording of a body, and the arguments of track_bag for it."""
    write(tmp_path / 'in.bag', [('/calibration/rig', rig(), -0.1)] + entries_of(
        images(1.0, [lambda t, led=led: walk(t) + led for led in ARM])))
    (tmp_path / 'bodies.yaml').write_text(BODIES)
    return tmp_path / 'in.bag', tmp_path / 'out.bag', '--bodies', tmp_path / 'bodies.yaml'


def expected_poses(out):
    """(stamp [ns], body) in the order of the bag."""
    return [(array.header.stamp.to_nsec(), body) for array in arrays(out, '/bodies')
            for body in array.bodies]


def vector(v, axes='xyz'):
    return [getattr(v, axis) for axis in axes]


def test_csv_holds_the_poses_of_bodies(arm, tmp_path):
    track(*arm, '--csv', tmp_path / 'out.csv')
    rows = csv_rows(tmp_path / 'out_bodies.csv')
    expected = expected_poses(tmp_path / 'out.bag')
    assert len(rows) == len(expected) > 300
    triangle = np.triu_indices(6)
    for row, (stamp, body) in zip(rows, expected):
        cells = list(row.values())
        assert int(row['time [s]'].replace('.', '')) == stamp
        assert (row['body'], row['state'], row['frame']) == ('arm', 'tracked', 'world')
        numbers = [float(cell) for cell in cells[3:-4]]
        truth = (vector(body.pose.pose.position) + vector(body.pose.pose.orientation, 'xyzw') +
                 vector(body.twist.twist.linear) + vector(body.twist.twist.angular) +
                 list(np.reshape(body.pose.covariance, (6, 6))[triangle]) +
                 list(np.reshape(body.twist.covariance, (6, 6))[triangle]) + [body.residual])
        assert len(numbers) == len(truth) and all(map(same, numbers, truth))
        assert int(row['last_observed [s]'].replace('.', '')) == body.last_observed.to_nsec()
        assert same(float(row['age [s]']), body.age)


def test_matlab_file_holds_the_poses_of_bodies(arm, tmp_path):
    io = pytest.importorskip('scipy.io')
    status, _, errors = run(*arm, '--mat', tmp_path / 'out.mat')
    if 'built without matio' in errors:
        pytest.skip('built without matio')
    assert status == 0, errors
    table = io.loadmat(str(tmp_path / 'out.mat'))['bodies']
    found = {name: table[name][0, 0] for name in table.dtype.names}
    expected = expected_poses(tmp_path / 'out.bag')
    assert found['position'].shape == (len(expected), 3) and len(expected) > 300
    assert found['names'][0, 0][0] == 'arm' and (found['name'] == 1).all()
    for i, (stamp, body) in enumerate(expected):
        assert found['stamp'][i, 0] == stamp
        assert abs(found['time'][i, 0] - 1e-9 * stamp) < 1e-6
        assert list(found['position'][i]) == vector(body.pose.pose.position)
        assert list(found['quaternion'][i]) == vector(body.pose.pose.orientation, 'xyzw')
        assert list(found['velocity'][i]) == vector(body.twist.twist.linear)
        assert list(found['angular_velocity'][i]) == vector(body.twist.twist.angular)
        for kind in ('pose', 'twist'):
            assert np.array_equal(found[kind + '_covariance'][:, :, i],
                                  np.reshape(getattr(body, kind).covariance, (6, 6)))
        assert same(found['residual'][i, 0], body.residual)
        assert found['last_observed'][i, 0] == body.last_observed.to_nsec()


def test_matlab_file_holds_exactly_what_the_bag_holds(tmp_path):
    io = pytest.importorskip('scipy.io')
    write(tmp_path / 'in.bag', recorded() + [('/trigger', trigger(1.0), 1.02)])
    status, _, errors = run(tmp_path / 'in.bag', tmp_path / 'out.bag', '--mat',
                            tmp_path / 'out.mat')
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
