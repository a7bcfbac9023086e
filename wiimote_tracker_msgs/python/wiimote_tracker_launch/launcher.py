"""The roslaunch that started this node, and what it was given without effect."""

import difflib
import importlib
import os
import re
import xml.etree.ElementTree as ElementTree
from typing import Dict, Iterable, Iterator, List, Optional, Set

import rospkg
import yaml

# May have parameters in a file of parameters:=, too, but are not proposed.
OTHER_NODES = {'manager', 'simulated_hand', 'simulated_rig'}


def command_line() -> Optional[List[str]]:
    """Its words after `roslaunch`; None: another program started this node."""
    with open(f'/proc/{os.getppid()}/cmdline') as file:
        words = file.read().split('\0')[:-1]
    for number, word in enumerate(words[:2]):  # the interpreter and its script
        if os.path.basename(word) == 'roslaunch':
            return words[number + 1:]
    return None


def warnings(parameters: str = '', *nodes: str) -> Iterator[str]:
    """What has no effect, a sentence each: arguments of this node's roslaunch, and what in the file
    of parameters:= belongs to none of these nodes."""
    yield from without_effect(command_line() or [])
    if parameters:
        yield from unread(os.path.join(os.environ.get('PWD', '.'), parameters), nodes)


def unread(path: str, nodes: Iterable[str]) -> Iterator[str]:
    """Not an error: the parameters may be for other nodes."""
    importlib.import_module('rosparam')  # teaches yaml !degrees
    try:
        with open(path, encoding='utf-8') as file:
            content = dict(yaml.safe_load(file) or {})
    except (OSError, TypeError, ValueError, yaml.YAMLError):  # changed since roslaunch took it
        return
    if not content:
        yield f'{path} has no parameters: write them as "node: {{parameter: value}}"'
    names = sorted({str(key).split('/')[0] for key in content if not str(key).startswith('/')})
    unknown = [f'"{name}"' for name in names if name not in OTHER_NODES.union(nodes)]
    if unknown:
        more = f' and {len(unknown) - 3} more' if len(unknown) > 3 else ''
        yield (f'{path}: no node of this launch file is called {", ".join(unknown[:3])}{more}: '
               f'write parameters below one of {", ".join(sorted(nodes))}, unless a node of your '
               'own is called so')


def without_effect(words: List[str]) -> Iterator[str]:
    """A sentence for each argument that no launch file takes, for each empty one that has another
    default, and for each path that looks like a number, of which roslaunch says nothing."""
    paths = own_files(words)
    known: Dict[str, str] = {}
    files: Set[str] = set()
    for path in paths:
        known.update(arguments_of(path))
        files.update(paths_of(path))
    for word in words if paths else []:
        name, given, value = word.partition(':=')
        if not given or not re.fullmatch(r'[A-Za-z]\w*', name):
            continue
        if known.get(name) and not value:
            yield f'{name}:= has no effect, since roslaunch ignores an empty value: ' + (
                'set the parameter in a file, parameters:=FILE' if 'parameters' in known else
                'leave it out')
        elif name not in known:
            package, _, file = paths[0].split('/')[-3:]
            meant = difflib.get_close_matches(name, known, 1)
            yield f'{file} has no argument {name}, so {name}:= has no effect: ' + (
                f'write {meant[0]}:=' if meant else
                f'choose one of roslaunch --ros-args {package} {file}' if known else 'leave it out')
        elif name in files and evaluated(value) != value:
            yield f'roslaunch takes {word} for {evaluated(value)}: write {name}:=./{value}'


def own_files(words: List[str]) -> List[str]:
    """Paths of the launch files; none if one of them is of none of our packages."""
    packages = rospkg.RosPack()
    folders = {name: os.path.realpath(os.path.join(packages.get_path(name), 'launch'))
               for name in packages.list() if name.startswith('wiimote_tracker_')}
    user_folder = f'/proc/{os.getppid()}/cwd'
    paths = []
    for before, word in zip([''] + words, words):
        if word.endswith('.launch') and ':=' not in word:
            path = os.path.realpath(os.path.join(folders.get(before, user_folder), word))
            if not os.path.exists(path) or os.path.dirname(path) not in folders.values():
                return []
            paths.append(path)
    return paths


def arguments_of(path: str) -> Dict[str, str]:
    """Defaults of those of a launch file, and of files to which it passes all; empty: none."""
    defaults = {}
    for each in included(path):
        defaults.update(arguments_of(each))
    defaults.update((each.get('name'), each.get('default', ''))
                    for each in ElementTree.parse(path).getroot() if each.tag == 'arg')
    return defaults


def paths_of(path: str) -> Set[str]:
    """Arguments that are paths: those whose first sign $(eval) in these files looks at."""
    with open(path, encoding='utf-8') as file:
        found = set(re.findall(r"\bstr\((?:arg\(')?(\w+)(?:'\))?\)\[:1\]", file.read()))
    return found.union(*map(paths_of, included(path)))


def included(path: str) -> List[str]:
    """The files to which a launch file passes all of its arguments."""
    return [os.path.join(os.path.dirname(path), os.path.basename(include.get('file')))
            for include in ElementTree.parse(path).getroot().iter('include')
            if include.get('pass_all_args') == 'true']


def evaluated(value: str) -> str:
    """What $(eval) makes of a value, a number or truth value if it can be one, as a text."""
    for kind in (int, float):
        try:
            return str(kind(value))
        except ValueError:
            pass
    return value.capitalize() if value.lower() in ('true', 'false') else value
