"""Detection distance against the LED's current (Fig. 5)."""

import numpy as np

from wiimote_tracker_bringup import charts, experiment, programs
from wiimote_tracker_bringup.files import existing_file
from wiimote_tracker_bringup.programs import package_file
from wiimote_tracker_bringup.scene import read_scene
from wiimote_tracker_evaluation.sections.distance.light import (
    SENSITIVITIES, detection_distance, read_led)
from wiimote_tracker_evaluation.live import distance as with_a_person
from wiimote_tracker_evaluation.section import Option
from wiimote_tracker_evaluation.sessions import by_session, where

TITLE = 'Detection distance'
SECONDS = 2, 5
OPTION = Option('led', 'FILE', existing_file, 'description of your own LED')
live = with_a_person.live

PAPER_CURRENT, PAPER_DISTANCE = 0.56, 10.0  # [A], [m]
SHOWN = (0.05, 2.0)                         # currents of the plot [A]
SPEED, TIME_LIMIT = 0.25, 0.5               # of the program evaluate_distance [m/s], [s]


def run(run):
    sessions = 2 if run.quick else 20
    run.compute([['evaluate_distance', '--rig', run.rig, '--output', run.file('carried.csv'),
                  '--seed', run.seed, '--sessions', sessions]], 'carrying remotes away', 0.0, 0.9)
    led = read_led(run.options.led or package_file('evaluation/led.yaml'))
    tell(run, led, programs.read_csv(run.file('carried.csv')))


def tell(run, led, carried):
    thresholds = {level: threshold(carried, level) for level in SENSITIVITIES}
    constant = led.brightness_per_ampere(thresholds[led.sensitivity])
    run.say(
        'A virtual Wii Remote moves away from a light at %.2f m/s, while its direction describes '
        'small circles, until the reported position has not changed for %.1f s, as in the paper. '
        'Its sensor is that of the whole simulation, read by the remote\'s protocol.\n\nThe light '
        'at the remote is assumed proportional to the current, as in the paper, and falls with the '
        'square of the distance. The sensor\'s threshold follows from its registers; at the '
        'console\'s middle level (`wii_3`) a sensor bar is seen from %.1f m. The brightness of the '
        'LED is the only fitted constant: from %s, at `%s`, it is %.2f sensor bars per ampere. '
        '**The fitted curve passes through a single measured point by construction, which confirms '
        'nothing.** Measure a few distances of your own LED, enter them in a copy of `led.yaml`, '
        'and use it with `--led`.'
        % (SPEED, TIME_LIMIT, float(detection_distance(1.0, thresholds['wii_3'])),
           ', '.join(f'{distance:g} m with {1e3 * current:g} mA'
                     for current, distance in led.measured), led.sensitivity, constant))
    plot(run, led, carried, thresholds, constant)
    table = []
    for level in SENSITIVITIES:
        distance = detection_distance(constant * PAPER_CURRENT, thresholds[level])
        table.append([level, thresholds[level], float(detection_distance(1.0, thresholds[level])),
                      float(distance)])
        run.figure('distance_560_mA_' + level, distance, 'm',
                   len(np.unique(carried['session'])),
                   note=f'Distance from which the LED is seen with 560 mA, sensitivity {level}')
    run.table('levels', [('sensitivity', ''), ('threshold', 'sensor bars at 1 m'),
                         ('sensor_bar_seen_from', 'm'), ('led_560_mA_seen_from', 'm')], table)
    tell_law(run, carried)
    tell_corners(run, led)


def threshold(carried, level):
    """Brightness at which a light is just seen, from where it was seen last: between that distance
    and that of the next image."""
    chosen = carried['sensitivity'] == level
    return float(np.mean(carried['brightness'][chosen] / carried['last_seen_m'][chosen] ** 2))


def tell_law(run, carried):
    """Exponent of the distance by current, and the effect of the time limit."""
    slopes = []
    for session in np.unique(carried['session']):
        for level in SENSITIVITIES:
            chosen = where(carried, session=session, sensitivity=level)
            slopes.append(np.polyfit(np.log(carried['brightness'][chosen]),
                                     np.log(carried['last_seen_m'][chosen]), 1)[0])
    run.estimate('power_of_current', slopes, np.mean, '',
                 'Power of the current with which the distance grows (1/2 by the inverse square '
                 'law)')
    late = carried['stopped_at_m'] - carried['last_seen_m']
    run.estimate('added_by_time_limit', by_session(carried, late), np.mean, 'm',
                 f'What the time limit of 0.5 s adds to the distance at {SPEED:.2f} m/s')


def tell_corners(run, led):
    """Whether every camera sees the LED everywhere in the cube."""
    scene = read_scene(run.rig)
    worst = None
    for camera in scene.cameras:
        for point in experiment.TEST_POINTS:
            way = camera.position - point
            distance = np.linalg.norm(way)
            angle = np.arcsin(way[2] / distance)  # off the cone's horizontal
            brightest = led.brightness_per_ampere(1.0)
            needed = distance ** 2 / brightest / led.relative(angle)
            if worst is None or needed > worst[0]:
                worst = needed, distance, np.degrees(angle), camera.name, point
    needed, distance, angle, camera, point = worst
    run.figure('current_for_all_corners', 1e3 * needed, 'mA', 1, note='Current with which every '
               f'camera sees the LED at all ten test points, sensitivity {led.sensitivity}')
    run.say(
        'The darkest test point is (%.2f, %.2f, %.2f) m from %s: %.1f m away and %.0f° off the '
        'plane of the cone\'s light. It requires %.0f mA at `%s`. %s'
        % (tuple(point) + (camera, distance, abs(angle), 1e3 * needed, led.sensitivity,
           'The paper\'s 560 mA suffice, as it says.' if needed <= PAPER_CURRENT else
           'By this model the paper\'s 560 mA do not suffice, although it says so.')))
    run.summary('**Detection distance**, simulated: an LED with %.0f mA is seen from %.0f m '
                '(fitted to a measured point); every camera of this rig sees all ten test points '
                'from %.0f mA on.' % (
                    1e3 * led.measured[-1][0], led.measured[-1][1], 1e3 * needed))


def plot(run, led, carried, thresholds, constant):
    figure, (axes, beam) = charts.figure(1, 2, gridspec_kw={'width_ratios': [1.7, 1.0]})
    currents = np.geomspace(*SHOWN, num=100)
    for level, color in zip(SENSITIVITIES, charts.COLORS):
        axes.plot(1e3 * currents, detection_distance(constant * currents, thresholds[level]),
                  color=color, linewidth=1.0)
        chosen = carried['sensitivity'] == level
        current = carried['brightness'][chosen] / constant
        inside = (current >= SHOWN[0]) & (current <= SHOWN[1])
        axes.plot(1e3 * current[inside], carried['stopped_at_m'][chosen][inside], 'o', markersize=3,
                  color=color)
        axes.annotate(level, (1e3 * SHOWN[1], detection_distance(constant * SHOWN[1],
                                                                 thresholds[level])),
                      xytext=(4, 4 if level == 'max' else -1), textcoords='offset points',
                      va='center', color=color)
    for current, distance in led.measured:
        axes.plot(1e3 * current, distance, 'D', color=charts.INK, markersize=6,
                  markerfacecolor='none')
    axes.plot(1e3 * PAPER_CURRENT, PAPER_DISTANCE, 'D', color=charts.INK, markersize=6)
    axes.annotate('paper: 560 mA, 10 m', (1e3 * PAPER_CURRENT, PAPER_DISTANCE), xytext=(62, -76),
                  textcoords='offset points', ha='center',
                  arrowprops={'arrowstyle': '-', 'color': charts.SOFT})
    charts.log_axis(axes, 'x', (50, 100, 200, 500, 1000, 2000))
    charts.log_axis(axes, 'y', (1, 2, 5, 10, 20, 50))
    axes.set(xlabel='current [mA]', ylabel='detection distance [m]')
    angles = np.linspace(-80.0, 80.0, 161)
    beam.plot(angles, PAPER_DISTANCE * np.sqrt(led.relative(np.radians(angles))), color=charts.BLUE)
    beam.set(xlabel="angle off the cone's horizontal [°]", xticks=[-60, -30, 0, 30, 60],
             ylabel='detection distance, 560 mA [m]', ylim=(0.0, None))
    run.plot('distance', figure, 'Distance from which the LED is seen (Fig. 5). Left: by its '
             'current, for the sensitivities of the remote: dots, where the remote stopped; lines, '
             'the inverse square law; diamond, the only point in the paper\'s text. '
             f'Right: by the direction, at `{led.sensitivity}`; the beam is a model, see '
             '`led.yaml`.')
