"""evaluate_recording on simulated consumer cameras: of several rates, with drifting clocks that start
at different times, and with lines that are read one by one. The path is that of a waving hand."""

import os
import sys

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, '..', 'evaluation')]

import simulated_cameras  # noqa: E402
from wiimote_tracker_evaluation.errors import ExperimentError  # noqa: E402
from wiimote_tracker_evaluation.foreign import (cameras, flight, ordinary, time_maps)  # noqa: E402
from wiimote_tracker_evaluation.foreign.rig import Rig  # noqa: E402


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
    with open(solved) as file:
        content = yaml.safe_load(file)
    for number, camera in enumerate(content['cameras'].values()):
        rotation = Rotation.from_matrix(simulated.rotations[number]).as_quat().tolist()
        camera['extrinsics']['transform'] = {
            'translation': dict(zip('xyz', simulated.centers[number].tolist())),
            'rotation': dict(zip('xyzw', rotation))}
        camera['time_offset'] = 0.0
    with open(path, 'w') as file:
        yaml.safe_dump(content, file, sort_keys=False)
    return Rig(path)


def test_clocks_and_path_are_found(tmp_path):
    simulated = simulated_cameras.Cameras(*hand())
    simulated.write(str(tmp_path), np.random.RandomState(1))
    views = cameras.read(str(tmp_path))
    maps = time_maps.solve(views, str(tmp_path))
    exact = []
    for number, (camera, each) in enumerate(zip(views.cameras, maps)):
        exact.append(true_times(simulated, number, camera))
        assert np.abs(each.times(camera) - exact[-1]).max() < 0.002, camera.name

    found = time_maps.mapped(views, maps)
    result, _, _ = flight.evaluate(found, str(tmp_path))
    assert result['tracked'] > 0.95
    for camera, times in zip(views.cameras, exact):
        camera.times = times  # in order: no line waits for a frame
    rig = exact_rig(simulated, str(tmp_path / 'rig.yaml'), str(tmp_path / 'exact.yaml'))
    bound, _, _ = flight.score(views, rig, ordinary.track(views, rig, str(tmp_path)))
    assert result['rms_mm'] < 1.1 * bound['rms_mm']


def test_refusals_say_which_file(tmp_path):
    with pytest.raises(ExperimentError, match='cameras.yaml cannot be read'):
        cameras.read(str(tmp_path))
    simulated_cameras.Cameras(*hand()).write(str(tmp_path), np.random.RandomState(1))
    (tmp_path / 'detections.csv').write_text('camera,frame,u\nc0,1,2\nc0,2,3\n')
    with pytest.raises(ExperimentError, match='its columns are camera,frame,u,v'):
        cameras.read(str(tmp_path))
