"""Range of an LED: its brightness by current and angle, and the threshold of the sensor.

Brightness is the irradiance at the camera, in units of the Wii's sensor bar at 1 m, as in the
virtual Wii Remote, whose sensor decides what is seen.
"""

import numpy as np

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml

SENSITIVITIES = ('wii_1', 'wii_2', 'wii_3', 'wii_4', 'wii_5', 'max')


class Led:
    """An LED described by a file. measured: (current [A], distance [m]) pairs."""

    def __init__(self, half_power_angle, sensitivity, measured):
        """half_power_angle: full [degrees]."""
        self.half_power_angle = half_power_angle
        self.sensitivity = sensitivity
        self.measured = sorted(measured)
        # Generalised Lambertian: cos^n of the angle, halved at half the full angle.
        self.exponent = np.log(0.5) / np.log(np.cos(np.radians(half_power_angle / 2.0)))

    def relative(self, angle: float) -> float:
        """Relative brightness at an angle [rad] from the brightest direction [0..1]."""
        return np.maximum(np.cos(angle), 0.0) ** self.exponent

    def brightness_per_ampere(self, threshold: float) -> float:
        """Brightness at 1 m with 1 A [sensor bars/A], fitted to the measured pairs for a remote
        with this threshold. At the distance d the brightness k i / d^2 equals the threshold: every
        pair gives a k, and their geometric mean is the least-squares fit of log d."""
        return float(np.exp(np.mean([np.log(threshold * distance ** 2 / current)
                                     for current, distance in self.measured])))


def detection_distance(brightness: float, threshold: float) -> float:
    """Where a light of this brightness (at 1 m) is just seen [m]: inverse square law."""
    return np.sqrt(np.asarray(brightness, dtype=float) / threshold)


def read_led(path: str) -> Led:
    """Reads an LED from a file such as led.yaml. @raise Refusal: says what is wrong."""
    content = read_yaml(path)
    try:
        angle = float(content['half_power_angle'])
        sensitivity = content['sensitivity']
        measured = [(float(current), float(distance))
                    for current, distance in content['distances'].items()]
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Refusal(f'{path} is not a description of an LED ({type(error).__name__}: '
                      f'{error}); see led.yaml of this package')
    if not 1.0 <= angle <= 179.0:
        raise Refusal(f'{path}: half_power_angle is {angle:g}, but must be within 1 and '
                      '179 degrees')
    if sensitivity not in SENSITIVITIES:
        raise Refusal(f"{path}: sensitivity is {sensitivity!r}, but must be one of "
                      f"{', '.join(SENSITIVITIES)}")
    if not measured or any(not (current > 0.0 and distance > 0.0)
                           for current, distance in measured):
        raise Refusal(f'{path}: distances needs a pair at least, currents and distances '
                      'above 0')
    return Led(angle, sensitivity, measured)
