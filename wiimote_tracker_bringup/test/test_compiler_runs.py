"""The number of compiler runs that a build takes, of a small project."""

import os
import subprocess
import sys

SCRIPT = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'scripts',
                      'compiler_runs.py')
PROJECT = """
cmake_minimum_required(VERSION 3.10)
project(small CXX)
add_library(base SHARED base.cpp more.cpp)
add_executable(wanted wanted.cpp)
target_link_libraries(wanted base)
add_executable(other other.cpp)
add_custom_target(all_wanted DEPENDS wanted)
"""


def runs(build, target):
    return int(subprocess.check_output([sys.executable, SCRIPT, build, target]))


def test_only_what_the_target_needs_and_lacks_is_counted(tmp_path):
    (tmp_path / 'CMakeLists.txt').write_text(PROJECT)
    for name in ('base', 'more'):
        (tmp_path / f'{name}.cpp').write_text(f'int {name}() {{ return 1; }}\n')
    for name in ('wanted', 'other'):
        (tmp_path / f'{name}.cpp').write_text('int main() {}\n')
    build = str(tmp_path / 'build')
    subprocess.check_call(['cmake', '-S', str(tmp_path), '-B', build, '-G', 'Unix Makefiles'])
    assert runs(build, 'all_wanted') == 3
    subprocess.check_call(['make', '-C', build, 'base'])
    assert runs(build, 'all_wanted') == 1
    subprocess.check_call(['make', '-C', build, 'all_wanted'])
    assert runs(build, 'all_wanted') == 3  # all may be out of date
