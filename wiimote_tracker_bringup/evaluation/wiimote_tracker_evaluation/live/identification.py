"""Time to identify blinking LEDs: a person switches them on."""

import time

import numpy as np

from wiimote_tracker_evaluation.live.dialogue import SKIP
from wiimote_tracker_evaluation.live.running_tracker import with_tracker

TRIES, QUICK_TRIES = 10, 3
LABEL_TIMEOUT = 10.0  # for labels, after the LEDs are seen [s]


@with_tracker
def live(run, tracker, dialogue):
    dialogue.line('The tracker needs the codes of your LEDs (argument blink_codes of its launch '
                  'file).')
    names = dialogue.ask('Labels of the LEDs, separated by commas (Enter: skip this):')
    labels = sorted(name.strip() for name in names.split(',') if name.strip())
    if not labels:
        run.say('Identification was skipped.')
        return
    tracker.wait_for_points()
    rows = []
    for number in range(QUICK_TRIES if run.quick else TRIES):
        dialogue.line('   %2d  Switch all LEDs off; then on.' % (number + 1))
        row = one_try(tracker, dialogue, labels)
        if row is None:
            break
        dialogue.line('       ' + (f'all have their labels after {row[1]:.2f} s' if row[0] else
                                   f'not all labels within {LABEL_TIMEOUT:.0f} s'))
        rows.append([number + 1, int(row[0]), row[1]])
    tell(run, labels, rows)


def one_try(tracker, dialogue, labels):
    """Whether all LEDs were labelled, and the time from their first light [s]; None: skipped."""
    if not wait(dialogue, lambda: not shown(tracker)):
        return None
    begin = tracker.now()
    if not wait(dialogue, lambda: first_light(tracker, begin) is not None):
        return None
    first = first_light(tracker, begin)
    while tracker.now() < first + LABEL_TIMEOUT:
        if sorted(led.label for led in shown(tracker) if led.since > 0.0) == labels:
            return True, tracker.now() - first
        time.sleep(0.005)
    return False, None


def first_light(tracker, begin):
    """Arrival of the first point after `begin`; None: not yet."""
    return next((seen.heard for seen in tracker.since(begin) if seen.leds), None)


def shown(tracker):
    """LEDs of the last moments."""
    newest = tracker.newest()
    return newest.leds if newest and tracker.now() - newest.heard < 0.5 else []


def wait(dialogue, condition):
    while not condition():
        if dialogue.typed() == SKIP:
            return False
        time.sleep(0.005)
    return True


def tell(run, labels, rows):
    run.say('A person has switched %d LEDs (%s) off and on; the time is from the first point of '
            'any of them to the labels of all.' % (len(labels), ', '.join(labels)))
    run.table('tries', [('try', ''), ('all_labelled', ''), ('time', 's')], rows)
    if not rows:
        return
    good = [row[2] for row in rows if row[1]]
    run.share('live_success', len(good), len(rows), 'Tries in which all LEDs got their labels',
              end_to_end=True)
    if len(good) > 1:
        run.estimate('live_time', good, np.median, 's', 'Time until all have their labels, median',
                     end_to_end=True)
        run.summary(f'Identification: {len(good)} of {len(rows)} tries, {np.median(good):.2f} s '
                    '(median).')
