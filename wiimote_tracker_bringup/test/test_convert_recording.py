"""convert_recording reads the files of other programs, and writes them in its layout."""

import os
import subprocess
import sys

import numpy as np
import scipy.io

HERE = os.path.dirname(os.path.realpath(__file__))
PROGRAM = os.path.join(HERE, '..', 'import', 'convert_recording')

CAMERA = """[cameras.%d]
port = 0
size = [ 1280, 720,]
matrix = [ [ 1000.5, 0.0, 640,], [ 0.0, 1e+3, 360.0,], [ 0.0, 0.0, 1.0,],]
distortions = [ 0.1, -0.2, 1e-05, 0.0, 0.0,]
rotation = [ [ 0.0, -1.0, 0.0,], [ 1.0, 0.0, 0.0,], [ 0.0, 0.0, 1.0,],]
translation = [ 0.0, 0, 2.5,]
"""


def convert(kind, source, folder):
    return subprocess.run([sys.executable, PROGRAM, kind, str(source), str(folder)],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


def test_a_project_of_caliscope(tmp_path):
    (tmp_path / 'calibration' / 'extrinsic').mkdir(parents=True)
    (tmp_path / 'camera_array.toml').write_text(CAMERA % 0 + CAMERA % 3)
    (tmp_path / 'calibration' / 'extrinsic' / 'xy.csv').write_text(
        'sync_index,cam_id,object_id,keypoint_id,img_loc_x,img_loc_y\n'
        '0,0,0,0,10.5,20\n0,3,0,0,30,40.25\n1,3,0,0,50,60\n')
    folder = tmp_path / 'converted'
    done = convert('caliscope', tmp_path, folder)
    assert done.returncode == 0, done.stderr
    assert (folder / 'camera_order.txt').read_text().split() == ['cam_0', 'cam_3']
    assert np.loadtxt(folder / 'Res.dat').tolist() == [[1280, 720], [1280, 720]]
    np.testing.assert_equal(np.loadtxt(folder / 'points.dat'), [
        [10.5, np.nan], [20, np.nan], [1, np.nan], [30, 50], [40.25, 60], [1, 1]])
    projections = np.loadtxt(folder / 'Pmatrices.dat')
    np.testing.assert_allclose(projections[:3], [
        [0, -1000.5, 640, 1600], [1000, 0, 360, 900], [0, 0, 1, 2.5]])
    assert 'kc3 = 1e-05' in (folder / 'basename2.rad').read_text()


def test_a_broken_project_is_refused(tmp_path):
    (tmp_path / 'camera_array.toml').write_text((CAMERA % 0).replace('[ 0.1,', '[ 0.1 0.1,'))
    done = convert('caliscope', tmp_path, tmp_path / 'converted')
    assert done.returncode == 1
    assert done.stderr.startswith('convert_recording: ')


def test_the_dinosaur(tmp_path):
    matrices = np.random.RandomState(1).randn(3, 3, 4)
    cells = np.empty((1, 3), dtype=object)
    for i, matrix in enumerate(matrices):
        cells[0, i] = matrix
    scipy.io.savemat(str(tmp_path / 'dino_Ps.mat'), {'P': cells}, do_compression=True)
    np.savetxt(str(tmp_path / 'viff.xy'), [[1.5, 2.5, -1, -1, 5, 6]])
    folder = tmp_path / 'converted'
    done = convert('dinosaur', tmp_path, folder)
    assert done.returncode == 0, done.stderr
    np.testing.assert_equal(np.loadtxt(folder / 'Pmatrices.dat'), matrices.reshape(9, 4))
    np.testing.assert_equal(np.loadtxt(folder / 'points.dat'),
                            [1.5, 2.5, 1, np.nan, np.nan, np.nan, 5, 6, 1])
