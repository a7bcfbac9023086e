"""The demonstration: the paper's experiment with the whole system on the simulated rig."""

import argparse
import math
import os
import time

from wiimote_tracker_bringup import bound, experiment, scene as scene_module, stack
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import prepare
from wiimote_tracker_bringup.interruption import answered, raise_when_interrupted
from wiimote_tracker_bringup.programs import package_file
from wiimote_tracker_evaluation.terminal import Terminal

LED = 'led'
CORNER_SEED, ALIGNMENT_SEED = 1, 2
CARRY_SPEED = 3.0       # of the LED between places [m/s]
CIRCLE_SPEED = 1.5      # [m/s]
TEST_DWELL = 1.0        # at each test point [s]
ALIGNMENT_DWELL = 0.3   # at each alignment point [s]
CAMERA_RATE = 100.0     # images a second of one camera [Hz]

RECORDED = (r'(.*)/ir_blobs|(.*)/camera_info|(.*)/imu/data_raw|(.*)/calibration/(rig|status)|'
            r'/points|/%s/point|/simulation/truth/(.*)|/tf|/tf_static|/diagnostics' % LED)


class Steps(Terminal):
    """Numbered steps, with a status below."""

    def __init__(self, steps):
        super().__init__()
        self._steps = steps
        self._step = 0
        self._start = time.monotonic()

    def step(self, text):
        self._step += 1
        self.line('[%d/%d, %3.0f s] %s' % (self._step, self._steps,
                                            time.monotonic() - self._start, text))


def has_display():
    return bool(os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY'))


class Demo:
    """One run, which returns a sentence on the results. Its processes end before it does."""

    def __init__(self, output, mode):
        self._output = output
        self._mode = mode
        self._progress = Steps(8)
        self._scene = scene_module.read_scene(package_file('simulation/paper_rig.yaml'))
        names = ['rig'] + [camera.name for camera in self._scene.cameras]
        prepare(output, [
            'summary.json', 'demo.bag', 'demo.bag.active', 'points.csv', 'tracks.png', 'tracks.gif'
        ] + [name + ending for name in names for ending in ('.yaml', '.yaml.bak')], 'nodes.log')

    def run(self):
        try:
            self._launch()
            segments, samples = self._experiment()
            return self._finish(segments, samples)
        finally:
            stack.stop_all()
            self._progress.line('')  # in the place of the status

    def file(self, name):
        return os.path.join(self._output, name)

    def _launch(self):
        self._progress.step('Starting four virtual Wii Remotes, drivers, calibration, tracker')
        self._progress.line('Starting rviz.' if has_display() else
                            'No display: instead of rviz there will be a film, tracks.gif.')
        stack.launch(self._output, 'launch/simulated_rig.launch',
                     socket_directory='{folder}/remotes', camera_info_directory='{folder}/cameras',
                     rig_file=self.file('rig.yaml'), side_length=experiment.SIDE, labels=LED,
                     mode=self._mode, hand='false', rviz=str(has_display()).lower())
        self._recorder = stack.record(self._output, self.file('demo.bag'), '--regex', RECORDED)

    def _experiment(self):
        """The LED's tour. Returns the measured segments, and the fewest images of a corner."""
        # Imported late: rospy reads the master's address at import.
        from wiimote_tracker_bringup.conductor import Conductor
        from wiimote_tracker_evaluation.demo.published import LiveRecorder
        conductor = Conductor(LED, LiveRecorder(), stack.check, self._progress.passing)
        self._check_connection(conductor)
        samples = self._calibrate(conductor)
        return self._measure(conductor), samples

    def _check_connection(self, conductor):
        progress = self._progress
        progress.step('Connection check')
        conductor.wait_for_cameras([camera.name for camera in self._scene.cameras])
        checked = conductor.check_connection()
        for camera in checked.cameras:
            progress.line('    %-10s %5.1f Hz  %s  %s' % (
                camera.name.strip('/'), camera.rate,
                f'sees the LED at ({camera.x:.0f}, {camera.y:.0f})' if camera.sees_led
                else 'does not see the LED', camera.problem))
        if not checked.success:
            raise Refusal('the connection check failed: ' + checked.message)
        self._report_view()

    def _calibrate(self, conductor):
        """Returns the fewest images that a camera used at a corner."""
        progress = self._progress
        progress.step('Calibration: the LED is put on the four corners, %.0f mm off'
                      % (1e3 * experiment.CORNER_STDDEV))
        conductor.start(experiment.SIDE)
        samples = []
        for place in experiment.placed_corners(CORNER_SEED):
            result = conductor.capture(place, CARRY_SPEED)
            progress.line('    ' + result.message)
            samples += [camera.samples[result.corner] for camera in result.cameras]
        solved = conductor.solve()
        progress.line('    ' + solved.message)
        for camera in solved.rig.cameras:
            progress.line(f"    {camera.name.strip('/'):<10} residual {camera.residual_px:.2f} "
                          f"px, {1e3 * camera.residual_m:.1f} mm")
        progress.line('    ' + conductor.save().message)
        return min(samples)

    def _measure(self, conductor):
        progress, segments = self._progress, []
        progress.step('Tracking: the ten test points')
        for number, place in enumerate(experiment.TEST_POINTS, 1):
            progress.passing(f'point {number} of {len(experiment.TEST_POINTS)}')
            segments.append(conductor.dwell('test', f'P{number}', place, CARRY_SPEED, TEST_DWELL))
        places = experiment.alignment_points(ALIGNMENT_SEED)
        progress.step(f'Tracking: {len(places)} other points, for alignment')
        for number, place in enumerate(places, 1):
            progress.passing(f'point {number} of {len(places)}')
            segments.append(conductor.dwell('alignment', f'A{number}', place, CARRY_SPEED,
                                            ALIGNMENT_DWELL))
        progress.step(f'Tracking: three circles of 0.75 m radius at {CIRCLE_SPEED:.1f} m/s')
        lap = 2.0 * math.pi * experiment.CIRCLE_RADIUS / CIRCLE_SPEED
        for number, center in enumerate(experiment.CIRCLE_CENTERS, 1):
            progress.passing(f'circle {number} of {len(experiment.CIRCLE_CENTERS)}')
            segments.append(conductor.circle(
                'circle at (%g, %g, %g)' % tuple(center), center, experiment.CIRCLE_RADIUS,
                CIRCLE_SPEED, lap))
        return segments

    def _report_view(self):
        complete = True
        for name, points in (('test point', experiment.TEST_POINTS),
                             ('circle point', experiment.circle_points())):
            for point, missed in zip(points, self._scene.missed(points)):
                if missed:
                    complete = False
                    self._progress.line('    %s (%.2f, %.2f, %.2f) is out of view of %s'
                                        % ((name,) + tuple(point) + (', '.join(missed),)))
        if complete:
            self._progress.line('    every test point and circle is in view of all '
                                f'{len(self._scene.cameras)} cameras')

    def _finish(self, segments, corner_samples):
        from wiimote_tracker_evaluation.demo import animation, published, report, scoring
        self._progress.step('Closing the bag, computing the results')
        stack.end(self._recorder)
        if not os.path.exists(self.file('demo.bag')):
            raise Refusal('rosbag left no demo.bag; see ' + self.file('nodes.log'))
        recorded = published.read_bag(self.file('demo.bag'), LED)
        score = scoring.score(recorded, segments)
        bounds = bound.position_bounds(
            self._scene, experiment.CORNERS, experiment.TEST_POINTS,
            experiment.alignment_points(ALIGNMENT_SEED), corner_samples,
            TEST_DWELL * CAMERA_RATE, ALIGNMENT_DWELL * CAMERA_RATE)
        deviation = bound.deviation_of(self._scene, experiment.NOMINAL_LENS, experiment.CORNERS,
                                       experiment.placed_corners(CORNER_SEED))
        best = {kind: each.best(deviation) for kind, each in bounds.items()}
        report.write_summary(self.file('summary.json'), self._mode, score, bounds, best)
        report.write_csv(self.file('points.csv'), recorded, segments)
        report.draw_tracks(self.file('tracks.png'), recorded, segments, score)
        files = 'summary.json, rig.yaml, demo.bag, points.csv, tracks.png'
        if not has_display():
            animation.draw(self.file('tracks.gif'), self._scene, recorded, segments)
            files += ', tracks.gif'

        self._progress.step('Results')
        for line in [''] + report.table(score, bounds, best) + ['']:
            self._progress.line(line)
        self._progress.line(f'In {self._output}: {files}')
        return report.sentence(self._mode, score)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--output', metavar='DIR', default='wiimote_tracker_demo',
                        help='folder for the results (default: ./wiimote_tracker_demo)')
    parser.add_argument('--mode', choices=['tracks', 'instant'], default='tracks',
                        help='tracks: a filter per LED (default); instant: rays are intersected, '
                             'as in the paper')
    options = parser.parse_args(arguments)
    raise_when_interrupted()
    with answered('lead_demo'):
        print(Demo(os.path.abspath(options.output), options.mode).run())
