"""Writes rig.yaml from a RigCalibration: the documented example with other cameras."""

import copy

from wiimote_tracker_bringup.cameras_file import rig_example
from wiimote_tracker_bringup.files import write_yaml


def write_rig(path, rig):
    """rig: RigCalibration without covariance, as true_rig() makes it."""
    content = rig_example()
    (example,) = content['cameras'].values()
    cameras = {camera.name: changed(example, camera) for camera in rig.cameras}
    write_yaml(path, dict(content, solved_at=0.0, cameras=cameras, camera_order=list(cameras)))


def changed(example, camera):
    """The entry of a CameraCalibration in the frame of the example."""
    pose, entry = camera.world_from_camera, copy.deepcopy(example)
    entry.update(identity=camera.identity, image_width=camera.width, image_height=camera.height,
                 camera_name=camera.name, distortion_model=camera.distortion_model)
    entry['camera_matrix']['data'] = [camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy,
                                      0.0, 0.0, 1.0]
    entry['distortion_coefficients']['data'] = camera.distortion
    entry['extrinsics'].update(child_frame_id=camera.frame_id, transform={
        'translation': {axis: getattr(pose.position, axis) for axis in 'xyz'},
        'rotation': {axis: getattr(pose.orientation, axis) for axis in 'xyzw'}})
    return entry
