"""Writes recordings in the layout of MultiCamSelfCal, which import/README.md describes."""

import os

import numpy as np


def write(folder, names, sizes, points, matrices, distortions, projections=None):
    """To a folder that exists. sizes: width, height of k cameras; points: k x n x 2, NaN where
    unseen [px]; matrices: k x 3 x 3; distortions: k x 5, k1, k2, p1, p2, k3; projections, if known:
    k x 3 x 4, world to undistorted pixels."""
    def save(name, rows):
        with open(os.path.join(folder, name), 'w') as file:
            for row in rows:
                words = (each if isinstance(each, str) else repr(float(each)) for each in row)
                file.write(' '.join(words) + '\n')

    save('camera_order.txt', [[name] for name in names])
    save('Res.dat', [[str(width), str(height)] for width, height in sizes])
    ones = np.where(np.isnan(points[..., :1]), np.nan, 1.0)
    save('points.dat', np.concatenate([points, ones], axis=2).transpose(0, 2, 1).reshape(
        -1, points.shape[1]))
    if projections is not None:
        save('Pmatrices.dat', np.concatenate(projections))
    for number, (matrix, distortion) in enumerate(zip(matrices, distortions), 1):
        values = [(f'K{row + 1}{column + 1}', value)
                  for (row, column), value in np.ndenumerate(matrix)]
        values += [(f'kc{k}', value) for k, value in enumerate(distortion, 1)]
        save(f'basename{number}.rad', [[key, '=', value] for key, value in values])
