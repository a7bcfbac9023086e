"""How far an LED is seen: brightness over current and angle, and what the sensor needs.

Brightness is the irradiance at the camera, 1 being the Wii's sensor bar from 1 m, as in the virtual
Wii Remote, whose sensor decides what is seen.
"""

import numpy as np
import yaml

from wiimote_tracker_evaluation.errors import ExperimentError

SENSITIVITIES = ('wii_1', 'wii_2', 'wii_3', 'wii_4', 'wii_5', 'max')


class Led(object):
    """An LED as its file describes it. measured: (current [A], distance [m]) pairs."""

    def __init__(self, half_power_angle, sensitivity, measured):
        """half_power_angle: full [degrees]."""
        self.half_power_angle = half_power_angle
        self.sensitivity = sensitivity
        self.measured = sorted(measured)
        # Lambert's law generalised: cos^n of the angle, halved at half the full angle.
        self.exponent = np.log(0.5) / np.log(np.cos(np.radians(half_power_angle / 2.0)))

    def relative(self, angle):
        """Brightness at an angle [rad] off the brightest direction, of that in it [0..1]."""
        return np.maximum(np.cos(angle), 0.0) ** self.exponent

    def brightness_per_ampere(self, threshold):
        """The one constant: brightness from 1 m with 1 A [sensor bars/A], from the measured pairs,
        for a remote of that threshold. At the distance d the brightness k i / d^2 is the threshold:
        every pair gives one k, and their geometric mean is the least-squares fit of log d."""
        return float(np.exp(np.mean([np.log(threshold * distance ** 2 / current)
                                     for current, distance in self.measured])))

    def misfit(self, threshold):
        """By which factor single measured distances differ from the fitted ones (standard deviation
        of the logarithm); None with fewer than two."""
        if len(self.measured) < 2:
            return None
        fitted = self.brightness_per_ampere(threshold)
        logs = [np.log(distance / np.sqrt(fitted * current / threshold))
                for current, distance in self.measured]
        return float(np.sqrt(np.sum(np.square(logs)) / (len(logs) - 1)))


def detection_distance(brightness, threshold):
    """From where a light of this brightness (at 1 m) is just seen [m]: inverse square law."""
    return np.sqrt(np.asarray(brightness, dtype=float) / threshold)


def read_led(path):
    """Led of a file such as led.yaml. @raise ExperimentError: says what is wrong with it."""
    try:
        with open(path) as file:
            content = yaml.safe_load(file)
        angle = float(content['half_power_angle'])
        sensitivity = content['sensitivity']
        measured = [(float(current), float(distance))
                    for current, distance in content['distances'].items()]
    except (OSError, yaml.YAMLError, KeyError, TypeError, ValueError, AttributeError) as error:
        raise ExperimentError('%s is no description of an LED (%s: %s); see led.yaml of this package'
                              % (path, type(error).__name__, error))
    if not 1.0 <= angle <= 179.0:
        raise ExperimentError('%s: half_power_angle is %g, but must be within 1 and 179 degrees'
                              % (path, angle))
    if sensitivity not in SENSITIVITIES:
        raise ExperimentError('%s: sensitivity is %r, but must be one of %s'
                              % (path, sensitivity, ', '.join(SENSITIVITIES)))
    if not measured or any(not (current > 0.0 and distance > 0.0)
                           for current, distance in measured):
        raise ExperimentError('%s: distances needs a pair at least, currents and distances above 0'
                              % path)
    return Led(angle, sensitivity, measured)
