"""Where an IMU sits on a tracked body, from its gyro and accelerometer.

The IMU tells how it moves from one state of the chain to the next, but for constant biases and
white noise. The world's z axis points up.
"""

import dataclasses

import numpy as np
from scipy.spatial.transform import Rotation

from wiimote_tracker_body_motion import mount_solver, mount_start
from wiimote_tracker_body_motion.poses import Poses, read_rows
from wiimote_tracker_bringup.errors import Refusal

GRAVITY = np.array([0.0, 0.0, -9.80665])  # [m/s^2]
SHORTEST_STEP = 0.008  # faster samples are averaged [s]
FORCES = 0.7, 1.5  # median, times gravity; IMUs that measure in g have 0.1
MOST_CLIPPED = 0.005  # of the samples


@dataclasses.dataclass
class Samples:
    """times: n, ascending [s]; rates: n x 3 [rad/s]; forces: n x 3, what the accelerometer measures
    [m/s^2]; both along the axes of the frame child."""

    times: np.ndarray
    rates: np.ndarray
    forces: np.ndarray
    child: str = 'imu'

    def averaged(self):
        """Means of as many samples that their interval is SHORTEST_STEP or more."""
        count = max(1, int(np.ceil(0.99 * SHORTEST_STEP / np.median(np.diff(self.times)))))
        use = len(self.times) // count * count
        return dataclasses.replace(self, **{
            name: values[:use].reshape(-1, count, *values.shape[1:]).mean(axis=1)
            for name, values in vars(self).items() if name != 'child'})

    def rotations(self):
        """Poses at the samples: the rates added up, positions zero."""
        steps = 0.5 * (self.rates[1:] + self.rates[:-1]) * np.diff(self.times)[:, None]
        turned = [Rotation.identity()]
        for step in Rotation.from_rotvec(steps):
            turned.append(turned[-1] * step)
        quaternions = [rotation.as_quat() for rotation in turned]
        return Poses(self.times, np.zeros_like(self.rates), Rotation.from_quat(quaternions))


def solve(body, imu, largest_offset=2.0, report=lambda sentence: None):
    """body: Poses. imu: Samples. report: see mount_solver. @returns Mount of the IMU"""
    gap = np.diff(imu.times).max()
    if gap > mount_start.LONGEST_GAP:
        raise Refusal(f'the IMU says nothing for {gap:.2f} s; record again, or cut the bag '
                      'there')
    force = np.median(np.linalg.norm(imu.forces, axis=1))
    least, most = (factor * np.linalg.norm(GRAVITY) for factor in FORCES)
    if not least < force < most:
        raise Refusal(f'the accelerometer measures {force:.3g} m/s^2 (median), but about '
                      '9.8 are expected: sensor_msgs/Imu is in m/s^2, not in g, and '
                      'gravity is not subtracted')
    check_range('accelerometer', imu.forces, 'm/s^2')
    check_range('gyro', imu.rates, 'rad/s')
    imu = imu.averaged()
    body, rotation, offset = mount_start.start(body, imu.rotations(), largest_offset)
    problem = Problem(body, imu, offset)
    return mount_solver.solve(problem, problem.start(rotation), (body.child, imu.child),
                              report)


def check_range(sensor, values, unit):
    """Throws Refusal if a sensor clips: samples that equal the one before are then at an end of its
    range, since noise changes the others. values: n x 3."""
    stays = np.diff(values, axis=0) == 0.0
    ends = np.stack([values.min(axis=0), values.max(axis=0)])
    at_end = values[1:] == ends[:, None]
    clipped = (stays & at_end).mean(axis=1)
    others = (stays & ~at_end.any(axis=0)).mean(axis=0)
    for end, axis in np.argwhere((clipped > MOST_CLIPPED) & (clipped > others)):
        share = 100.0 * clipped[end, axis]
        raise Refusal(f'the {sensor} clips: {share:.1f} % of the time it stays at '
                      f'{ends[end, axis]:.4g} {unit} along {"xyz"[axis]}; set a larger range, or '
                      'move it more gently')


class Problem:
    """Of mount_solver. States: orientation, velocity and position of the IMU in the world, at the
    middles between samples, which are constant from one state to the next."""

    noise = 1e-3, 0.01  # [rad/s, m/s^2 / sqrt(Hz)]

    def __init__(self, body, imu, offset):
        self.body, self.offset = body, offset
        middles = 0.5 * (imu.times[1:] + imu.times[:-1]) + offset
        inside = np.flatnonzero((middles > body.times[0] - 0.05)
                                & (middles < body.times[-1] + 0.05))
        self.times = middles[inside]
        self.rates, self.forces = imu.rates[inside[1:]], imu.forces[inside[1:]]
        self.durations = np.diff(self.times)[:, None]

    def times_of_poses(self, state):
        """In the clock of the states, which has the first guess of the offset [s]."""
        return self.body.times - (state.vector[3] - self.offset)

    def rows(self, state):
        before = np.searchsorted(self.times, self.times_of_poses(state)) - 1
        return np.clip(before, 0, len(self.durations) - 1)

    def start(self, rotation):
        body = self.body.at(np.clip(self.times, *self.body.times[[0, -1]]))
        vectors = np.hstack([np.zeros((len(self.times), 6)),
                             np.gradient(body.positions, self.times, axis=0), body.positions])
        return mount_solver.State(rotation, np.r_[0.0, 0.0, 0.0, self.offset, np.zeros(6)],
                                  body.rotations * rotation, vectors)

    def moved(self, state, first, duration):
        """Rotations, velocities and positions after durations, n x 1, from the first states."""
        rate_bias, force_bias = state.vector[4:7], state.vector[7:10]
        rate, rotations = self.rates[first] - rate_bias, state.rotations[first]
        middle = rotations * Rotation.from_rotvec(0.5 * duration * rate)
        gained = duration * (middle.apply(self.forces[first] - force_bias) + GRAVITY)
        velocities, positions = np.split(state.vectors[first, 6:], 2, axis=1)
        return (rotations * Rotation.from_rotvec(duration * rate), velocities + gained,
                positions + duration * (velocities + 0.5 * gained))

    def motions(self, before, after):
        h = self.durations
        turned, velocities, positions = self.moved(before, np.arange(len(h)), h)
        faster, further = np.split(np.hstack([velocities, positions]) - after.vectors[1:, 6:], 2,
                                   axis=1)
        # White noise of a step: the position is known from the velocity to h^3 / 12.
        moves = np.hstack([faster / np.sqrt(h),
                           (further - 0.5 * h * faster) * np.sqrt(12.0 / h ** 3)])
        return (turned * after.rotations[1:].inv()).as_rotvec() / np.sqrt(h), moves

    def poses(self, state, rows):
        since = self.times_of_poses(state) - self.times[rows]
        rotations, _, positions = self.moved(state, rows, since[:, None])
        return rotations, positions


def numbers(message):
    rate, force = message.angular_velocity, message.linear_acceleration
    return rate.x, rate.y, rate.z, force.x, force.y, force.z


def read(path, topic):
    """The samples of a topic of a bag. Throws Refusal."""
    rows, message = read_rows(path, topic, {'sensor_msgs/Imu': numbers}, 'IMU samples')
    if len(rows) < 100:
        raise Refusal(f'{topic} in {path} has {len(rows)} samples; 100 are needed')
    return Samples(rows[:, 0], rows[:, 1:4], rows[:, 4:], message.header.frame_id or 'imu')
