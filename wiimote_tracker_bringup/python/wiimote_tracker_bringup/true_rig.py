"""The true rig, for experiments that do not test calibration."""

from geometry_msgs.msg import Point, Pose, Quaternion
from scipy.spatial.transform import Rotation
from wiimote_tracker_msgs.msg import CameraCalibration, RigCalibration

from wiimote_tracker_bringup import descriptions, scene
from wiimote_tracker_bringup.files import read_yaml


def true_rig(path):
    """RigCalibration of the exact cameras of a rig description's file."""
    identities = descriptions.identities(read_yaml(path))
    rig = RigCalibration(format_version=RigCalibration.FORMAT_VERSION, id='', method='true',
                         ray_model=RigCalibration.RAY_MODEL_CALIBRATED,
                         virtual_hfov=float('nan'), led_height=float('nan'))
    rig.header.frame_id = 'world'
    for camera in scene.read_scene(path).cameras:
        fx, fy, cx, cy, k1 = camera.parameters.tolist()
        message = CameraCalibration(
            name=camera.name, identity=identities[camera.name],
            frame_id=camera.name + '_optical_frame', width=camera.size[0], height=camera.size[1],
            distortion_model='plumb_bob', fx=fx, fy=fy, cx=cx, cy=cy, distortion=[k1, 0, 0, 0, 0],
            time_offset=float('nan'), residual_px=float('nan'), residual_m=float('nan'))
        message.world_from_camera = Pose(
            Point(*camera.position.tolist()),
            Quaternion(*Rotation.from_matrix(camera.rotation).as_quat().tolist()))
        rig.cameras.append(message)
    return rig


def publish(rig):
    """As the current rig, as long as the returned publisher lives."""
    import rospy  # reads the master's address at import
    publisher = rospy.Publisher('calibration/rig', RigCalibration, queue_size=1, latch=True)
    publisher.publish(rig)
    return publisher
