#!/usr/bin/env python3
"""Two people carry four LEDs: each LED keeps its identity through hiding, reflections and losses.

The truth comes from the simulation. test_people.cpp checks that two cameras always separate any two
LEDs.
"""

import collections
import sys

import numpy as np
import rostest
from live_rig import LiveRigTest
from wiimote_tracker_msgs.msg import IrMask, TrackedPoint

DURATION = 20.0   # evaluated [s]
WARM_UP = 3.0     # after all are tracked; the drivers' clocks settle [s]
MASK_RADIUS = 6.0  # about a reflection [px]
ASTRAY = 0.1      # largest error of a point; the LEDs are farther apart [m]
CHI_SQUARED_95, CHI_SQUARED_05 = 7.81, 0.35  # 95 % and 5 % quantiles, three degrees of freedom


class Track:
    """The published points of one LED, by id."""

    def __init__(self):
        self.stamps, self.positions, self.covariances, self.states = [], [], [], []

    def add(self, stamp, point):
        self.stamps.append(stamp)
        self.positions.append((point.position.x, point.position.y, point.position.z))
        self.covariances.append(point.position_covariance)
        self.states.append(point.state)


class People(LiveRigTest):
    def test_four_leds_keep_their_identities(self):
        self.calibrate(self.masks())
        self.in_real_time(self.judge, self.warm, DURATION, before=WARM_UP)

    def judge(self, begin, end):
        tracks, labels = collections.defaultdict(Track), collections.defaultdict(set)
        lost = 0
        stamps = [message.header.stamp.to_sec() for message in list(self.points)]
        self.assertTrue(np.all(np.diff(stamps) > 0), 'output times increase')
        for message in list(self.points):
            stamp = message.header.stamp.to_sec()
            if not begin <= stamp <= end:
                continue
            for point in message.points:
                if point.state in (TrackedPoint.TRACKED, TrackedPoint.PREDICTED):
                    tracks[point.id].add(stamp, point)
                    labels[point.id].add(point.label)
                lost += point.state == TrackedPoint.LOST

        inside = [t for t in stamps if begin <= t <= end]
        covered = dict.fromkeys(self.leds, 0)
        for number, track in sorted(tracks.items()):
            at = np.array(track.stamps)
            truth = {led: self.truth_at(led, at) for led in self.leds}
            distances = np.array([np.linalg.norm(np.array(track.positions) - truth[led], axis=1)
                                  for led in self.leds])
            nearest = np.argmin(distances, axis=0)
            led = self.leds[np.bincount(nearest).argmax()]
            share = len(at) / len(inside)
            error = distances[self.leds.index(led)]
            print('track %d, %s: %s, %.1f %% of the time, median error %.1f mm, largest %.0f mm' % (
                number, '/'.join(sorted(labels[number])), led, 100 * share, 1e3 * np.median(error),
                1e3 * error.max()))
            covered[led] += len(at)
            # A reflection or a wrong association is no LED's, and must not become tracked.
            self.assertLess(distances.min(axis=0).max(), ASTRAY, f'track {number}')
            for switch in np.flatnonzero(np.diff(nearest)):
                self.fail('track %d went from %s to %s at %.3f s' % (
                    number, self.leds[nearest[switch]], self.leds[nearest[switch + 1]],
                    at[switch]))
            self.assertEqual(len(labels[number]), 1, 'a track keeps its name')
            self.check_covariance(track, truth[led])
        print('%d outputs, %d tracks, %d lost; outputs of each LED: %s' % (
            len(inside), len(tracks), lost, covered))
        self.assertEqual(len(tracks), len(self.leds),
                         'one track for each LED, from the beginning on')
        self.assertEqual(set.union(*labels.values()), {'a', 'b', 'c', 'd'})
        for led in self.leds:
            self.assertGreater(covered[led], 0.99 * len(inside), led)

    def warm(self):
        """The time [s] when all LEDs will have been tracked for a while."""
        self.wait(self.all_are_tracked, 'four tracked LEDs')
        return self.points[-1].header.stamp.to_sec() + WARM_UP

    def all_are_tracked(self):
        return self.points and [point.state for point in self.points[-1].points].count(
            TrackedPoint.TRACKED) >= len(self.leds)

    def masks(self):
        """Masks of the reflections, as a calibration learns them. They still take the sensor's
        slots."""
        return [(reflection['camera'], IrMask(x=reflection['pixel'][0], y=reflection['pixel'][1],
                                              radius=MASK_RADIUS))
                for reflection in self.description['reflections'].values()]

    def check_covariance(self, track, truth):
        """The covariance is consistent with the errors, as far as correlated samples show."""
        error = np.array(track.positions) - truth
        covariance = np.array(track.covariances).reshape(-1, 3, 3)
        squared = np.einsum('ni,nij,nj->n', error, np.linalg.inv(covariance), error)
        print(f'    median of the normalised squared error: {np.median(squared):.2f} (2.37 when '
              'consistent)')
        self.assertLess(np.median(squared), CHI_SQUARED_95)
        self.assertGreater(np.median(squared), CHI_SQUARED_05)


if __name__ == '__main__':
    sys.exit(rostest.rosrun('wiimote_tracker_bringup', 'people', People))
