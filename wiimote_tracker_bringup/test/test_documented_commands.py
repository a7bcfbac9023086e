"""The commands in the documents exist: launch files with these arguments, programs with these
options."""

import pathlib
import re
import subprocess

import pytest
import roslaunch.arg_dump
import roslib.packages

TOP = pathlib.Path(__file__).resolve().parents[2]
# A line that ends in a backslash goes on.
TEXT = '\n'.join(path.read_text(encoding='utf-8').replace('\\\n', ' ')
                 for path in [*TOP.glob('*.md'), *TOP.glob('wiimote_tracker_*/**/*.md')])
REST = r'([^`|#\n]*)'  # Up to the end of the command.
LAUNCHES = re.findall(rf'(\w+\.launch)\b{REST}', TEXT)
RUNS = re.findall(rf'rosrun (wiimote_tracker_[a-z]+) (\w+){REST}', TEXT)
PROGRAMS = sorted({(program, package) for package, program, _ in RUNS})


def test_launch_files_have_these_arguments():
    arguments = {}
    for path in TOP.glob('wiimote_tracker_*/*/*.launch'):
        arguments.setdefault(path.name, set()).update(roslaunch.arg_dump.get_args([str(path)]))
    ours = [(name, rest) for name, rest in LAUNCHES if name not in ('apm.launch', 'px4.launch')]
    assert len(ours) > 50
    for name, rest in ours:
        assert set(re.findall(r'\b(\w+):=', rest)) <= arguments[name], (name, rest)


@pytest.mark.parametrize('program, package', PROGRAMS)
def test_a_program_has_these_options(program, package):
    paths = roslib.packages.find_node(package, program)
    assert paths
    options = set()
    for rest in re.findall(rf'(?:rosrun {package} |`){program}\b{REST}', TEXT):
        options.update(re.findall(r'(?<=[\s[])--[a-z][a-z-]*', rest))
    told = subprocess.run([paths[0], '--help'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=60, universal_newlines=True).stdout
    assert options <= set(re.findall(r'--[a-z][a-z-]*', told))


def test_the_documents_have_programs_with_options():
    assert len(PROGRAMS) > 20 and any('--' in rest for _, _, rest in RUNS)
