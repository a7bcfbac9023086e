"""convert_recording reads the files of other programs, and writes them in its layout."""

import os
import subprocess
import sys

import numpy as np
import pytest
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

# As java.beans.XMLEncoder writes it. The names of rotation and translation depend on the version.
STEREO = """<?xml version="1.0" encoding="UTF-8"?>
<java version="1.7.0_17" class="java.beans.XMLDecoder">
 <object class="boofcv.struct.calib.StereoParameters">
  <void property="left">%s</void>
  <void property="right">%s</void>
  <void property="rightToLeft">
   <object class="georegression.struct.se.Se3_F64">
    <void property="%s"><void property="data">%s</void></void>
    <void property="%s">
     <void property="x"><double>0.5</double></void>
     <void property="y"><double>0.25</double></void>
     <void property="z"><double>-0.125</double></void>
    </void>
   </object>
  </void>
 </object>
</java>
"""
LENS = """
   <object class="boofcv.struct.calib.IntrinsicParameters">
    <void property="cx"><double>%d</double></void>
    <void property="cy"><double>240.5</double></void>
    <void property="flipY"><boolean>true</boolean></void>
    <void property="fx"><double>500.0</double></void>
    <void property="fy"><double>510.0</double></void>
    <void property="height"><int>480</int></void>
    <void property="radial"><array class="double" length="2">%s</array></void>
    <void property="skew"><double>0.75</double></void>
    <void property="width"><int>640</int></void>
   </object>
  """


def java_doubles(values):
    return ''.join('<void index="%d"><double>%r</double></void>' % item
                   for item in enumerate(values))


def write_stereo(folder, rotation='R', translation='T'):
    """The right camera is turned by a quarter about its axis: its x is the left one's y."""
    quarter = [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    (folder / 'stereo.xml').write_text(STEREO % (
        LENS % (320, java_doubles([-0.25, 0.125])), LENS % (330, java_doubles([-0.5, 0.375])),
        rotation, java_doubles(quarter), translation))


def convert(kind, source, folder, *options):
    return subprocess.run([sys.executable, PROGRAM, kind, str(source), str(folder), *options],
                          capture_output=True, text=True)


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


def test_files_that_are_cut_off_are_refused_in_words(tmp_path):
    (tmp_path / 'calibration' / 'extrinsic').mkdir(parents=True)
    (tmp_path / 'camera_array.toml').write_text(CAMERA % 0)
    (tmp_path / 'calibration' / 'extrinsic' / 'xy.csv').write_text(
        'sync_index,cam_id,object_id,keypoint_id,img_loc_x,img_loc_y\n0,0,0,0,10.5\n')
    (tmp_path / 'stereo.xml').write_text('<java></java>')
    for kind, error in (('caliscope', 'TypeError'), ('boofcv', 'IndexError')):
        done = convert(kind, tmp_path, tmp_path / 'converted')
        assert done.returncode == 1
        assert done.stderr.startswith(f'convert_recording: {error}: ')
        assert 'Traceback' not in done.stderr


@pytest.mark.parametrize('names', ['RT', 'rt'])
def test_a_stereo_calibration_of_boofcv(tmp_path, names):
    source = tmp_path / 'stereo [1]'
    source.mkdir()
    write_stereo(source, *names)
    (source / 'left2.txt').write_text('10.5 20\n30 40.25\n')
    (source / 'left10.txt').write_text('50 60\n')
    (source / 'right2.txt').write_text('70 80\n90 100\n')
    (source / 'left_corners.txt').write_text('all of them\n')  # not read
    folder = tmp_path / 'converted'
    done = convert('boofcv', source, folder)
    assert done.returncode == 0, done.stderr
    assert (folder / 'camera_order.txt').read_text().split() == ['left', 'right']
    assert np.loadtxt(folder / 'Res.dat').tolist() == [[640, 480], [640, 480]]
    # Image by image, corner by corner; y points down.
    np.testing.assert_equal(np.loadtxt(folder / 'points.dat'), [
        [10.5, 30, 50], [460, 439.75, 420], [1, 1, 1],
        [70, 90, np.nan], [400, 380, np.nan], [1, 1, np.nan]])
    lens = (folder / 'basename2.rad').read_text().splitlines()
    assert lens == [
        'K11 = 500.0', 'K12 = 0.75', 'K13 = 330.0', 'K21 = 0.0', 'K22 = 510.0', 'K23 = 240.5',
        'K31 = 0.0', 'K32 = 0.0', 'K33 = 1.0',
        'kc1 = -0.5', 'kc2 = 0.375', 'kc3 = 0.0', 'kc4 = 0.0', 'kc5 = 0.0']
    assert 'kc1 = -0.25' in (folder / 'basename1.rad').read_text()
    # The world is the left camera. There, the right one's (0.1, 0.2, 2) is turned and shifted.
    left, right = np.loadtxt(folder / 'Pmatrices.dat').reshape(2, 3, 4)
    point = [-0.2 + 0.5, 0.1 + 0.25, 2.0 - 0.125]
    np.testing.assert_allclose(left.dot(point + [1.0]), [
        500.0 * point[0] + 0.75 * point[1] + 320.0 * point[2],
        510.0 * point[1] + 240.5 * point[2], point[2]])
    np.testing.assert_allclose(right.dot(point + [1.0]), [
        500.0 * 0.1 + 0.75 * 0.2 + 330.0 * 2.0, 510.0 * 0.2 + 240.5 * 2.0, 2.0])


def test_corners_of_boofcv_in_one_file(tmp_path):
    write_stereo(tmp_path)
    (tmp_path / 'left01.txt').write_text('1 2\n')  # not read
    corners = tmp_path / 'corners.txt'
    corners.write_text('left10.jpg 1 50 60\nleft2.jpg 2 10.5 20 30 40.25\nright2.jpg 1 70 80\n')
    folder = tmp_path / 'converted'
    done = convert('boofcv', tmp_path, folder, '--points', str(corners))
    assert done.returncode == 0, done.stderr
    np.testing.assert_equal(np.loadtxt(folder / 'points.dat'), [
        [10.5, 30, 50], [460, 439.75, 420], [1, 1, 1],
        [70, np.nan, np.nan], [400, np.nan, np.nan], [1, np.nan, np.nan]])


def test_a_stereo_calibration_without_a_pose_is_refused(tmp_path):
    write_stereo(tmp_path)
    stereo = tmp_path / 'stereo.xml'
    stereo.write_text(stereo.read_text().replace('"rightToLeft"', '"leftToRight"'))
    done = convert('boofcv', tmp_path, tmp_path / 'converted')
    assert done.returncode == 1
    assert done.stderr.startswith("convert_recording: KeyError: 'rightToLeft'")
    assert not (tmp_path / 'converted').exists()


def test_a_source_without_files_and_a_folder_that_exists(tmp_path):
    done = convert('boofcv', tmp_path, tmp_path / 'converted')
    assert done.returncode == 1
    assert 'stereo.xml' in done.stderr and '--help names the files' in done.stderr
    assert 'FileNotFoundError' not in done.stderr
    write_stereo(tmp_path)
    done = convert('boofcv', tmp_path, tmp_path)
    assert done.returncode == 1 and 'exists: name a new folder' in done.stderr


def test_only_boofcv_has_a_file_of_corners(tmp_path):
    done = convert('dinosaur', tmp_path, tmp_path / 'converted', '--points', 'corners.txt')
    assert done.returncode == 2
    assert '--points is for boofcv only' in done.stderr


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
