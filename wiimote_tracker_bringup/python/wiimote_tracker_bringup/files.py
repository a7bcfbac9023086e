"""Files and folders that people name."""

import argparse
import json
import os
import shutil
import tempfile
from typing import Any, Iterable, Optional

import yaml

from wiimote_tracker_bringup.errors import Refusal


def existing_file(path: str) -> str:
    """A type for argparse."""
    if not os.path.isfile(path):
        raise argparse.ArgumentTypeError(f'there is no file {path}')
    return path


def existing_folder(path: str) -> str:
    """A type for argparse."""
    if not os.path.isdir(path):
        raise argparse.ArgumentTypeError(f'there is no folder {path}')
    return path


def read_yaml(path: str, loader=yaml.SafeLoader) -> Any:
    """Its content. Throws Refusal if it cannot be read, or is no YAML."""
    try:
        with open(path) as file:
            return loader(file).get_single_data()
    except OSError as error:
        raise Refusal(f'{path} cannot be read ({error.strerror}): correct its path or its '
                      'permissions') from error
    except UnicodeDecodeError as error:
        raise Refusal(f'{path} is no text ({error}): correct its path') from error
    except (yaml.YAMLError, ValueError) as error:  # ValueError: a date that is none
        raise Refusal('%s is not valid YAML (%s): correct it' % (
            path, str(error).replace('\n', ' '))) from error


def read_rig(path: str) -> Any:
    """The same of a rig's file, by libyaml: its covariance has thousands of numbers, for which the
    loader in Python takes seconds. (That one accepts more files, and says more of what is wrong.)
    """
    return read_yaml(path, yaml.CSafeLoader)


def write_yaml(path: str, content: Any) -> None:
    with open(path, 'w') as file:
        yaml.dump(content, file, yaml.CSafeDumper, sort_keys=False)


def read_json(path: str) -> Any:
    with open(path, encoding='utf-8') as file:
        return json.load(file)


def write_json(path: Optional[str], content: Any) -> None:
    """Without a path nothing is written."""
    if path:
        with open(path, 'w', encoding='utf-8') as file:
            json.dump(content, file, indent=1)


def check_distinct(to_write: Iterable[Optional[str]], to_read: Iterable[Optional[str]]) -> None:
    """Empty names are no files. Throws Refusal if a file to write is also to be read, or to
    be written as something else."""
    taken = {os.path.realpath(path) for path in to_read if path}
    for path in filter(None, to_write):
        if os.path.realpath(path) in taken:
            raise Refusal(f'two arguments are {path}: write to another file')
        taken.add(os.path.realpath(path))


def keep_copy(path: str) -> None:
    """Copies a file that is about to be replaced, if there is one, to path + '.bak'."""
    if os.path.isfile(path):
        shutil.copyfile(path, path + '.bak')


def prepare(folder: str, names: Iterable[str], mark: str) -> None:
    """Makes a folder for results; removes files and folders of an earlier run with these names.

    mark: a file that every run leaves, empty at first. Throws Refusal if it is missing
    beside others: a person may have put them there.
    """
    names = [name for name in (*names, mark) if os.path.lexists(os.path.join(folder, name))]
    if names and names[-1] != mark:
        raise Refusal(f'{os.path.join(folder, names[0])} may be yours, since there is no '
                      f'{mark} of an earlier run: choose another folder with --output')
    try:
        os.makedirs(folder, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
        for path in (os.path.join(folder, name) for name in names):
            if os.path.isdir(path) and not os.path.islink(path):
                shutil.rmtree(path)
            else:
                os.remove(path)
        open(os.path.join(folder, mark), 'w').close()
    except OSError as error:
        raise Refusal(f'cannot write to {folder}: {error.strerror}; choose another folder '
                      'with --output')
