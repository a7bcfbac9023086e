"""Where a base sits on a body: maximum likelihood over the path of the base and what is constant.

The path is a chain of states. Each residual depends on the constants, a state and the next one:
motions of the base between two states (odometry or an IMU), poses of the body, whose errors are
partly white and partly slow. Gauss-Newton on the sparse normal equations. The noise of each group
of residuals is estimated along with the rest: its variance is the sum of squares over its
redundancy (W. Foerstner, "Ein Verfahren zur Schaetzung von Varianz- und Kovarianzkomponenten",
1979), found by random probes (M. F. Hutchinson, Communications in Statistics 19(2), 1990).
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
SLOW_NOISE = 5e-4, 5e-4  # a first guess of their standard deviations [rad, m]

# Groups of residuals: two of the base's motion, then the body's rotations and positions, then the
# slow errors of both.
BODY_GROUPS, SLOW_GROUPS = [2, 3], [4, 5]


@dataclasses.dataclass
class State:
    """rotation: body_from_base. vector: translation [m], clock offset [s], what else is constant.
    rotations, vectors: of the chain, the base in the world; vectors begin with the slow errors of
    the body's rotation [rad] and position [m], and end with the base's position [m]."""

    rotation: Rotation
    vector: np.ndarray
    rotations: Rotation
    vectors: np.ndarray

    def moved(self, common=None, local=None):
        """By the constants and by the states of the chain: rotation vectors in the body's and the
        world's frame, then vectors. local: one for all states or one for each."""
        result = self
        if common is not None:
            result = dataclasses.replace(
                result, rotation=Rotation.from_rotvec(common[:3]) * self.rotation,
                vector=self.vector + common[3:])
        if local is not None:
            result = dataclasses.replace(
                result, rotations=Rotation.from_rotvec(local[..., :3]) * self.rotations,
                vectors=self.vectors + local[..., 3:])
        return result

    def body_residuals(self, rotations, positions, body, first):
        """Rotations [rad] and positions [m], n x 3: base's poses in the world against body's.
        first: the number of the state before each."""
        turned = rotations * self.rotation.inv()
        slow_turn, slow_shift = np.split(self.vectors[first, :6], 2, axis=1)
        return ((turned * body.rotations.inv()).as_rotvec() + slow_turn,
                positions - turned.apply(self.vector[:3]) - body.positions + slow_shift)

    def slow_residuals(self, after, durations):
        """How the slow errors change from each state to the next: a first-order Gauss-Markov
        process. durations: n x 1 [s]."""
        decay = np.exp(-durations / SLOW)
        change = (after.vectors[1:, :6] - decay * self.vectors[:-1, :6]) / np.sqrt(1.0 - decay ** 2)
        return np.split(change, 2, axis=1)


def solve(problem, state, names, report):
    """names: of the body and the base. report: is called with a sentence after each step, which can
    take seconds. @returns Mount. problem has

    times: of the states [s]; noise: a first guess of each group's standard deviation;
    place(state): chooses and returns, for each group, the number of the first state of each row;
    residuals(before, after): of each group, rows x values; the constants and first states are those
    of one State, the next states those of another."""
    noise = np.array(problem.noise)
    for iteration in range(MOST_ITERATIONS):
        equations = Equations(problem, state, noise)
        common, local = equations.step()
        covariance = (equations.covariance() + equations.lasting_covariance(noise))[:7, :7]
        state = state.moved(common, local)
        report(f'step {iteration + 1} of at most {MOST_ITERATIONS}: clock offset '
               f'{1e3 * state.vector[3]:.2f} +- {1e3 * np.sqrt(covariance[6, 6]):.2f} ms')
        if (iteration >= LEAST_ITERATIONS
                and (np.abs(common[3:7]) < 0.05 * np.sqrt(np.diag(covariance)[3:])).all()):
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


def derivatives(problem, state):
    """By forward differences. By the constants: of each group, rows x values x constants. By the
    chain: rows x values x (a state and the next)."""
    here = problem.residuals(state, state)

    def differences(count, moved):
        """moved(step): the State of the residuals, and that of the next states in the chain."""
        there = [problem.residuals(*moved(step)) for step in STEP * np.eye(count)]
        return [np.stack([(each[group] - here[group]) / STEP for each in there], axis=2)
                for group in range(len(here))]

    size = 3 + state.vectors.shape[1]
    by_constants = differences(3 + len(state.vector), lambda step: 2 * [state.moved(step)])
    by_before = differences(size, lambda step: (state.moved(local=step), state))
    by_after = differences(size, lambda step: (state, state.moved(local=step)))
    return by_constants, [np.concatenate(both, axis=2) for both in zip(by_before, by_after)]


class Equations:
    """Linear equations at a state, each divided by its noise; those of the chain are eliminated."""

    def __init__(self, problem, state, noise):
        self.problem, self.size = problem, 3 + state.vectors.shape[1]
        firsts = problem.place(state)
        residuals = problem.residuals(state, state)
        by_constants, by_states = derivatives(problem, state)
        self.rest = np.concatenate([values.ravel() / deviation
                                    for values, deviation in zip(residuals, noise)])
        self.common = np.concatenate([values.reshape(-1, values.shape[2]) / deviation
                                      for values, deviation in zip(by_constants, noise)])
        self.local = sparse.vstack([self.in_chain(first, values / deviation, len(state.vectors))
                                    for first, values, deviation in zip(firsts, by_states, noise)],
                                   'csr')
        self.group = np.repeat(np.arange(len(noise)), [values.size for values in residuals])
        times = np.concatenate([problem.times[first].repeat(values.shape[1])
                                for first, values in zip(firsts, residuals)])
        interval = np.unique(times // CORRELATED, return_inverse=True)[1]
        self.sums = sparse.csr_matrix((np.ones(len(interval)),
                                       (interval, np.arange(len(interval)))))
        self.solver = splu((self.local.T @ self.local).tocsc(), permc_spec='NATURAL',
                           diag_pivot_thresh=0.0, options={'SymmetricMode': True})
        self.left = self.without_chain(self.common)
        self.inverse = np.linalg.inv(self.left.T @ self.left)

    def in_chain(self, first, values, states):
        """Derivatives by all states of the chain, sparse. values: those of one group by the states
        `first` and the next."""
        rows, count, width = values.shape
        columns = (self.size * first[:, None] + np.arange(width)).repeat(count, axis=0)
        return sparse.csr_matrix(
            (values.ravel(), columns.ravel(), width * np.arange(rows * count + 1)),
            (rows * count, self.size * states))

    def by_chain(self, values):
        return self.solver.solve(self.local.T @ values)

    def without_chain(self, values):
        """What the states of the chain do not explain."""
        return values - self.local @ self.by_chain(values)

    def without_all(self, values):
        """What is left of n x m values after least squares."""
        left = self.without_chain(values)
        return left - self.left @ (self.inverse @ (self.left.T @ left))

    def step(self):
        """Changes of the constants and of the states of the chain."""
        common = -self.inverse @ (self.left.T @ self.rest)
        return common, -self.by_chain(self.rest + self.common @ common).reshape(-1, self.size)

    def covariance(self):
        """Of the constants. Noise that is correlated in time makes it greater, by how much more the
        sums of gradients over intervals vary than those of white noise."""
        white = np.random.default_rng(1).normal(size=(PROBES, len(self.rest)))
        expected = np.mean([self.variation(each) for each in white], axis=0)
        scale = np.sqrt(np.maximum(self.variation(self.rest) / expected, 1.0))
        return scale[:, None] * self.inverse * scale

    def lasting_covariance(self, noise):
        """Of the constants, from errors of the body's poses that are the same whenever it comes
        back, as those of the calibration: as large as the slow ones, linear in place and
        orientation."""
        body = self.problem.body
        features = np.hstack([body.positions, body.rotations.as_matrix().reshape(-1, 9)])
        features -= features.mean(axis=0)
        features /= np.sqrt((features ** 2).sum() / len(features))  # together 1 (RMS)
        changes = []
        for group, size in zip(BODY_GROUPS, noise[SLOW_GROUPS]):
            rows = np.flatnonzero(self.group == group).reshape(-1, 3)
            for axis in range(3):
                weights = self.left[rows[:, axis]].T @ features * (size / noise[group])
                changes.append(self.inverse @ weights)
        changes = np.hstack(changes)
        return changes @ changes.T

    def variation(self, values):
        """Sum of squares, over intervals, of what an interval changes each constant by."""
        changes = self.sums @ (self.left @ self.inverse * self.without_all(values[:, None]))
        return (changes ** 2).sum(axis=0)

    def noise_factors(self):
        """What to multiply the standard deviation of each group by."""
        rest = self.without_all(self.rest[:, None])[:, 0]
        factors = []
        random = np.random.default_rng(1)
        for number in range(self.group[-1] + 1):
            inside = self.group == number
            probes = inside[:, None] * random.choice([-1.0, 1.0], (len(rest), PROBES))
            redundancy = np.mean(np.sum(probes * self.without_all(probes), axis=0))
            factors.append(np.sqrt((rest[inside] ** 2).sum() / max(redundancy, 1.0)))
        # Where there are no slow errors, theirs would fall to zero slowly.
        factors = np.array(factors)
        slow = factors[SLOW_GROUPS]
        factors[SLOW_GROUPS] = np.where(slow < 1.0, slow ** 4, slow)
        return np.clip(factors, 0.2, 5.0)
