"""The lists of Debian packages: in order, and all of them in this release of Debian."""

import os
import shutil
import subprocess

import pytest

SCRIPTS = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'scripts')
LISTS = ['debian_packages.txt', 'debian_panel_packages.txt', 'debian_test_packages.txt',
         'debian_packaging_packages.txt']


def lines_of(name):
    with open(os.path.join(SCRIPTS, name)) as file:
        return [line.strip() for line in file if not line.startswith('#')]


def test_every_list_is_tested():
    names = [name for name in os.listdir(SCRIPTS) if name.endswith('packages.txt')]
    assert sorted(names) == sorted(LISTS)


@pytest.mark.parametrize('name', LISTS)
def test_a_list_is_sorted_and_names_each_package_once(name):
    assert lines_of(name) and lines_of(name) == sorted(set(lines_of(name)))


def test_no_package_is_in_two_lists():
    everything = [line for name in LISTS for line in lines_of(name)]
    assert len(everything) == len(set(everything))


@pytest.mark.skipif(not shutil.which('apt-cache'), reason='this computer has no apt-cache')
@pytest.mark.parametrize('name', LISTS)
def test_this_release_of_debian_has_every_package_that_is_not_optional(name):
    wanted = {line for line in lines_of(name) if not line.endswith('?')}
    known = subprocess.run(['apt-cache', 'pkgnames'], stdout=subprocess.PIPE, check=True,
                           text=True).stdout.split()
    assert wanted <= set(known)
