"""Where a base sits on a body: maximum likelihood over the path of the base and what is constant.

The path is a chain of states. There are six groups of residuals. All depend on a state. Groups 0
to 3 also depend on the next state. Groups 0, 1, 4 and 5 depend on what is constant:

    0, 1  how the base moves from one state to the next, by odometry or an IMU
    2, 3  how the slow errors of the body's rotations [rad] and positions [m] change
    4, 5  rotations [rad] and positions [m] of the base against the poses of the body

Gauss-Newton on the sparse normal equations. The noise of each group is estimated along with the
rest: its variance is the sum of squares over its redundancy (W. Foerstner, "Ein Verfahren zur
Schaetzung von Varianz- und Kovarianzkomponenten", 1979), found by random probes (M. F. Hutchinson,
Communications in Statistics 19(2), 1990).
"""

import dataclasses

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial.transform import Rotation

from wiimote_tracker_body_motion.mount import Mount
from wiimote_tracker_bringup.errors import Refusal

STEP = 1e-4  # of the derivatives
LEAST_ITERATIONS, MOST_ITERATIONS = 6, 30  # the first ones find the noise
PROBES = 4
CORRELATED = 0.25  # residuals of different intervals of this length are independent [s]
LEAST_NOISE = 1e-6  # [rad, m], of what else would be exact
LARGEST_STDDEV = 0.03  # of a translation that is told [m]
SLOW = 1.0  # autocorrelation time of the slow errors of the body's poses [s]
# First guesses of the standard deviations of groups 2 to 5 [rad, m].
BODY_NOISE = 5e-4, 5e-4, 0.01, 0.002


@dataclasses.dataclass
class State:
    """rotation: body_from_base. vector: translation [m], clock offset [s], what else is constant.
    rotations, vectors: of the chain, the base in the world; vectors begin with the slow errors of
    the body's rotation [rad] and position [m], and end with the base's position [m]."""

    rotation: Rotation
    vector: np.ndarray
    rotations: Rotation
    vectors: np.ndarray

    def with_constants(self, change):
        """Changed by a rotation vector in the body's frame, then a vector."""
        return dataclasses.replace(self, rotation=Rotation.from_rotvec(change[:3]) * self.rotation,
                                   vector=self.vector + change[3:])

    def with_chain(self, change):
        """Changed, all states or each, by a rotation vector in the world's frame, then a vector."""
        return dataclasses.replace(
            self, rotations=Rotation.from_rotvec(change[..., :3]) * self.rotations,
            vectors=self.vectors + change[..., 3:])


def solve(problem, state, names, report):
    """names: of the body and the base. report: is called with a sentence after each step, which can
    take seconds. @returns Mount. problem has

    body: its Poses; times: of the states [s]; durations: from each state to the next, n x 1 [s];
    noise: a first guess of the standard deviations of groups 0 and 1;
    rows(state): for each pose of the body the number of the state before it;
    motions(before, after): residuals of groups 0 and 1, n x values each, where the constants and
    first states are those of one State, the next states those of another;
    poses(state, rows): rotations and positions of the base in the world at the body's poses."""
    noise = np.array(problem.noise + BODY_NOISE)
    for iteration in range(MOST_ITERATIONS):
        equations = Equations(problem, state, noise)
        constants, chain = equations.step()
        covariance = (equations.covariance() + equations.lasting_covariance(noise))[:7, :7]
        state = state.with_constants(constants).with_chain(chain)
        report(f'step {iteration + 1} of at most {MOST_ITERATIONS}: clock offset '
               f'{1e3 * state.vector[3]:.2f} +- {1e3 * np.sqrt(covariance[6, 6]):.2f} ms')
        if (iteration >= LEAST_ITERATIONS
                and (np.abs(constants[3:7]) < 0.05 * np.sqrt(np.diag(covariance)[3:])).all()):
            break
        noise = np.maximum(noise * equations.noise_factors(), LEAST_NOISE)
    else:
        raise Refusal('no solution was found: do both topics belong to one robot, are the '
                      'axes of both right-handed, and do the clocks differ by less than '
                      '--largest-offset?')
    stddev = np.sqrt(np.linalg.eigvalsh(covariance[3:6, 3:6])[-1])
    if not stddev < LARGEST_STDDEV:
        raise Refusal(f'the translation is told to {1e3 * stddev:.0f} mm only: turn the '
                      'base faster, about two axes')
    return Mount(state.rotation, state.vector[:3], state.vector[3], covariance, *names)


def between_states(problem, before, after):
    """Residuals of groups 0 to 3, steps x values each. before, after: as of problem.motions."""
    # The slow errors are a first-order Gauss-Markov process.
    decay = np.exp(-problem.durations / SLOW)
    changes = (after.vectors[1:, :6] - decay * before.vectors[:-1, :6]) / np.sqrt(1.0 - decay ** 2)
    return (*problem.motions(before, after), *np.split(changes, 2, axis=1))


def at_poses(problem, state, rows):
    """Residuals of groups 4 and 5, poses x values each."""
    rotations, positions = problem.poses(state, rows)
    turned = rotations * state.rotation.inv()
    slow_turn, slow_shift = np.split(state.vectors[rows, :6], 2, axis=1)
    return ((turned * problem.body.rotations.inv()).as_rotvec() + slow_turn,
            positions - turned.apply(state.vector[:3]) - problem.body.positions + slow_shift)


def linearised(problem, state, rows):
    """For each group: residuals, rows x values; their derivatives by the constants, rows x values x
    constants, and by the states that they depend on; by forward differences."""
    constants = [state.with_constants(step) for step in STEP * np.eye(3 + len(state.vector))]
    chain = [state.with_chain(step) for step in STEP * np.eye(3 + state.vectors.shape[1])]
    steps, poses = between_states(problem, state, state), at_poses(problem, state, rows)

    def slopes(here, *moved):
        return [np.stack([(there - group) / STEP for there in theirs], axis=2)
                for group, *theirs in zip(here, *moved)]
    return ([*steps, *poses],
            slopes(steps, *(between_states(problem, moved, moved) for moved in constants))
            + slopes(poses, *(at_poses(problem, moved, rows) for moved in constants)),
            slopes(steps, *(between_states(problem, moved, state) for moved in chain),
                   *(between_states(problem, state, moved) for moved in chain))
            + slopes(poses, *(at_poses(problem, moved, rows) for moved in chain)))


class Equations:
    """Linear equations at a state, each divided by its noise: matrix x change + rest = 0. The last
    columns are the constants, so many; the others are the states of the chain in their order."""

    def __init__(self, problem, state, noise):
        rows, steps = problem.rows(state), np.arange(len(problem.durations))
        here, by_constants, by_states = linearised(problem, state, rows)
        self.body, self.size = problem.body, 3 + state.vectors.shape[1]
        parts, times = [], []
        for first, constants, states, stddev in zip(
                (*4 * [steps], rows, rows), by_constants, by_states, noise):
            count, values, width = states.shape
            columns = np.repeat(self.size * first[:, None] + np.arange(width), values, axis=0)
            chain = sparse.csr_matrix(
                (states.ravel() / stddev, columns.ravel(), width * np.arange(count * values + 1)),
                (count * values, self.size * len(state.vectors)))
            parts.append(sparse.hstack(
                [chain, constants.reshape(count * values, -1) / stddev], 'csr'))
            times.append(problem.times[first].repeat(values))
        self.rest = np.concatenate([each.ravel() / stddev for each, stddev in zip(here, noise)])
        self.group = np.repeat(np.arange(len(here)), [each.size for each in here])
        interval = np.unique(np.concatenate(times) // CORRELATED, return_inverse=True)[1]
        self.sums = sparse.csr_matrix((np.ones(len(interval)),
                                       (interval, np.arange(len(interval)))))
        self.matrix = sparse.vstack(parts, 'csr')
        self.solver = splu((self.matrix.T @ self.matrix).tocsc(), permc_spec='NATURAL',
                           diag_pivot_thresh=0.0, options={'SymmetricMode': True})
        # By how much each equation changes each constant, and from that their covariance.
        unknowns, self.constants = self.matrix.shape[1], by_constants[0].shape[2]
        self.gains = self.matrix @ self.solver.solve(
            np.eye(unknowns, self.constants, self.constants - unknowns))
        self.inverse = self.gains.T @ self.gains

    def step(self):
        """Changes of the constants and of the states of the chain."""
        change = -self.solver.solve(self.matrix.T @ self.rest)
        return change[-self.constants:], change[:-self.constants].reshape(-1, self.size)

    def left(self, values):
        """What is left of n x m values after least squares."""
        return values - self.matrix @ self.solver.solve(self.matrix.T @ values)

    def covariance(self):
        """Of the constants. Noise that is correlated in time makes it greater, by how much more the
        sums of gradients over intervals vary than those of white noise."""
        white = np.random.default_rng(1).normal(size=(PROBES, len(self.rest)))
        expected = np.mean([self.variation(each) for each in white], axis=0)
        scale = np.sqrt(np.maximum(self.variation(self.rest) / expected, 1.0))
        return scale[:, None] * self.inverse * scale

    def variation(self, values):
        """Sum of squares, over intervals, of what an interval changes each constant by."""
        changes = self.sums @ (self.gains * self.left(values[:, None]))
        return (changes ** 2).sum(axis=0)

    def lasting_covariance(self, noise):
        """Of the constants, from errors of the body's poses that are the same whenever it comes
        back, as those of the calibration: as large as the slow ones, linear in place and
        orientation."""
        features = np.hstack([self.body.positions, self.body.rotations.as_matrix().reshape(-1, 9)])
        features -= features.mean(axis=0)
        features /= np.sqrt((features ** 2).sum() / len(features))  # together 1 (RMS)
        changes = []
        for group, slow in ((4, 2), (5, 3)):
            gains = self.gains[self.group == group].reshape(-1, 3, self.constants)
            changes += [gains[:, axis].T @ features * (noise[slow] / noise[group])
                        for axis in range(3)]
        changes = np.hstack(changes)
        return changes @ changes.T

    def noise_factors(self):
        """What to multiply the standard deviation of each group by."""
        rest = self.left(self.rest[:, None])[:, 0]
        random = np.random.default_rng(1)
        factors = []
        for group in range(self.group[-1] + 1):
            inside = self.group == group
            probes = inside[:, None] * random.choice([-1.0, 1.0], (len(rest), PROBES))
            redundancy = np.mean(np.sum(probes * self.left(probes), axis=0))
            factors.append(np.sqrt((rest[inside] ** 2).sum() / max(redundancy, 1.0)))
        # Where there are no slow errors, theirs would fall to zero slowly.
        slow = np.array(factors[2:4])
        factors[2:4] = np.where(slow < 1.0, slow ** 4, slow)
        return np.clip(factors, 0.2, 5.0)
