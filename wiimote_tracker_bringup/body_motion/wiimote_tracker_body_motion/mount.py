"""Where the base of a robot sits on a tracked body: the file that body_to_base writes."""

import dataclasses

import numpy as np
import yaml
from scipy.spatial.transform import Rotation

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import keep_copy, read_yaml

FORMAT = 'wiimote_tracker_mount'


@dataclasses.dataclass
class Mount:
    """body_from_base: p_body = rotation p_base + translation [m]. offset: added to the stamps of
    the base's topic it gives the tracker's clock [s]. covariance: 7 x 7, of a small rotation about
    the body's axes [rad], translation and offset."""

    rotation: Rotation
    translation: np.ndarray
    offset: float
    covariance: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((7, 7)))
    body: str = 'body'
    base: str = 'base_link'

    def stddev(self):
        return np.sqrt(np.diag(self.covariance))

    def transform(self):
        """Arguments of static_transform_publisher."""
        numbers = [*self.translation, *self.rotation.as_quat()]
        return ' '.join([*(f'{number:.6f}' for number in numbers), self.body, self.base])


def write(mount, path):
    """A file that is there is kept as path + '.bak'."""
    node = ('<node pkg="tf2_ros" type="static_transform_publisher" name="body_to_base" '
            f'args="{mount.transform()}"/>')
    stddev = mount.stddev()
    content = {'format': FORMAT, 'version': 1, 'body': mount.body, 'base': mount.base,
               'translation': mount.translation.tolist(),
               'quaternion_xyzw': mount.rotation.as_quat().tolist(),
               'clock_offset': float(mount.offset),
               'stddev': {'rotation': stddev[:3].tolist(), 'translation': stddev[3:6].tolist(),
                          'clock_offset': float(stddev[6])},
               'covariance': mount.covariance.tolist(), 'launch': node}
    keep_copy(path)
    with open(path, 'w') as file:
        file.write('# body_from_base: p_body = R p_base + translation [m]. clock_offset [s],\n'
                   '# added to the stamps of the base, gives the clock of the tracker.\n'
                   '# Covariance: rotation about the axes of the body [rad], translation, clock\n'
                   '# offset.\n')
        yaml.safe_dump(content, file, sort_keys=False, default_flow_style=None, width=1000)


def read(path):
    """Throws Refusal if it is no such file."""
    content = read_yaml(path)
    try:
        if content['format'] != FORMAT or content['version'] != 1:
            raise ValueError(f'its format is not {FORMAT} 1')
        return Mount(Rotation.from_quat(content['quaternion_xyzw']),
                     np.array(content['translation'], dtype=float).reshape(3),
                     float(content['clock_offset']),
                     np.array(content['covariance'], dtype=float).reshape(7, 7),
                     content['body'], content['base'])
    except KeyError as error:
        raise Refusal(f'{path} is no result of body_to_base: {error} is missing') from error
    except (TypeError, ValueError) as error:
        raise Refusal(f'{path} is no result of body_to_base: {error}') from error
