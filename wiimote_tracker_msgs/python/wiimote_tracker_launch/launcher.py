"""The roslaunch that started this node, and its arguments that have no effect."""

import difflib
import os
import re
import xml.etree.ElementTree as ElementTree
from typing import Iterator, List, Optional, Set

import rospkg


def command_line() -> Optional[List[str]]:
    """Its words after `roslaunch`; None: another program started this node."""
    with open(f'/proc/{os.getppid()}/cmdline') as file:
        words = file.read().split('\0')[:-1]
    for number, word in enumerate(words[:2]):  # the interpreter and its script
        if os.path.basename(word) == 'roslaunch':
            return words[number + 1:]
    return None


def without_effect(words: List[str]) -> Iterator[str]:
    """A sentence for each argument that no launch file takes, and for each empty one, of which
    roslaunch says nothing."""
    paths = own_files(words)
    known = set().union(*map(arguments_of, paths))
    for word in words if paths else []:
        name, given, value = word.partition(':=')
        if not given or not re.fullmatch(r'[A-Za-z]\w*', name):
            continue
        if name in known and not value:
            yield f'{name}:= has no effect, since roslaunch ignores an empty value: ' + (
                'set the parameter in a file, parameters:=FILE' if 'parameters' in known else
                'leave it out')
        elif name not in known:
            package, _, file = paths[0].split('/')[-3:]
            meant = difflib.get_close_matches(name, known, 1)
            yield f'{file} has no argument {name}, so {name}:= has no effect: ' + (
                f'write {meant[0]}:=' if meant else
                f'choose one of roslaunch --ros-args {package} {file}')


def own_files(words: List[str]) -> List[str]:
    """Paths of the launch files; none if one of them is of none of our packages."""
    packages = rospkg.RosPack()
    folders = {name: os.path.realpath(os.path.join(packages.get_path(name), 'launch'))
               for name in packages.list() if name.startswith('wiimote_tracker_')}
    paths = []
    for before, word in zip([''] + words, words):
        if word.endswith('.launch'):
            path = os.path.realpath(os.path.join(folders.get(before, ''), word))
            if not os.path.exists(path) or os.path.dirname(path) not in folders.values():
                return []
            paths.append(path)
    return paths


def arguments_of(path: str) -> Set[str]:
    """Those of a launch file, and of files to which it passes all."""
    root = ElementTree.parse(path).getroot()
    names = {each.get('name') for each in root if each.tag == 'arg'}
    for include in root.iter('include'):
        if include.get('pass_all_args') == 'true':
            names |= arguments_of(os.path.join(os.path.dirname(path),
                                               os.path.basename(include.get('file'))))
    return names
