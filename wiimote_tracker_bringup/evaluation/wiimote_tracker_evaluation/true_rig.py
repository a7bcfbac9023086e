"""The true rig, for experiments that do not test calibration."""

import numpy as np
from wiimote_tracker_msgs.msg import CameraCalibration, RigCalibration


def quaternion(rotation: np.ndarray) -> np.ndarray:
    """x, y, z, w of a rotation matrix."""
    # Eigenvector of the largest eigenvalue of a symmetric matrix (Bar-Itzhack 2000).
    (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = rotation.T
    k = np.array([[xx - yy - zz, xy + yx, xz + zx, zy - yz],
                  [xy + yx, yy - xx - zz, yz + zy, xz - zx],
                  [xz + zx, yz + zy, zz - xx - yy, yx - xy],
                  [zy - yz, xz - zx, yx - xy, xx + yy + zz]]) / 3.0
    return np.linalg.eigh(k)[1][:, -1]


def true_rig(scene, identities):
    """RigCalibration of a scene's exact cameras; identities: by camera name."""
    rig = RigCalibration(format_version=RigCalibration.FORMAT_VERSION, id='', method='true',
                         ray_model=RigCalibration.RAY_MODEL_CALIBRATED,
                         virtual_hfov=float('nan'), led_height=float('nan'))
    rig.header.frame_id = 'world'
    for camera in scene.cameras:
        fx, fy, cx, cy, k1 = camera.parameters
        message = CameraCalibration(
            name=camera.name, identity=identities[camera.name],
            frame_id=camera.name + '_optical_frame', width=camera.size[0], height=camera.size[1],
            distortion_model='plumb_bob', fx=fx, fy=fy, cx=cx, cy=cy, distortion=[k1, 0, 0, 0, 0],
            time_offset=float('nan'), residual_px=float('nan'), residual_m=float('nan'))
        position, orientation = message.world_from_camera.position, message.world_from_camera.orientation
        position.x, position.y, position.z = camera.position
        orientation.x, orientation.y, orientation.z, orientation.w = quaternion(camera.rotation)
        rig.cameras.append(message)
    return rig
