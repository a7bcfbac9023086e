"""Drag the cameras of a plan in rviz and see at once what they see.

  roslaunch wiimote_tracker_bringup plan.launch plan:=FILE output:=FILE    also opens rviz

Private parameters:
  plan         file that says what the room needs and allows, as for plan_rig (needed)
  output       the rig description that Save, or the service plan/save, writes (needed)
  description  the rig description to begin with; empty: a quick proposal (default: empty)
"""

import dataclasses
import textwrap
import threading

import numpy as np
import rospy
from interactive_markers.interactive_marker_server import InteractiveMarkerServer
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Trigger, TriggerResponse
from visualization_msgs.msg import InteractiveMarkerFeedback, MarkerArray
from wiimote_tracker_bringup import descriptions, files, nodes
from wiimote_tracker_bringup.errors import Refusal, sentence_of
from wiimote_tracker_rig_planning import cells, handles, plan, plan_rig, prediction, search

CORNERS = ('lower corner', 'upper corner')  # of the volume
LEAST_EDGE = 0.1  # of the volume [m]
WIDTH = 60  # of the summary's lines, in letters
NAME_ABOVE = np.array([0.0, 0.0, 0.6])  # its handle [m]
SUMMARY_BEFORE = np.array([0.0, -3.0, 0.0])  # the volume, where no handle is [m]


class PlaceCameras:
    def __init__(self, chosen, rig, output):
        self._plan, self._rig, self._output = chosen, rig, output
        self._names, self._positions, self._targets = plan_rig.places_of(rig)
        self._lines = []  # of the summary
        self._is_saved = False
        self._lock = threading.Lock()
        self._cells = rospy.Publisher('coverage/cells', PointCloud2, queue_size=1, latch=True)
        self._summary = rospy.Publisher('coverage', MarkerArray, queue_size=1, latch=True)
        self._room = rospy.Publisher('plan/room', MarkerArray, queue_size=1, latch=True)
        self._server = InteractiveMarkerServer('plan')
        for name, position, target in zip(self._names, self._positions, self._targets):
            self._server.insert(handles.camera(name, position, target), self._on_feedback)
        for name, corner in zip(CORNERS, np.reshape(chosen.volume, (2, 3))):
            self._server.insert(handles.corner(name, corner), self._on_feedback)
        with self._lock:
            self._server.applyChanges()
            self._show()
        rospy.Service('plan/save', Trigger, lambda _: self._save())

    def _on_feedback(self, feedback):
        if feedback.event_type == InteractiveMarkerFeedback.MENU_SELECT:
            answer = self._save()
            (rospy.loginfo if answer.success else rospy.logerr)('%s', answer.message)
            with self._lock:
                self._show_words([*self._lines, answer.message])
        elif feedback.event_type == InteractiveMarkerFeedback.MOUSE_UP:
            with self._lock:
                self._move(feedback.marker_name, feedback.pose)
                self._show()

    def _move(self, name, pose):
        position, direction = handles.place_of(pose)
        if name in CORNERS:
            corners = np.reshape(self._plan.volume, (2, 3)).copy()
            corners[CORNERS.index(name)] = position
            if (corners[1] - corners[0] >= LEAST_EDGE).all():
                self._plan = dataclasses.replace(self._plan, volume=tuple(corners.ravel()))
            for each, corner in zip(CORNERS, np.reshape(self._plan.volume, (2, 3))):
                self._server.setPose(each, handles.corner(each, corner).pose)
        else:
            camera = self._names.index(name)
            distance = np.linalg.norm(self._targets[camera] - self._positions[camera])
            self._positions[camera] = position
            self._targets[camera] = position + distance * direction
            # Without the roll that rounding brings.
            self._server.setPose(name, handles.pose_of(position, self._targets[camera]))
        self._server.applyChanges()

    def _show(self):
        """The summary comes last: it takes two seconds."""
        self._room.publish([
            handles.box_lines(box, number, color) for number, (box, color) in enumerate(
                [(self._plan.volume, ColorRGBA(0.9, 0.6, 0.2, 1.0))]
                + [(stand, ColorRGBA(0.5, 0.5, 0.6, 0.6)) for stand in self._plan.stands]
                + [(obstacle, ColorRGBA(0.9, 0.2, 0.2, 1.0))
                   for obstacle in self._plan.obstacles])])
        points = self._plan.grid(plan_rig.ACROSS)
        self._cells.publish(cells.cloud(handles.FRAME, points, *prediction.at_points(
            self._plan, self._positions, self._targets, points)))
        self._summary.publish(self._name_texts())
        self._lines = plan_rig.describe_sight(self._plan, self._names, self._positions,
                                              self._targets)
        self._show_words(self._lines)

    def _name_texts(self):
        return [handles.text(name, 'name', number, place + NAME_ABOVE)
                for number, (name, place) in enumerate(zip(
                    [*self._names, *CORNERS],
                    [*self._positions, *np.reshape(self._plan.volume, (2, 3))]))]

    def _show_words(self, lines):
        lower, upper = np.reshape(self._plan.volume, (2, 3))
        words = '\n'.join(textwrap.fill(line.strip(), WIDTH) for line in lines)
        before = [(lower[0] + upper[0]) / 2, *lower[1:]] + SUMMARY_BEFORE
        self._summary.publish([handles.text(words, 'summary', 0, before), *self._name_texts()])

    def _save(self):
        with self._lock:
            description = descriptions.placed(self._rig, self._positions, self._targets)
            volume = [round(float(v), 3) for v in self._plan.volume]
        try:
            if not self._is_saved:  # a file of before, perhaps with comments
                files.keep_copy(self._output)
            files.write_yaml(self._output, description)
            self._is_saved = True
        except OSError as error:
            return TriggerResponse(False, f'not saved: {sentence_of(error)}')
        return TriggerResponse(True, f'saved to {self._output}; the plan file is unchanged, the '
                               f'volume here is {volume}')


def main():
    nodes.start('place_cameras', __doc__)
    try:
        chosen = plan.read(rospy.get_param('~plan'))
        output = rospy.get_param('~output')
        files.check_distinct([output], [rospy.get_param('~plan')])
        description = rospy.get_param('~description', '')
        if not description:
            rospy.loginfo('looking for places to begin with; rviz shows them then')
        rig = (plan_rig.read_description(description) if description
               else plan_rig.description(chosen, *search.proposal(chosen)))
        PlaceCameras(chosen, rig, output)
    except KeyError as error:
        rospy.logfatal('the parameter %s is missing: use plan.launch', error)
        return 1
    except (Refusal, OSError) as error:
        rospy.logfatal('%s', sentence_of(error))
        return 1
    rospy.spin()
    return 0
