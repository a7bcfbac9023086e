"""track_bag follows bodies as the node does."""

import copy
import os
import sys

import numpy as np
import yaml

import recording
from program import arrays, entries_of, track, write

BODY = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'body')
sys.path.insert(0, BODY)
from inertial_rostest import BRIDGED, SILENT_AFTER, led, sample  # noqa: E402

AHEAD = 0.5  # samples are recorded before the images, so that none can be too late [s]


def test_two_bodies_with_one_imu_both_get_its_samples(tmp_path):
    """The one that is seen is followed by them while it is hidden, in either order."""
    with open(os.path.join(BODY, 'wand_with_imu.yaml')) as file:
        bodies = yaml.safe_load(file)
    other = copy.deepcopy(bodies['bodies'][0])
    other.update(name='other', leds=[[0.3, 0.0, 0.0], [-0.2, 0.3, 0.1], [0.0, -0.1, 0.2]])
    write(tmp_path / 'in.bag', [('/calibration/rig', recording.rig(), -0.6)] +
          [('/wand_imu', sample(t), t - AHEAD) for t in np.arange(0.0, BRIDGED[1], 0.01)] +
          entries_of(recording.images(BRIDGED[1], [led(i) for i in range(3)])))
    for pair in ([bodies['bodies'][0], other], [other, bodies['bodies'][0]]):
        (tmp_path / 'bodies.yaml').write_text(yaml.safe_dump(dict(bodies, bodies=pair)))
        track(tmp_path / 'in.bag', tmp_path / 'out.bag', '--bodies', tmp_path / 'bodies.yaml')
        hidden = [m for m in arrays(tmp_path / 'out.bag', '/wand/odometry') if
                  recording.seconds_of(m.header.stamp) >= BRIDGED[0] + SILENT_AFTER]
        assert len(hidden) > 100
