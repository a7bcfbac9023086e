"""The list of cameras, cameras.yaml, which `drivers` explains; rig descriptions have one, too."""

import glob
import os
import re
import shlex

import yaml

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml

# The rules for a cameras.yaml are those of list_wiimotes; test_drivers.py compares them.
ADDRESS = '([0-9a-fA-F]{2}:){5}[0-9a-fA-F]{2}'
DEVICE = rf'{ADDRESS}|/dev/hidraw[0-9]+|(virtual|replay):.+'
FILE_KEYS = {'cameras', 'discover'}
CAMERA_KEYS = {'driver', 'identity'}
RIG_KEYS = {'extrinsics', 'position'}  # of a camera in a rig file or description
REMOTES_PER_ADAPTER = 7  # a Bluetooth piconet has no place for more


class UniqueKeys(yaml.SafeLoader):
    """Refuses a key that is there twice, of which YAML would silently take the last."""

    def compose_mapping_node(self, anchor):
        node = super().compose_mapping_node(anchor)
        seen = set()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and key.value in seen and key.value != '<<':
                raise yaml.MarkedYAMLError(problem=f'{key.value} is there twice',
                                           problem_mark=key.start_mark)
            seen.add(str(key.value))
        return node


def read_file(path):
    """The mapping in a cameras.yaml or a rig description; empty for anything else."""
    content = read_yaml(path, UniqueKeys)
    return content if isinstance(content, dict) else {}


def rig_example():
    """The documented rig file, of the version that is written."""
    import rospkg
    return read_file(os.path.join(
        rospkg.RosPack().get_path('wiimote_tracker_triangulation'), 'doc', 'rig.yaml'))


def is_of_rig(camera):
    """Whether it is a camera of a rig file or description, which have keys of their own."""
    return isinstance(camera, dict) and bool(RIG_KEYS & set(camera))


def read_list(path):
    """The mapping in a cameras.yaml or a rig description, with no key in a wrong place."""
    if not os.path.lexists(path):
        raise Refusal(f'there is no {path}: correct its path, or write it by: rosrun '
                      f'wiimote_tracker_driver list_wiimotes --write {shlex.quote(path)}')
    content = read_file(path)
    if not isinstance(content.get('discover', False), bool):
        raise Refusal(f'{path}: "discover" must be true or false')
    cameras = content.get('cameras')
    if 'cameras' not in content or isinstance(cameras, dict) and any(
            map(is_of_rig, cameras.values())):
        return content
    for key in content:
        if key not in FILE_KEYS:
            raise Refusal(f'{path} has the unknown key {key}: it may have "discover:" and '
                          '"cameras:", and the cameras below the latter')
    if list(content)[-1] == 'discover':
        raise Refusal(f'{path}: write "discover:" above "cameras:"')
    return content


def is_discovering(path):
    """Whether the file says that remotes that are not in it get a driver, too."""
    return read_list(path).get('discover', False)


def read_cameras(path):
    """The mapping "cameras:" of a cameras.yaml or a rig description, in its order."""
    content = read_list(path)
    cameras = content.get('cameras')
    if cameras is None and 'cameras' in content and content.get('discover'):
        return {}
    if not isinstance(cameras, dict) or not cameras:
        raise Refusal(f'{path} must have "cameras:" with one line "name: address" for '
                      'each camera')
    for name in cameras:
        if not isinstance(name, str) or not re.fullmatch(r'[A-Za-z]\w*', name, re.ASCII):
            raise Refusal(f'{path}: camera name {name!r} must be letters (a to z), digits '
                          'and _, a letter first')
    return cameras


def read_devices(path, socket_directory):
    """Ordered list of (camera name, device) from a cameras.yaml or a rig description."""
    devices = []
    for name, entry in read_cameras(path).items():
        device = entry.get('identity') if isinstance(entry, dict) else entry
        if socket_directory and not str(device).startswith('virtual:'):
            device = f'virtual:{socket_directory}/{name}.sock'
        if not isinstance(device, str) or not device:
            # YAML reads some addresses without quotes as numbers to the base of 60.
            raise Refusal(f'{path}: give the address of camera {name} as a text in quotes'
                          + (', after "identity:"' if isinstance(entry, dict) else ''))
        if not re.fullmatch(DEVICE, device, re.DOTALL):
            raise Refusal(f'{path}: camera {name} has the device {device}: give a '
                          'Bluetooth address such as "00:1f:32:12:34:56", or a path such '
                          'as /dev/hidraw0')
        devices.append((name, device))
    taken = [device.lower() for _, device in devices]
    for name, device in devices:
        if taken.count(device.lower()) > 1:
            raise Refusal(f'{path}: camera {name} has the device {device}, and so has '
                          'another one: remove one of them')
    return devices


def read_parameters(path):
    """For each camera the parameters that its driver alone gets."""
    parameters = {}
    for name, entry in read_cameras(path).items():
        entry = entry if isinstance(entry, dict) else {}
        unknown = sorted(set(map(str, entry)) - CAMERA_KEYS)
        if unknown and not is_of_rig(entry):
            raise Refusal(f'{path}: camera {name} has the unknown key {unknown[0]}: it '
                          'may have "identity:" and "driver:", and the parameters below '
                          'the latter')
        own = entry.get('driver')
        if not isinstance(own, (dict, type(None))):
            raise Refusal(f'{path}: "driver" of camera {name} must have lines "parameter: '
                          'value"')
        parameters[name] = own or {}
    return parameters


def is_address(device):
    """Whether it is a Bluetooth address."""
    return re.match(ADDRESS, device) is not None


def adapters():
    """How many Bluetooth adapters this computer has."""
    return len(glob.glob('/sys/class/bluetooth/hci*'))


def too_many(devices, adapters):
    """A sentence when there are more remotes than Bluetooth adapters can connect, else nothing."""
    remotes = [device for _, device in devices if is_address(device)]
    most = REMOTES_PER_ADAPTER * max(adapters, 1)
    if len(remotes) <= most:
        return None
    return ('%d remotes are listed, but at most %d connect to each Bluetooth adapter and this '
            'computer has %d: add an adapter, or list some of them at another computer '
            '(several_machines.launch)' % (len(remotes), REMOTES_PER_ADAPTER, adapters))
