"""Detection distance: a person carries the remote away from the LED."""

import time

import numpy as np

from wiimote_tracker_bringup import charts
from wiimote_tracker_bringup.files import write_yaml
from wiimote_tracker_evaluation.live.dialogue import SKIP
from wiimote_tracker_evaluation.live.running_tracker import with_tracker

TIME_LIMIT = 0.5  # the paper's: time without a new position [s]


class Watch:
    """Time since the brightest spot of a camera moved."""

    def __init__(self, camera):
        import rospy
        from wiimote_tracker_msgs.msg import IrBlobArray
        self._pixel = None
        self.changed = None  # [s, monotonic]; None: not seen yet
        self._subscriber = rospy.Subscriber(camera + '/ir_blobs', IrBlobArray, self._on_image)

    def _on_image(self, message):
        pixels = [(blob.x, blob.y) for blob in message.blobs]
        if pixels and pixels[0] != self._pixel:
            self._pixel = pixels[0]
            self.changed = time.monotonic()

    def is_over(self):
        return self.changed is not None and time.monotonic() - self.changed >= TIME_LIMIT

    def close(self):
        self._subscriber.unregister()


@with_tracker
def live(run, _, dialogue):
    dialogue.line('Take one remote; hold it towards the LED, in small circles all the time, and '
                  'walk slowly backwards until you hear a beep. Then measure the distance.')
    camera = dialogue.ask('Name of that camera, such as wiimote_1 (Enter: skip this):')
    if not camera:
        run.say('The detection distance was skipped.')
        return
    pairs = []
    while True:
        current = dialogue.ask_number('Current through the LED in mA (Enter: finish):', 0.1, 1e5)
        if current is None:
            break
        distance = one_walk(dialogue, camera)
        if distance is not None:
            pairs.append((current, distance))
    tell(run, camera, pairs)


def one_walk(dialogue, camera):
    """The distance measured by the person [m], or None."""
    dialogue.line('      Start near the LED and walk (s and Enter: skip this one).')
    watch = Watch(camera)
    try:
        while not watch.is_over():
            dialogue.passing('nothing seen yet' if watch.changed is None else 'it is seen')
            if dialogue.typed() == SKIP:
                return None
            time.sleep(0.02)
    finally:
        watch.close()
    dialogue.beep()
    return dialogue.ask_number('Not seen any more. Distance to the LED in metres (Enter: discard):',
                               0.01, 1000.0)


def tell(run, camera, pairs):
    run.say(f'A person has carried {camera} away from the LED in small circles until its spot had '
            'not moved '
            f'for {TIME_LIMIT:.1f} s.')
    run.table('distances', [('current', 'mA'), ('distance', 'm')], [list(pair) for pair in pairs])
    if not pairs:
        run.say('No distance was measured: there are no figures.')
        return
    currents, distances = np.array(sorted(pairs)).T
    factor = np.exp(np.mean(np.log(distances / np.sqrt(1e-3 * currents))))
    means = {}
    for current in np.unique(currents):
        values = distances[currents == current]
        means[float(1e-3 * current)] = float(np.mean(values))
        run.figure(f"live_{('%g' % current).replace('.', '_')}_mA", np.mean(values), 'm',
                   len(values), note=f'Distance from which the LED is seen with {current:g} mA',
                   end_to_end=True)
    write_yaml(run.file('distances.yaml'), {'distances': means})
    run.say('`distance/distances.yaml` holds the means for a file such as `led.yaml` (`--led`).')
    run.figure('live_1_A', factor, 'm', len(pairs), note='The same with 1 A, by the inverse square '
               'law fitted to all', end_to_end=True)
    figure, axes = charts.figure()
    curve = np.geomspace(0.5 * currents.min(), 2.0 * currents.max(), 100)
    axes.plot(curve, factor * np.sqrt(1e-3 * curve), color=charts.BLUE,
              label='fitted, inverse square')
    axes.plot(currents, distances, 'D', color=charts.INK, label='measured')
    axes.set(xlabel='current [mA]', ylabel='detection distance [m]', ylim=(0.0, None))
    charts.key(axes, 'upper left')
    run.plot('distance', figure, 'Distance from which the LED is seen, over its current.')
    run.summary(f'The LED is seen from {distances[-1]:.1f} m with {currents[-1]:g} mA.')
