"""How points of a body move with its position, and with small rotations about the world's axes."""

import numpy as np


def by_pose(arms):
    """... x 3 x 6: derivatives of the points by the pose [1, m/rad]. arms: ... x 3, from the body's
    position to the points, along the world's axes [m]."""
    turned = np.zeros((*np.shape(arms), 3))
    turned[..., [1, 2, 0], [2, 0, 1]] = arms
    turned = turned - np.swapaxes(turned, -1, -2)
    return np.concatenate([np.broadcast_to(np.eye(3), turned.shape), turned], axis=-1)


def covariance_of_point(point, rotations, covariances):
    """Of the points R point + p, n x 3 x 3 [m^2]. covariances: of the poses, n x 6 x 6 [m, rad]."""
    jacobian = by_pose(rotations.apply(point))
    return jacobian @ covariances @ jacobian.transpose(0, 2, 1)
