#!/usr/bin/env python3
"""Prints how many compiler runs a target of a CMake build in makefiles takes.

    compiler_runs.py BUILD TARGET

Those whose object does not exist yet; of all that the target needs, if there is none such.
"""

import pathlib
import re
import sys


def needed(makefile, target):
    """The folders of the target and of all that it needs, as CMake's makefile names them."""
    needs = {}
    for folder, needed_folder in re.findall(r'^(\S+\.dir)/all: (\S+\.dir)/all$', makefile, re.M):
        needs.setdefault(folder, []).append(needed_folder)
    found = [folder for folder in re.findall(r'^(\S+\.dir)/all:', makefile, re.M)
             if pathlib.PurePath(folder).name == target + '.dir']
    for folder in found:  # grows meanwhile
        found += [other for other in needs.get(folder, []) if other not in found]
    return list(dict.fromkeys(found))


def compiler_runs(build, target):
    objects = set()
    for folder in needed((build / 'CMakeFiles/Makefile2').read_text(), target):
        rules = (build / folder / 'build.make').read_text()
        objects.update(re.findall(r'Building CXX object ([^\s"]+)', rules))
    return sum(not (build / name).exists() for name in objects) or len(objects)


if __name__ == '__main__':
    print(compiler_runs(pathlib.Path(sys.argv[1]), sys.argv[2]))
