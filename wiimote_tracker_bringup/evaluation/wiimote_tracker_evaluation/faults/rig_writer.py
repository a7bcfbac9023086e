"""Writes rig.yaml from a RigCalibration, independent of the tracker's own writer."""

from wiimote_tracker_bringup.cameras_file import rig_format
from wiimote_tracker_bringup.files import write_yaml

PLANE = ('x', 'y', 'z')


def write_rig(path, rig):
    """rig: RigCalibration without covariance, as true_rig() makes it."""
    content = {
        **rig_format(), 'world_frame': rig.header.frame_id,
        'solved_at': 0.0, 'method': rig.method, 'verdict': '', 'ray_model': 'calibrated',
        'virtual_hfov': float('nan'), 'square_sides': [], 'led_height': float('nan'),
        'camera_order': [camera.name for camera in rig.cameras],
        'cameras': {camera.name: _camera(camera, rig.header.frame_id) for camera in rig.cameras},
        'zones': [], 'covariance': {'rows': 0, 'cols': 0, 'data': []}, 'complete': True}
    write_yaml(path, content)


def _camera(camera, world):
    position, turn = camera.world_from_camera.position, camera.world_from_camera.orientation
    return {
        'identity': camera.identity, 'image_width': camera.width, 'image_height': camera.height,
        'camera_name': camera.name,
        'camera_matrix': _matrix(3, 3, [camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy,
                                        0.0, 0.0, 1.0]),
        'distortion_model': camera.distortion_model,
        'distortion_coefficients': _matrix(1, len(camera.distortion), camera.distortion),
        'extrinsics': {
            'header': {'frame_id': world}, 'child_frame_id': camera.frame_id,
            'transform': {
                'translation': {axis: float(getattr(position, axis)) for axis in PLANE},
                'rotation': {axis: float(getattr(turn, axis)) for axis in PLANE + ('w',)}}},
        'time_offset': float('nan'), 'time_offset_rule': 'none', 'time_offset_epoch': 0,
        'gravity': [], 'masks': [], 'residual_px': float('nan'), 'residual_m': float('nan'),
        'observations': 0, 'inliers': 0}


def _matrix(rows, columns, data):
    return {'rows': rows, 'cols': columns, 'data': [float(value) for value in data]}
