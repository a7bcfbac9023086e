"""Latency by the laps counter: a person sets it up."""

import time

import numpy as np

from wiimote_tracker_bringup import charts
from wiimote_tracker_evaluation.live.circles import errors_of, path_of
from wiimote_tracker_evaluation.live.dialogue import SKIP
from wiimote_tracker_evaluation.live.running_tracker import with_tracker

LAPS, QUICK_LAPS = 40, 6
PATIENCE = 15.0  # for the next lap [s]


class LapsCounter:
    """Triggers, the newest position at the arrival of each, and the tracker's answers."""

    def __init__(self, tracker):
        import rospy
        from std_msgs.msg import Header
        from wiimote_tracker_msgs.msg import TrackedPointArray
        self._tracker = tracker
        self.newest = {}   # by the trigger's stamp [ns]: newest position then [m]
        self.answers = {}  # by the trigger's stamp [ns]: position of the answer [m]
        self._subscribers = [
            rospy.Subscriber('trigger', Header, self._on_trigger, tcp_nodelay=True),
            rospy.Subscriber('triggered_points', TrackedPointArray, self._on_answer)]

    def _on_trigger(self, message):
        begin = message.stamp.to_sec()
        known = [seen for seen in self._tracker.since(begin - 1.0)
                 if seen.heard <= begin and len(seen.leds) == 1]
        if known:
            self.newest[message.stamp.to_nsec()] = known[-1].leds[0].position

    def _on_answer(self, message):
        if len(message.points) == 1:
            point = message.points[0].position
            self.answers[message.header.stamp.to_nsec()] = np.array([point.x, point.y, point.z])

    def laps(self):
        """Stamps [ns] of the triggers with both."""
        return sorted(set(self.newest) & set(self.answers))

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


@with_tracker
def live(run, tracker, dialogue):
    counter = LapsCounter(tracker)
    try:
        measure(run, tracker, counter, dialogue)
    finally:
        counter.close()


def measure(run, tracker, counter, dialogue):
    wanted = QUICK_LAPS if run.quick else LAPS
    tracker.wait_for_points()
    dialogue.line(
        'Move one LED on a horizontal circle at constant speed, and let a laps counter publish a '
        'std_msgs/Header on /trigger, stamped with the time, whenever the LED passes it. Waiting '
        'for %d laps (s and Enter: skip this).' % wanted)
    begin = tracker.now()
    last, count = time.monotonic(), 0
    while len(counter.laps()) < wanted + 1:
        if len(counter.laps()) > count:
            last, count = time.monotonic(), len(counter.laps())
        if dialogue.typed() == SKIP or (count and time.monotonic() - last > PATIENCE):
            break
        dialogue.passing('%d of %d laps' % (max(count - 1, 0), wanted))
        time.sleep(0.02)
    tell(run, counter, path_of(tracker.since(begin))[1])


def tell(run, counter, positions):
    laps = counter.laps()
    if len(laps) < 3:
        run.say('Fewer than two laps were counted: there are no figures.')
        return
    centre = errors_of(positions, 0.0)[0]
    period = float(np.median(np.diff(laps))) * 1e-9
    turn = np.cross(positions[:-1] - centre, np.diff(positions, axis=0)).sum(axis=0)
    late = np.array([behind(counter.newest[lap] - centre, counter.answers[lap] - centre, turn)
                     for lap in laps]) * 1e3 * period / (2.0 * np.pi)
    run.say(
        'The laps counter has counted %d laps of %.4f s. At each of its triggers, the newest known '
        'point lies behind the position that the tracker later estimates for that time; the angle '
        'between them times the period is the latency, as in Fig. 6.'
        % (len(laps) - 1, period))
    run.estimate('live_mean', late, np.mean, 'ms', 'Latency by the angle, mean', end_to_end=True)
    run.figure('live_least', np.min(late), 'ms', len(late), note='Least latency', end_to_end=True)
    run.figure('live_most', np.max(late), 'ms', len(late), note='Greatest latency', end_to_end=True)
    run.table('laps', [('lap', ''), ('time', 's'), ('latency', 'ms')],
              [[number, 1e-9 * (lap - laps[0]), value]
               for number, (lap, value) in enumerate(zip(laps, late))], shown=False)
    figure, (circle, axes) = charts.figure(1, 2)
    draw_circle(circle, positions - centre, turn,
                np.array([counter.answers[lap] - centre for lap in laps]),
                np.array([counter.newest[lap] - centre for lap in laps]))
    charts.cumulative(axes, late, charts.BLUE)
    axes.set(xlabel='latency [ms]', ylabel='share of the laps', xlim=(0.0, None))
    run.plot('latency', figure, 'Left, as Fig. 6: all points (red), the newest ones at the '
             'triggers (blue crosses), and the axis of the laps counter, where the tracker later '
             'estimates the LED at the triggers. Right: cumulative distribution of the latency.')
    run.summary('Latency by the laps counter: %.1f ms on average (%d laps%s).' % (
        np.mean(late), len(late) - 1,
        '' if run.simulated else '; the paper measured 280 to 320 ms'))


def draw_circle(axes, points, turn, answers, newest):
    """Draws the circle along its axis; the laps counter is on the right."""
    normal = turn / np.linalg.norm(turn)
    across = answers.mean(axis=0)
    across = across - normal * (normal @ across)
    across /= np.linalg.norm(across)
    plane = np.column_stack([across, np.cross(normal, across)])
    radius = np.linalg.norm(points @ plane, axis=1).mean()
    axes.plot(*(points @ plane).T, '.', color=charts.RED, markersize=1.5)
    axes.plot([0.0, 1.3 * radius], [0.0, 0.0], color=charts.INK, linewidth=0.8)
    axes.plot(*(newest @ plane).T, 'x', color=charts.BLUE, markersize=5)
    axes.set(aspect='equal', xlabel='towards the laps counter [m]', ylabel='along the turn [m]')


def behind(newest, answer, axis):
    """Angle from one direction to the other about the axis [rad]."""
    axis = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    newest, answer = (each - axis * (axis @ each) for each in (newest, answer))
    return float(np.arctan2(axis @ np.cross(newest, answer), newest @ answer))
