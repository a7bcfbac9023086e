"""Identification of four blinking LEDs: the paper's scheme, and cyclic codes."""

import numpy as np

from wiimote_tracker_bringup import charts, statistics
from wiimote_tracker_evaluation import sessions
from wiimote_tracker_evaluation.live import identification as with_a_person

TITLE = 'Identification by blinking'
SECONDS = 10, 100
live = with_a_person.live

PROGRAM = 'evaluate_identification'
QUICK, FULL = 6, 100                             # tries with each scheme, length and set of cameras
LEDS = 4
DURATION = 4.0                                   # of one try of evaluate_identification [s]
SCHEMES = (('paper', 'period', 'the paper\'s scheme'), ('cyclic', 'chip', 'cyclic codes'))
ENOUGH = 0.95                                    # share of successful tries that counts as reliable
SHOWN_PERIOD, SHOWN_CHIP = 150.0, 23.0           # of the figures [ms]


def run(run):
    tries = sessions.simulate(run, PROGRAM, QUICK if run.quick else FULL, 10, 'letting LEDs blink')
    tell(run, tries)
    sessions.keep(run, 'tries', tries, 'Every try.')


def succeeded(tries):
    return (tries['labelled'] == LEDS) & (tries['wrong'] == 0) & (tries['ever_wrong'] == 0)


class Line:
    """One scheme and number of cameras, by the length of its period or chip [ms]. shares and
    intervals: of the successes [%]; seconds: their times; wrong: tries with ever a wrong label."""

    def __init__(self, tries, scheme, cameras):
        chosen = sessions.where(tries, scheme=scheme, cameras=cameras)
        good = succeeded(tries)
        self.lengths = np.unique(tries['length_ms'][chosen])
        groups = [chosen & (tries['length_ms'] == length) for length in self.lengths]
        self.tries = [int(here.sum()) for here in groups]
        self.right = [int((here & good).sum()) for here in groups]
        self.seconds = [tries['time_s'][here & good] for here in groups]
        self.wrong = int((tries['ever_wrong'][chosen] != 0).sum())
        self.shares = 100.0 * (np.array(self.right) / self.tries)
        self.intervals = 100.0 * np.array(list(map(statistics.wilson, self.right, self.tries)))

    def shortest(self):
        """Shortest length from which on ENOUGH tries succeed [ms]; None without any."""
        poor = np.flatnonzero(np.array(self.right) < ENOUGH * np.array(self.tries))
        enough = self.lengths[poor[-1] + 1:] if len(poor) else self.lengths
        return enough[0] if len(enough) else None

    def at(self, length):
        return int(np.flatnonzero(self.lengths == length)[0])


def tell(run, tries):
    cameras = [int(count) for count in np.unique(tries['cameras'])]
    lines = {(scheme, count): Line(tries, scheme, count)
             for scheme, _, _ in SCHEMES for count in cameras}
    run.say(
        'Four LEDs blink in the middle of the cube, seen by unsynchronised cameras; a try lasts '
        f'{DURATION:.0f} s and is a success if all labels are right in the end and none was ever '
        'wrong. Everything is simulated from the light on the sensor (an LED is seen if it is on '
        'for more than half of the exposure of 1 ms) to the label.\n\n'
        '**The paper\'s scheme:** on for 90, 60, 40 and 20 % of a common period, centred in it; '
        'the period is known to within 20 %. **Cyclic codes:** each LED repeats a word of 8 chips '
        'with its own phase, without wires. The LEDs\' clocks are exact here. Very short periods '
        'depend on that, because they are sampled over many periods. A label is assigned at a '
        'probability of 99.9 %, so that in up to 4 of 1000 tries one of four LEDs may have a wrong '
        'one, mostly for a moment; such a try is not a success. The paper says that identification '
        '"was successful in all test cases", without period or time, and leaves the shortest '
        'period to future research.')
    plot(run, cameras, lines)
    rows = []
    for (scheme, count), line in lines.items():
        for length, number, share, interval, seconds in zip(
                line.lengths, line.tries, line.shares, line.intervals, line.seconds):
            times = [float(of(seconds)) if len(seconds) else None for of in (np.median, np.max)]
            rows.append([scheme, count, length, number, share, *interval, *times])
    run.table('lengths', [('scheme', ''), ('cameras', ''), ('period_or_chip', 'ms'), ('tries', ''),
                          ('success', '%'), ('low', '%'), ('high', '%'), ('median_time', 's'),
                          ('longest_time', 's')], rows,
              'Success and time until all four LEDs have their labels, by period or chip.',
              shown=False)
    figures(run, cameras, lines)


def figures(run, cameras, lines):
    for scheme, word, title in SCHEMES:
        for count in cameras:
            line = lines[scheme, count]
            tag = '%s_%d_cameras' % (scheme, count)
            shortest = line.shortest()
            if shortest is None:
                run.say('With %d cameras and %s, fewer than %.0f %% succeed even at the longest %s.'
                        % (count, title, 100.0 * ENOUGH, word))
            else:
                run.figure(f'shortest_{word}_{tag}', shortest, 'ms', min(line.tries),
                           note='Shortest %s from which on at least %.0f %% of the tries succeed, '
                           '%s, %d cameras' % (word, 100.0 * ENOUGH, title, count))
            at = line.at(SHOWN_PERIOD if scheme == 'paper' else SHOWN_CHIP)
            run.share(f'success_{tag}', line.right[at], line.tries[at],
                      'Success with a %s of %g ms, %s, %d cameras' % (
                          word, line.lengths[at], title, count),
                      headline=scheme == 'paper' and count == max(cameras))
            if len(line.seconds[at]) > 1:
                run.estimate(f'time_{tag}', line.seconds[at], np.median, 's',
                             'Time until all four LEDs have their labels, %s of %g ms, %s, %d '
                             'cameras, median' % (word, line.lengths[at], title, count))
    wrong = sum(line.wrong for line in lines.values())
    of = sum(sum(line.tries) for line in lines.values())
    run.share('wrong_label_ever', wrong, of,
              'Tries in which an LED was ever given the label of another, of all lengths')
    best = lines['paper', max(cameras)]
    if best.shortest() is not None and len(best.seconds[best.at(SHOWN_PERIOD)]):
        run.summary('**Identification**, simulated: the paper\'s scheme identifies four LEDs in at '
                    'least %.0f %% of %d tries with periods from %.0f ms on (%d cameras); with '
                    '%.0f ms it takes %.2f s.' % (
                        100.0 * ENOUGH, min(best.tries), best.shortest(), max(cameras),
                        SHOWN_PERIOD, np.median(best.seconds[best.at(SHOWN_PERIOD)])))


def plot(run, cameras, lines):
    figure, axes = charts.figure(2, 2, height=4.8, sharex='col')
    for column, (scheme, word, title) in enumerate(SCHEMES):
        for count, color in zip(cameras, charts.COLORS):
            line = lines[scheme, count]
            some = [i for i, seconds in enumerate(line.seconds) if len(seconds)]
            times = np.array([np.quantile(line.seconds[i], [0.05, 0.5, 0.95])
                              for i in some]).reshape(-1, 3)
            shares = np.insert(line.intervals, 1, line.shares, axis=1)
            for axis, lengths, bands in ((axes[0][column], line.lengths, shares),
                                         (axes[1][column], line.lengths[some], times)):
                low, middle, high = bands.T
                axis.fill_between(lengths, low, high, color=color, alpha=0.12, linewidth=0)
                axis.plot(lengths, middle, 'o-', color=color, markersize=3,
                          label='%d cameras' % count)
        axes[0][column].set(title=title[0].upper() + title[1:], ylim=(0.0, 104.0))
        charts.log_axis(axes[1][column], 'x', (25, 50, 100, 200, 500) if scheme == 'paper' else
                        (3, 5, 10, 20, 40))
        axes[1][column].set(ylim=(0.0, None), xlabel=f'{word} [ms]')
    axes[0][0].set_ylabel('success [%]')
    axes[1][0].set_ylabel('time until all have labels [s]')
    charts.key(axes[0][1], 'lower right')
    run.plot('identification', figure, 'Success (with 95 % intervals) and time until all four LEDs '
             'have their labels (median, and 5 to 95 %; successes only), by the period of the '
             'paper\'s scheme and the chip of cyclic codes.')
