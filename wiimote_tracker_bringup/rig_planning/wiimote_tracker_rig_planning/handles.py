"""What a person drags in rviz: a camera of a plan, or a corner of the wanted volume."""

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion
from scipy.spatial.transform import Rotation
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import (
    InteractiveMarker, InteractiveMarkerControl, Marker, MenuEntry)
from wiimote_tracker_bringup.experiment import NOMINAL_LENS
from wiimote_tracker_bringup.scene import look_at
from wiimote_tracker_rig_planning.prediction import SIZE

FRAME = 'world'
FRUSTUM = 1.0  # length of the drawn field of view [m]
# Turns that take the x axis to another one.
TO_AXIS = {'x': Quaternion(0.0, 0.0, 0.0, 1.0), 'y': Quaternion(0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5),
           'z': Quaternion(0.0, -0.5 ** 0.5, 0.0, 0.5 ** 0.5)}


def pose_of(position, target) -> Pose:
    """Of a camera: x points to the target, y to the left and is horizontal."""
    right, down, forward = look_at(position, target).T
    turn = Rotation.from_matrix(np.column_stack([forward, -right, -down])).as_quat()
    return Pose(Point(*position), Quaternion(*turn))


def place_of(pose: Pose):
    """Position, and the direction in which x points."""
    turn = pose.orientation
    return (np.array([pose.position.x, pose.position.y, pose.position.z]),
            Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).apply([1.0, 0.0, 0.0]))


def camera(name, position, target) -> InteractiveMarker:
    """Arrows move it along the world's axes; rings turn it about the vertical, and up and down."""
    return _handle(name, pose_of(position, target), [_camera_body()] + _arrows() + [
        _control('pan', InteractiveMarkerControl.ROTATE_AXIS, 'z', InteractiveMarkerControl.FIXED),
        _control('tilt', InteractiveMarkerControl.ROTATE_AXIS, 'y',
                 InteractiveMarkerControl.INHERIT)])


def corner(name, position) -> InteractiveMarker:
    """Arrows move it."""
    ball = Marker(type=Marker.SPHERE, color=ColorRGBA(0.9, 0.6, 0.2, 1.0))
    ball.scale.x = ball.scale.y = ball.scale.z = 0.1
    return _handle(name, Pose(Point(*position), TO_AXIS['x']),
                   [_always_visible([ball])] + _arrows())


def box_lines(box, number, color) -> Marker:
    """Edges of a box (two opposite corners)."""
    corners = np.array(box).reshape(2, 3)
    lines = Marker(type=Marker.LINE_LIST, ns='plan', id=number, color=color)
    lines.header.frame_id = FRAME
    lines.pose.orientation.w = 1.0
    lines.scale.x = 0.015
    for axis in range(3):
        for first, second in ((0, 0), (0, 1), (1, 0), (1, 1)):
            for end in (0, 1):
                which = np.insert([first, second], axis, end)
                lines.points.append(Point(*corners[which, (0, 1, 2)]))
    return lines


def text(words, namespace, number, position) -> Marker:
    """Words above a place; rviz's display Markers gives them a readable size."""
    text = Marker(type=Marker.TEXT_VIEW_FACING, ns=namespace, id=number, text=words,
                  pose=Pose(Point(*position), TO_AXIS['x']), color=ColorRGBA(1.0, 1.0, 1.0, 1.0))
    text.header.frame_id = FRAME
    text.scale.z = 0.1
    return text


def _handle(name, pose, controls):
    handle = InteractiveMarker(name=name, description=name, pose=pose, scale=1.0, controls=controls,
                               menu_entries=[MenuEntry(id=1, title='Save')])
    handle.header.frame_id = FRAME
    return handle


def _control(name, mode, axis, orientation_mode):
    return InteractiveMarkerControl(name=name, interaction_mode=mode, orientation=TO_AXIS[axis],
                                    orientation_mode=orientation_mode)


def _arrows():
    return [_control('move_' + axis, InteractiveMarkerControl.MOVE_AXIS, axis,
                     InteractiveMarkerControl.FIXED) for axis in 'xyz']


def _always_visible(markers):
    return InteractiveMarkerControl(name='menu', interaction_mode=InteractiveMarkerControl.MENU,
                                    always_visible=True, markers=markers)


def _camera_body():
    body = Marker(type=Marker.CUBE, color=ColorRGBA(0.9, 0.9, 0.95, 1.0))
    body.scale.x, body.scale.y, body.scale.z = 0.15, 0.05, 0.05
    field = Marker(type=Marker.LINE_LIST, color=ColorRGBA(0.4, 0.7, 1.0, 0.8))
    field.scale.x = 0.01
    focal, middle = np.array(NOMINAL_LENS[:2]), np.array(NOMINAL_LENS[2:4])
    ends = [Point(FRUSTUM, *(-FRUSTUM * (np.array(share) * SIZE - middle) / focal))
            for share in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for end, following in zip(ends, ends[1:] + ends[:1]):
        field.points += [Point(), end, end, following]
    return _always_visible([body, field])
