"""evaluate_recording on simulated consumer cameras: of several rates, with drifting clocks that
start at different times, and with lines that are read one by one. The path is that of a waving
hand.

As a program: test_evaluate_recording_cameras.py PATH.csv SEED..., rows time, x, y, z in s and m:
errors with each seed of the noise, beside those with the true poses and times."""

import os
import sys
import tempfile

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [HERE, *(os.path.join(HERE, '..', folder) for folder in (
    'body_motion', 'evaluation', 'python'))]

import simulated_cameras  # noqa: E402
from wiimote_tracker_bringup.errors import Refusal  # noqa: E402
from wiimote_tracker_bringup.files import read_rig, write_yaml  # noqa: E402
from wiimote_tracker_evaluation.recordings import cameras, flight, pipeline, time_maps  # noqa: E402
from wiimote_tracker_evaluation.recordings.solved_rig import Rig  # noqa: E402


def hand():
    """Times [s] and positions [m] at 60 Hz, about 1 m/s."""
    times = np.arange(0.0, 12.0, 1.0 / 60.0)
    return times, [0.0, 0.0, 1.1] + np.column_stack([
        0.5 * np.sin(1.7 * times) + 0.15 * np.sin(4.1 * times + 1.0),
        0.4 * np.sin(1.3 * times + 0.5) + 0.15 * np.cos(3.7 * times),
        0.35 * np.sin(2.1 * times + 2.0) + 0.1 * np.sin(5.3 * times)])


def true_times(simulated, number, camera):
    """When its images were exposed, by the clock of the first camera [s]."""
    frames = np.rint((camera.times - cameras.BEGIN) * simulated_cameras.CLOCKS[number][0])
    _, drift, start, read_out = simulated_cameras.CLOCKS[number]
    step = (1.0 + drift) / simulated_cameras.CLOCKS[number][0]
    lines = 0.0 if camera.lines is None else camera.lines
    _, first_drift, first_start, _ = simulated_cameras.CLOCKS[0]
    since = (start + step * frames + read_out * lines - first_start) / (1.0 + first_drift)
    return cameras.BEGIN + since


def exact_rig(simulated, solved, path):
    """The solved rig with the true poses, its clocks and noise left as they are."""
    content = read_rig(solved)
    for number, camera in enumerate(content['cameras'].values()):
        rotation = Rotation.from_matrix(simulated.rotations[number]).as_quat().tolist()
        camera['extrinsics']['transform'] = {
            'translation': dict(zip('xyz', simulated.centers[number].tolist())),
            'rotation': dict(zip('xyzw', rotation))}
        camera['time_offset'] = 0.0
    write_yaml(path, content)
    return Rig(path)


def solved(simulated, folder):
    """The figures of `evaluate_recording cameras`, the same with the true poses and times, and the
    largest error of an image's time [s]."""
    views = cameras.read(folder)
    maps = time_maps.solve(views, folder)
    exact = [true_times(simulated, number, camera) for number, camera in enumerate(views.cameras)]
    worst = max(np.abs(each.times(camera) - times).max()
                for camera, each, times in zip(views.cameras, maps, exact))
    result, _, _ = flight.evaluate(time_maps.mapped(views, maps), folder)
    for camera, times in zip(views.cameras, exact):
        camera.times = times  # in order: no line waits for a frame
    rig = exact_rig(simulated, os.path.join(folder, 'rig.yaml'), os.path.join(folder, 'exact.yaml'))
    bound, smoothed = (flight.score(views, rig, pipeline.track(views, rig, folder, smooth))[0]
                       for smooth in (False, True))
    return result, dict(bound, smoothed=smoothed), worst


def test_clocks_and_path_are_found(tmp_path):
    simulated = simulated_cameras.Cameras(*hand())
    simulated.write(str(tmp_path), np.random.RandomState(1))
    result, bound, worst = solved(simulated, str(tmp_path))
    assert worst < 0.002
    assert result['tracked'] > 0.95
    assert result['rms_mm'] < 1.1 * bound['rms_mm']
    # The tracker expects motions in m/s^2, and one light has no scale: 3 m from the cameras.
    away = np.linalg.norm(simulated.positions[:, None] - simulated.centers, axis=2)
    assert result['scale'] == pytest.approx(np.median(away) / 3.0, rel=0.02)


def test_refusals_say_which_file(tmp_path):
    with pytest.raises(Refusal, match='cameras.yaml cannot be read'):
        cameras.read(str(tmp_path))
    simulated_cameras.Cameras(*hand()).write(str(tmp_path), np.random.RandomState(1))
    (tmp_path / 'detections.csv').write_text('camera,frame,u\nc0,1,2\nc0,2,3\n')
    with pytest.raises(Refusal, match='its columns are camera,frame,u,v'):
        cameras.read(str(tmp_path))
    lens = dict.fromkeys(cameras.KEYS, 1.0)
    for wrong in ({'distortion': [0.1, 0.0, 0.0, 0.0]}, {'distortion': 0.1},
                  {'distortion': [0.0] * 5, 'fx': 0.0}):
        (tmp_path / 'cameras.yaml').write_text(yaml.safe_dump({'c0': dict(lens, **wrong)}))
        with pytest.raises(Refusal, match='cameras.yaml cannot be read.*each camera needs'):
            cameras.read(str(tmp_path))


if __name__ == '__main__':
    table = np.loadtxt(sys.argv[1], delimiter=',', skiprows=1)
    for seed in map(int, sys.argv[2:]):
        with tempfile.TemporaryDirectory() as own:
            light = simulated_cameras.Cameras(table[:, 0], table[:, 1:4])
            light.write(own, np.random.RandomState(seed))
            found, best, error = solved(light, own)
        for what, figures, least in (('one point', found, best),
                                     ('smoothed', found['smoothed'], best['smoothed'])):
            print('seed %d, %s: RMS %.2f mm, with the true poses and times %.2f mm, %.1f %% in the '
                  'ellipsoid, images off by %.1f ms at most' % (
                      seed, what, figures['rms_mm'], least['rms_mm'],
                      100.0 * figures['coverage_95'], 1e3 * error))
