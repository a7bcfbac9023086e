"""What scripts/test leaves out of the sanitized run: tests that exist."""

import fnmatch
import glob
import os
import re

HERE = os.path.dirname(os.path.realpath(__file__))
PACKAGES = os.path.join(HERE, '..', '..', 'wiimote_tracker_*')
TEST = re.compile(r'^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s*(\w+)\)', re.MULTILINE)


def gtests():
    """suite.test of every gtest of the packages."""
    for path in glob.glob(os.path.join(PACKAGES, 'test', '**', '*.cpp'), recursive=True):
        with open(path, encoding='utf-8') as file:
            yield from ('.'.join(found) for found in TEST.findall(file.read()))


def test_every_pattern_names_a_test():
    with open(os.path.join(HERE, '..', 'scripts', 'test'), encoding='utf-8') as file:
        parts = re.findall(r"GTEST_FILTER\+?='(.*)'", file.read())
    patterns = ''.join(parts).lstrip('-').split(':')
    assert len(patterns) > 5
    names = set(gtests())
    unknown = [pattern for pattern in patterns
               if not fnmatch.filter(names, pattern[2:] if pattern.startswith('*/') else pattern)]
    assert unknown == []
