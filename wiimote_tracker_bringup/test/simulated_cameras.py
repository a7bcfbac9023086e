#!/usr/bin/env python3
"""Unsynchronised consumer cameras around a moving light, in the format of `evaluate_recording
cameras`, with known time maps. As a program: simulated_cameras.py PATH.csv DIR, rows time, x, y, z
in s and m."""

import os
import sys

import numpy as np
import yaml
from scipy.interpolate import CubicSpline
from wiimote_tracker_bringup.scene import look_at

# Of each camera: frames a second as stated, drift against the truth's clock, time of frame 0 [s],
# read-out of all lines [s].
CLOCKS = ((30.0, 0.0, 0.13, 0.016), (25.0, 3e-4, -0.82, 0.028), (59.94, -4e-4, 0.41, 0.009),
          (50.0, 1e-4, 1.27, 0.0))
WIDTH, HEIGHT, FOCAL = 1280, 720, 900.0  # [px]
DISTORTION = (-0.12, 0.03, 5e-4, -3e-4, 0.0)
NOISE = 0.3  # [px]
DISTANCE, ELEVATION = 4.5, 1.3  # of the cameras from the path's middle, and above it [m]


class Cameras:
    """times n, positions n x 3: the path of the light; rotations: camera to world."""

    def __init__(self, times, positions):
        self.times, self.positions = times, positions
        self.path = CubicSpline(times, positions)
        middle = 0.5 * (positions.min(axis=0) + positions.max(axis=0))
        angles = np.linspace(0.3, 0.3 + 1.5 * np.pi, len(CLOCKS))
        self.centers = middle + np.column_stack([DISTANCE * np.cos(angles),
                                                 DISTANCE * np.sin(angles),
                                                 np.full(len(CLOCKS), ELEVATION)])
        self.rotations = look_at(self.centers, middle)

    def project(self, number, times):
        inside = (self.path(times) - self.centers[number]) @ self.rotations[number]
        x, y = (inside[:, :2] / inside[:, 2:]).T
        k1, k2, p1, p2, _ = DISTORTION
        square = x * x + y * y
        radial = 1.0 + square * (k1 + square * k2)
        plane = np.column_stack([x * radial + 2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
                                 y * radial + p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y])
        return FOCAL * plane + 0.5 * np.array([WIDTH - 1, HEIGHT - 1])

    def exposures(self, number):
        """Frames, and the true times at which their middle lines are exposed [s]."""
        rate, drift, start, read_out = CLOCKS[number]
        first, last = self.times[[0, -1]] + [read_out, -read_out]
        step = (1.0 + drift) / rate
        frames = np.arange(max(0, np.ceil((first - start) / step)), (last - start) // step)
        return frames, start + step * frames

    def detections(self, number, random):
        """Rows frame, u, v of what lies in the image."""
        frames, middles = self.exposures(number)
        times = middles
        for _ in range(8):  # each line has its own time
            pixels = self.project(number, times)
            times = middles + CLOCKS[number][3] * (pixels[:, 1] / HEIGHT - 0.5)
        pixels = self.project(number, times) + NOISE * random.randn(len(frames), 2)
        seen = ((pixels >= 0.0) & (pixels <= [WIDTH - 1, HEIGHT - 1])).all(axis=1)
        return np.column_stack([frames, pixels])[seen]

    def write(self, folder, random):
        lens = {'width': WIDTH, 'height': HEIGHT, 'fx': FOCAL, 'fy': FOCAL, 'cx': 0.5 * (WIDTH - 1),
                'cy': 0.5 * (HEIGHT - 1), 'distortion': list(DISTORTION)}
        with open(os.path.join(folder, 'cameras.yaml'), 'w') as file:
            yaml.safe_dump({f'c{number}': dict(lens, rate=clock[0], rolling_shutter=clock[3] > 0.0)
                            for number, clock in enumerate(CLOCKS)}, file)
        with open(os.path.join(folder, 'detections.csv'), 'w') as file:
            file.write('camera,frame,u,v\n')
            for number in range(len(CLOCKS)):
                for frame, u, v in self.detections(number, random):
                    file.write(f'c{number},{frame:.0f},{u:.3f},{v:.3f}\n')
        np.savetxt(os.path.join(folder, 'truth.csv'), np.column_stack([self.times, self.positions]),
                   '%.6f', ',', header='time,x,y,z', comments='')


if __name__ == '__main__':
    table = np.loadtxt(sys.argv[1], delimiter=',', skiprows=1)
    os.makedirs(sys.argv[2], exist_ok=True)
    Cameras(table[:, 0], table[:, 1:4]).write(sys.argv[2], np.random.RandomState(1))
