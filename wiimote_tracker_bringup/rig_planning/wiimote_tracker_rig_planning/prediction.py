"""How well a rig sees points: which camera sees which, and how accurately they are known."""

import dataclasses

import numpy as np

from wiimote_tracker_bringup import bound, rigid_motion, scene
from wiimote_tracker_bringup.experiment import NOMINAL_LENS
from wiimote_tracker_rig_planning import body

SIZE = np.array([1024.0, 768.0])  # of the image [px]
IMAGES = 100  # averaged at each corner of the square

# Of one camera's parameters before the calibration: its pose could be any in a room.
PRIOR = np.diag([0.1] * 6 + [0.0] * 5)
PRIOR[6:, 6:] = bound.lens_prior(scene.Camera('', NOMINAL_LENS, None, np.zeros(3), SIZE),
                                 bound.Knowledge())[0]

# A place that no two cameras see is known this well, for comparisons [m]; an orientation [rad].
UNSEEN, UNTURNED = 0.5, 1.0


@dataclasses.dataclass(eq=False)
class Look:
    """N cameras at M points. sees: N x M. by_point: N x M x 2 x 3, derivatives of the pixels
    [px/m]. by_camera: N x M x 2 x 11, by turns about the world's axes, position, fx, fy, cx, cy,
    k1."""

    sees: np.ndarray
    by_point: np.ndarray
    by_camera: np.ndarray


def look(plan, positions, targets, points, directions=None) -> Look:
    """directions: M x 3, in which the LEDs shine; None: the plan's led_axis."""
    frames = np.swapaxes(scene.look_at(positions, targets), 1, 2)  # right, down, forward
    away = points[None] - positions[:, None]
    right, down, depth = np.moveaxis(np.einsum('nij,nmj->nmi', frames, away), -1, 0)
    ahead = depth > 0.1
    depth = np.where(ahead, depth, 1.0)
    slopes = np.stack([right / depth, down / depth], axis=-1)
    focal, center = NOMINAL_LENS[:2], NOMINAL_LENS[2:4]
    pixels = center + focal * slopes
    inside = ((pixels >= plan.margin) & (pixels <= SIZE - 1 - plan.margin)).all(axis=-1)
    distance = np.linalg.norm(away, axis=-1)
    sees = ahead & inside & (distance <= plan.farthest)
    if plan.beam < 360.0:
        shines = np.array(plan.led_axis) if directions is None else directions
        along = -(away * shines).sum(axis=-1) / np.maximum(distance, 1e-9)
        sees &= along >= np.cos(np.radians(plan.beam / 2.0)) - 1e-9
    for box in plan.obstacles:
        sees &= ~hidden(np.array(box), positions, away)
    by_point = (focal[:, None] / depth[..., None, None]) * (
        frames[:, None, :2] - slopes[..., None] * frames[:, None, 2:])
    by_lens = np.zeros(by_point.shape[:3] + (5,))
    by_lens[..., (0, 1), (0, 1)] = slopes
    by_lens[..., (0, 1), (2, 3)] = 1.0
    by_lens[..., 4] = focal * slopes * (slopes ** 2).sum(axis=-1, keepdims=True)
    by_turn = np.cross(by_point, away[..., None, :])
    return Look(sees, by_point, np.concatenate([by_turn, -by_point, by_lens], axis=-1))


def hidden(box, positions, away):
    """N x M, whether the way from a position to a point passes through the box."""
    steps = np.where(np.abs(away) < 1e-12, 1e-12, away)
    ends = (box.reshape(2, 1, 1, 3) - positions[:, None]) / steps
    enters, leaves = ends.min(axis=0).max(axis=-1), ends.max(axis=0).min(axis=-1)
    return (enters < leaves) & (leaves > 0.0) & (enters < 1.0)


def calibration(plan, corners: Look):
    """N x 11 x 11: covariance of each camera's parameters after a calibration by the square,
    without the errors of its corners, which are common to all cameras."""
    used = corners.by_camera * corners.sees[..., None, None]
    total = PRIOR + IMAGES / plan.pixel_stddev ** 2 * np.einsum('nmij,nmik->njk', used, used)
    # Scaled before inverting: pixels, radians and metres differ by many orders of magnitude.
    scale = 1.0 / np.sqrt(np.diagonal(total, axis1=1, axis2=2))
    scale = scale[:, :, None] * scale[:, None]
    return np.linalg.inv(total * scale) * scale


def information(plan, seen: Look, covariance):
    """N x M x 3 x 3: what each camera tells of each point [1/m^2]. covariance: of calibration();
    None: exactly known cameras."""
    own = plan.pixel_stddev ** 2 * np.eye(2)
    if covariance is not None:
        own = own + seen.by_camera @ covariance[:, None] @ np.swapaxes(seen.by_camera, -1, -2)
    weighted = np.linalg.inv(np.broadcast_to(own, seen.sees.shape + (2, 2))) @ seen.by_point
    return np.swapaxes(seen.by_point, -1, -2) @ weighted * seen.sees[..., None, None]


def look_at_square(plan, positions, targets) -> Look:
    """At the LED on its corners, which is none of the body's."""
    return look(dataclasses.replace(plan, beam=360.0) if plan.body else plan, positions, targets,
                plan.corners())


def target_information(plan, positions, targets, points, covariance):
    """What each camera tells of each target, N x B x K x K, and whether it can be located, B. K is
    3 for an LED at each of the points, seen by two cameras; 6 for a body's place and turn about the
    world's axes, at each point in each heading, with four sightings of three LEDs. What a
    calibration's errors do to LEDs that one camera sees is taken as independent."""
    if not plan.body:
        seen = look(plan, positions, targets, points)
        return information(plan, seen, covariance), seen.sees.sum(axis=0) >= 2
    places, directions, levers = body.lights(plan.body, points)
    seen = look(plan, positions, targets, places.reshape(-1, 3), directions.reshape(-1, 3))
    each = information(plan, seen, covariance).reshape((len(positions),) + places.shape + (3,))
    by_pose = rigid_motion.by_pose(levers)
    sightings = seen.sees.sum(axis=0).reshape(places.shape[:2])
    located = (sightings.sum(axis=1) >= 4) & ((sightings > 0).sum(axis=1) >= 3)
    return (np.swapaxes(by_pose, -1, -2) @ each @ by_pose).sum(axis=2), located


def prior_information(size):
    """Of a target that nobody sees, as information."""
    return np.diag(([UNSEEN ** -2] * 3 + [UNTURNED ** -2] * 3)[:size])


def position_variance(whole):
    """Trace of the covariance of the place alone [m^2], from the information on it, and on the
    turn."""
    return np.trace(np.linalg.inv(whole)[..., :3, :3], axis1=-2, axis2=-1)


def variances(each):
    """Of each place, with the information of all cameras: the covariance's trace [m^2]. About
    UNSEEN squared for what one camera or none sees."""
    return position_variance(each.sum(axis=0) + prior_information(each.shape[-1]))


def at_points(plan, positions, targets, points):
    """For each point the number of cameras that see a target there, and its standard deviation
    after a calibration by the square [m], NaN where it is not located. Of a body: in its worst
    heading."""
    covariance = calibration(plan, look_at_square(plan, positions, targets))
    each, located = target_information(plan, positions, targets, points, covariance)
    cameras = (np.trace(each, axis1=-2, axis2=-1) > 0.0).sum(axis=0)
    stddev = np.where(located, np.sqrt(variances(each)), np.nan)
    return (cameras.reshape(len(points), -1).min(axis=1),
            stddev.reshape(len(points), -1).max(axis=1))


def cost(plan, positions, targets, points):
    """RMS over the points of their expected standard deviation [m]. A corner of the square that a
    camera misses counts as a point that nobody sees."""
    corners = look_at_square(plan, positions, targets)
    each, _ = target_information(plan, positions, targets, points, calibration(plan, corners))
    whole = each.sum(axis=0) + prior_information(each.shape[-1])
    expected = ((1.0 - plan.hidden) * position_variance(whole).mean()
                + plan.hidden * position_variance(whole - each).mean())
    return float(np.sqrt(expected + (1.0 - corners.sees.mean()) * UNSEEN ** 2))


def widest_angles(sees, positions, points):
    """For each point the angle between two rays that is nearest to 90 degrees [degrees]; 0:
    none."""
    directions = points[None] - positions[:, None]
    directions = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    cosines = np.abs(np.einsum('nmi,kmi->nkm', directions, directions))
    pairs = sees[:, None] & sees[None] & ~np.eye(len(positions), dtype=bool)[..., None]
    return np.degrees(np.arccos(np.clip(np.where(pairs, cosines, 1.0).min(axis=(0, 1)), 0.0, 1.0)))
