"""Cost: processor time of the tracker, and its latency under load."""

import dataclasses
from typing import Dict

import sys

import numpy as np

from wiimote_tracker_bringup import charts, descriptions, stack, statistics
from wiimote_tracker_bringup.files import read_json, read_yaml
from wiimote_tracker_bringup.true_rig import publish, true_rig
from wiimote_tracker_evaluation.sections.cost import load
from wiimote_tracker_evaluation.trace import Recorder

TITLE = 'Cost'
SECONDS = 35, 280

SPEED = 1.0      # of every LED [m/s]
BOX = 1.2        # side of the cube of its wave [m]
PLACES = ((0.9, 0.9, 0.9), (1.6, 1.6, 1.1), (0.9, 1.6, 1.3), (1.6, 0.9, 0.7))  # at first [m]
# By number of cameras: numbers of LEDs, ascending, and of busy processes.
QUICK = ((2, ((1, 0),)), (4, ((1, 0), (1, 2), (4, 0))))
FULL = ((2, ((1, 0),)), (4, ((1, 0), (1, 1), (1, 2), (1, 4), (2, 0), (3, 0), (4, 0))),
        (6, ((1, 0),)), (8, ((1, 0), (4, 0))))


@dataclasses.dataclass(eq=False)
class Setting:
    """Measurements of a setting. shares: of one core, by node, one value a second. own: from a
    report on the device to the published point [s]."""

    cameras: int
    leds: int
    busy: int
    shares: Dict[str, np.ndarray]
    images: float
    points: float
    own: np.ndarray

    def name(self):
        return 'stack_%d_cameras_%d_leds%s' % (self.cameras, self.leds,
                                         '_%d_busy' % self.busy if self.busy else '')

    def words(self):
        return '%d cameras, %d LED%s%s' % (
            self.cameras, self.leds, '' if self.leds == 1 else 's',
            ', %d busy process%s' % (self.busy, '' if self.busy == 1 else 'es')
            if self.busy else '')

    def drivers(self):
        """One row per camera, one value a second [share of a core]."""
        return np.array([share for name, share in self.shares.items() if name.endswith('/driver')])

    def whole(self):
        """Sum of drivers, tracker and calibration node, one value a second."""
        return sum(self.shares.values())


def run(run):
    rigs_wanted, seconds = (QUICK, 4.0) if run.quick else (FULL, 15.0)
    of = sum(len(settings) for _, settings in rigs_wanted)
    measured = []
    for cameras, settings in rigs_wanted:
        full_stack = FullStack(run, cameras)
        for leds, busy in settings:
            run.progress(0.9 * len(measured), of,
                         f'{cameras} cameras, {leds} LEDs, {busy} busy processes')
            measured.append(full_stack.measure(leds, busy, seconds))
        full_stack.end()
    tell(run, measured, measure_rooms(run), seconds)


class FullStack:
    """The whole system with a number of cameras and its true rig; all LEDs are off at first."""

    def __init__(self, run, cameras):
        self._run, self._number = run, cameras
        description = descriptions.with_leds(
            descriptions.with_cameras(read_yaml(run.rig), cameras), PLACES, False)
        self._cameras, self._leds = list(description['cameras']), list(description['leds'])
        path, self._conductor = stack.launch_rig(run, '%d_cameras' % cameras, description,
                                                 labels=','.join(self._leds))
        self._rig = publish(true_rig(path))
        self._processes = {node: load.process_of(node) for node in [
            '/triangulation', '/calibration'] + [f'/{camera}/driver' for camera in self._cameras]}

    def measure(self, leds, busy, seconds):
        """Load of the nodes while LEDs move, beside busy processes."""
        import rospy
        for number, label in enumerate(self._leds[:leds]):
            self._conductor.wave(label, PLACES[number], BOX, SPEED, number + 1)
        self._conductor.wait_for_leds(leds)
        recorder = Recorder(self._run, self._cameras,
                            '%d_%d_%d' % (self._number, leds, busy))
        hogs = [stack.start(self._run.folder, [sys.executable, '-c', 'while True: pass'])
                for _ in range(busy)]
        begin = rospy.get_time()
        shares = load.measure(self._processes, seconds, stack.check)
        end = rospy.get_time()
        for hog in hogs:
            stack.end(hog)
        trace = recorder.read()
        chosen = trace.between(begin, end)
        images = np.sum((trace.deliveries >= begin) & (trace.deliveries < end)) / (end - begin)
        return Setting(self._number, leds, busy, shares, images, np.sum(chosen) / (end - begin),
                       (trace.published - trace.delivered)[chosen])

    def end(self):
        self._rig.unregister()
        stack.stop()


def measure_rooms(run):
    """The tracker's core alone, in process: rows of the tracking benchmark."""
    path = run.file('rooms.json')
    run.compute([['wiimote_tracker_triangulation/benchmark_tracking', '--section', 'scale',
                  '--runs', 3 if run.quick else 40, '--seed', run.seed, '--json', path]],
                'the tracker alone, several rooms', 0.9, 1.0)
    return read_json(path)['scale']


# --- Report

def tell(run, measured, rooms, seconds):
    run.say(
        'Processor time of the nodes, from `/proc/<pid>/stat`, while the whole system runs on the '
        'simulated rig for %.0f s per setting: one driver per camera, the tracker, '
        'the calibration node. Simulation, recorder and this program are not counted, but '
        'run on the same %d processor cores and affect the latency. Every camera sends 100 '
        'images/s, less the lost ones; every LED moves at %.0f m/s. Further cameras are placed '
        'between those of the rig. *Own latency*: from a report on the virtual device to the point '
        'in another process, without Bluetooth.'
        % (seconds, stack.cores(), SPEED))
    run.table('nodes', [
        ('cameras', ''), ('LEDs', ''), ('busy_processes', ''), ('images', '1/s'), ('points', '1/s'),
        ('driver_per_camera', '%'), ('tracker', '%'), ('calibration', '%'), ('all', '%'),
        ('latency_median', 'ms'), ('latency_p99', 'ms')], [
            (s.cameras, s.leds, s.busy, round(s.images, 1), round(s.points, 1),
             100 * s.drivers().mean(), 100 * s.shares['/triangulation'].mean(),
             100 * s.shares['/calibration'].mean(), 100 * s.whole().mean(),
             1e3 * np.median(s.own), 1e3 * np.quantile(s.own, 0.99)) for s in measured],
        'Full stack; % of one processor core. Points: messages on `/points`, each with all '
        'LEDs.')
    for setting in measured:
        figures_of(run, setting)
    plot(run, measured)
    rooms_of(run, rooms)
    usual = next(s for s in measured if (s.cameras, s.leds, s.busy) == (4, 1, 0))
    run.summary('**Cost**, simulated: with four Wiimotes and one LED all nodes together use %.0f '
                '%% of one processor core, %.1f %% of it per camera\'s driver.'
                % (100 * usual.whole().mean(), 100 * usual.drivers().mean()))


def figures_of(run, setting):
    name, words = setting.name(), setting.words()
    usual = (setting.cameras, setting.leds, setting.busy) == (4, 1, 0)
    for key, shares, what in (('driver', setting.drivers(), 'one driver'),
                              ('tracker', setting.shares['/triangulation'], 'the tracker'),
                              ('all', setting.whole(), 'all nodes')):
        run.figure(f'{name}_{key}', 100 * shares.mean(), '% of a core', len(shares),
                   widened(run, 100 * shares, shares.shape[-1]),
                   f'processor time of {what}, {words}', end_to_end=True,
                   headline=usual and key != 'tracker')
    p99 = statistics.quantile(0.99)
    own = 1e3 * setting.own
    run.figure(name + '_latency_p99_ms', p99(own), 'ms', len(own),
               statistics.bootstrap(statistics.blocks(own, 10), p99, run.seed),
               f'latency without Bluetooth, 99 %, {words}', end_to_end=True)


def widened(run, percent, seconds):
    """Interval of the mean, at least the resolution of the kernel's ticks."""
    low, high = statistics.bootstrap(percent, np.mean, run.seed)
    tick = 100 * load.TICK / seconds
    return low - tick, high + tick


def plot(run, measured):
    figure, (by_cameras, by_leds, latency) = charts.figure(
        1, 3, height=3.4, width=11.0, gridspec_kw={'width_ratios': (1.0, 1.0, 1.6)})
    idle = [s for s in measured if not s.busy]
    for axes, values, word, title in (
            (by_cameras, [(s.cameras, s) for s in idle if s.leds == 1], 'cameras', 'one LED'),
            (by_leds, [(s.leds, s) for s in idle if s.cameras == 4], 'LEDs', 'four cameras')):
        for part, color, text in ((lambda s: s.whole(), charts.INK, 'all nodes'),
                                  (lambda s: s.shares['/triangulation'], charts.BLUE, 'tracker')):
            axes.plot([n for n, _ in values], [100 * part(s).mean() for _, s in values], 'o-',
                      markersize=5, color=color, label=text)
        axes.set(xlabel=word, xticks=[n for n, _ in values])
        axes.set_title(title, fontsize=9.5)
    by_cameras.set_ylabel('processor [% of one core]')
    top = 1.1 * max(100 * s.whole().mean() for s in idle)
    for axes in (by_cameras, by_leds):
        axes.set_ylim(0.0, top)
    charts.key(by_cameras, loc='upper left')
    shown = [s for s in measured if (s.cameras, s.leds) == (4, 1)] + [
        s for s in idle if s.cameras * s.leds == max(each.cameras * each.leds for each in idle)]
    for setting, color in zip(shown, charts.COLORS):
        charts.cumulative(latency, 1e3 * setting.own, color, setting.words())
    latency.set_xscale('log')
    latency.xaxis.set_major_formatter(charts.plain_numbers())
    latency.set(xlabel='own latency [ms]', ylabel='share of the points')
    charts.key(latency, loc='lower right')
    run.plot('cost', figure, 'Processor time by the number of cameras and of LEDs; latency without '
             'Bluetooth, idle and beside busy processes.')


def rooms_of(run, rooms):
    run.say('### The tracker alone\n'
            'In process, in simulated time, without ROS and without drivers: rooms of four cameras '
            'and four LEDs each, all in one tracker. *Load*: share of one core in real time.')
    run.table('rooms', [('setting', ''), ('images', ''), ('time_per_image', 'µs'),
                        ('load', '% of a core'), ('leds_tracked', '')],
              [(row['name'], row['images'], row['us/image'], 100 * row['load'], row['leds'])
               for row in rooms])
    for row in rooms:
        if 'at once' in row['name']:
            cameras = int(row['name'].split()[0])
            run.figure('core_%d_cameras_us_per_image' % cameras, row['us/image'], 'µs',
                       row['images'], None, "the tracker's core, per image, %d cameras and as many "
                       'LEDs' % cameras)
