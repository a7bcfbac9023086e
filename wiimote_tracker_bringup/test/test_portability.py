"""Sources use only what ROS Noetic on Ubuntu 20.04 has, and packages declare their dependencies.

Stands in for a machine with GCC 9, Python 3.8, Eigen 3.3, OpenCV 4.2, Ceres 1.14, hidapi 0.9.
"""

import glob
import os
import re
import xml.etree.ElementTree as ElementTree

import pytest
import rospkg

HERE = os.path.dirname(os.path.realpath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
PACKAGES = sorted(os.path.dirname(p) for p in glob.glob(TOP + '/wiimote_tracker_*/package.xml'))

# Forbidden patterns, and why.
CPP = {
    r'\bhid_get_device_info\b': 'hidapi 0.13',
    r'\bhid_version\b|\bHID_API_VERSION\b': 'hidapi 0.10',
    r'\bbus_type\b': 'hidapi 0.13',
    r'\bSOLVEPNP_SQPNP\b': 'OpenCV 4.5',
    r'\bEigen::(seq|seqN|lastN|last|all|placeholders)\b|\.reshaped\(': 'Eigen 3.4',
    r'\bfor \([^;]*: .*\b(col|row)wise\(\)': 'Eigen 3.4',
    r'\bstd::(format|span|numbers|bit_cast|source_location|ranges)\b': 'C++20',
    r'^\s*(concept|co_await|co_yield|co_return)\b|\brequires\s*\(|\bconsteval\b': 'C++20',
    r'#include <(concepts|format|span|numbers|ranges|bit|coroutine|source_location)>': 'C++20',
    r'\{\s*\.\w+\s*=[^=]': 'C++20 (designated initialisers)',
    r'\.starts_with\(|\.ends_with\(|\.contains\(': 'C++20 or later',
    r'\bEigenQuaternionManifold\b|\bceres::Manifold\b|\bSetManifold\b': 'Ceres 2.1',
}
PYTHON = {
    r'^\s*match\s+[^=(\[]+:\s*$': 'Python 3.10',
    r'\.remove(prefix|suffix)\(': 'Python 3.9',
    r'(:|->)\s*(list|dict|tuple|set)\[': 'Python 3.9',
    r'->.*\w \| \w|^\s*def .*:\s*\w+ \| \w': 'Python 3.10',
    r'\byaml\.(unsafe_|full_)?load(_all)?\(|\bpickle\.': 'unsafe: a file must not become objects',
    r'\bgenfromtxt\(.*\bndmin\b': 'NumPy 1.23',
    r'\bmath\.lcm\b|\bzoneinfo\b|\btomllib\b': 'Python 3.9 or later',
}
# Floating point only: from_chars of integers exists.
FLOATING_FROM_CHARS = re.compile(r'from_chars\([^;]*chars_format')


def sources(*endings):
    for package in PACKAGES:
        for folder, subfolders, files in os.walk(package):
            subfolders[:] = [s for s in subfolders if not s.startswith('.')]
            for name in sorted(files):
                path = os.path.join(folder, name)
                if name.endswith(endings) and path != os.path.realpath(__file__):
                    yield path


def python_programs():
    yield from sources('.py')
    for package in PACKAGES:
        for folder, _, files in os.walk(package):
            for name in files:
                path = os.path.join(folder, name)
                if '.' not in name and os.access(path, os.X_OK):
                    with open(path, 'rb') as file:
                        if b'python' in file.readline():
                            yield path


def violations(paths, rules):
    for path in paths:
        with open(path, encoding='utf-8') as file:
            guarded = False  # between #if ..._VERSION... and its #else or #endif
            for number, line in enumerate(file, 1):
                if line.startswith('#'):
                    guarded = line.startswith('#if') and '_VERSION' in line
                if guarded:
                    continue
                code = line.split('//')[0] if path.endswith(('.h', '.cpp')) else line
                for rule, since in rules.items():
                    if re.search(rule, code):
                        yield f'{os.path.relpath(path, TOP)}:{number} needs {since}: {line.strip()}'


# At least one line for each rule.
CPP_EXAMPLES = (
    'auto i = hid_get_device_info(d);', 'hid_version();', 'if (info->bus_type == 1) {',
    'cv::SOLVEPNP_SQPNP;', 'x = m.reshaped();', 'Eigen::seq(0, 2);', 'for (auto c : m.colwise()) {',
    'auto s = std::format("{}", 1);', 'concept Sized = true;', 'void f() requires (true);',
    '#include <span>', 'Parameters p{.a = 1};', 'text.starts_with("a");',
    'problem.SetManifold(q, m);')
PYTHON_EXAMPLES = (
    'match value:', 's.removeprefix("a")', 'def f(a: list[int]):', 'def f() -> int | None:',
    'def f(a: int | None):', 'yaml.load(file)', 'yaml.full_load(file)', 'pickle.loads(text)',
    'np.genfromtxt(file, ndmin=2)', 'math.lcm(2, 3)')


@pytest.mark.parametrize('ending, examples, rules', [
    ('.cpp', CPP_EXAMPLES, CPP), ('.py', PYTHON_EXAMPLES, PYTHON)])
def test_the_rules_find_examples(tmp_path, ending, examples, rules):
    bad = tmp_path / ('bad' + ending)
    bad.write_text('\n'.join(examples))
    assert len({v.split(':')[1] for v in violations([str(bad)], rules)}) == len(examples)
    for rule, since in rules.items():
        assert list(violations([str(bad)], {rule: since})), rule


def test_what_is_no_violation_is_not_found(tmp_path):
    guard = tmp_path / 'guard.cpp'
    guard.write_text('#if CV_VERSION_MAJOR > 4\ncv::SOLVEPNP_SQPNP;\n#endif\ncv::SOLVEPNP_SQPNP;\n')
    assert [v.split(':')[1].split()[0] for v in violations([str(guard)], CPP)] == ['4']
    good = tmp_path / 'good.py'
    good.write_text('if re.match(a, b):\nfound = re.match(a)\nd: typing.List[int] = []\n')
    assert not list(violations([str(good)], PYTHON))
    assert FLOATING_FROM_CHARS.search('std::from_chars(\n  a, b, x, std::chars_format::general)')
    assert not FLOATING_FROM_CHARS.search('std::from_chars(a, b, i, 16);\nchars_format')


def test_the_sources_are_found():
    assert [os.path.basename(package) for package in PACKAGES] == [
        'wiimote_tracker_' + name for name in (
            'bringup', 'calibration', 'driver', 'msgs', 'triangulation')]
    endings = ('.h', '.cpp')
    for package in PACKAGES:
        assert any(path.startswith(package + os.sep) for path in sources(*endings)), package
    programs = {os.path.relpath(path, HERE) for path in python_programs()}
    assert {'conftest.py', '../launch/drivers', '../scripts/lint'} <= programs


def test_cpp_uses_nothing_that_noetic_lacks():
    assert not list(violations(sources('.h', '.cpp'), CPP))
    for path in sources('.h', '.cpp'):
        with open(path, encoding='utf-8') as file:
            assert not FLOATING_FROM_CHARS.search(file.read()), path


def test_python_uses_nothing_that_noetic_lacks():
    assert not list(violations(python_programs(), PYTHON))


# --- package.xml against CMakeLists.txt

# Arguments of find_package() and pkg_check_modules(), as rosdep keys.
ROSDEP_KEY = {'Eigen3': 'eigen', 'yaml-cpp': 'yaml-cpp', 'Ceres': 'libceres-dev',
              'OpenCV': 'libopencv-dev', 'hidapi-hidraw': 'libhidapi-dev', 'Boost': 'boost'}
# Parts of every toolchain.
NOT_PACKAGES = {'catkin', 'Threads', 'PkgConfig', 'GTest', 'PythonInterp'}


def declared(package):
    root = ElementTree.parse(os.path.join(package, 'package.xml')).getroot()
    return {element.text for element in root
            if element.tag.endswith('depend')} | {root.find('name').text}


def wanted(package):
    names = set()
    for path in glob.glob(package + '/**/CMakeLists.txt', recursive=True):
        with open(path) as file:
            text = re.sub(r'#.*', '', file.read())
        for arguments in re.findall(r'find_package\(([^)]*)\)', text):
            words = arguments.split()
            if 'QUIET' in words:  # optional
                continue
            if words[0] == 'catkin' and 'COMPONENTS' in words:
                names.update(words[words.index('COMPONENTS') + 1:])
            else:
                names.add(words[0])
        for arguments in re.findall(r'pkg_check_modules\(([^)]*)\)', text):
            words = arguments.split()
            if 'QUIET' in words:  # optional
                continue
            names.update(w for w in words[1:] if w not in ('REQUIRED', 'IMPORTED_TARGET'))
    return {ROSDEP_KEY.get(name, name) for name in names - NOT_PACKAGES}


@pytest.mark.parametrize('package', PACKAGES, ids=os.path.basename)
def test_every_dependency_is_declared(package):
    assert not wanted(package) - declared(package)


@pytest.mark.parametrize('package', PACKAGES, ids=os.path.basename)
def test_every_imported_package_is_declared(package):
    root = ElementTree.parse(os.path.join(package, 'package.xml')).getroot()
    running = {element.text for tag in ('depend', 'exec_depend') for element in root.findall(tag)}
    known = set(rospkg.RosPack().list()) - {root.find('name').text}
    for path in python_programs():
        if path.startswith(package + os.sep):
            with open(path, encoding='utf-8') as file:
                imported = known.intersection(
                    re.findall(r'^ *(?:from|import) (\w+)', file.read(), re.MULTILINE))
            is_test = path.startswith(os.path.join(package, 'test'))
            assert imported <= (declared(package) if is_test else running), path


@pytest.mark.parametrize('package', PACKAGES, ids=os.path.basename)
def test_every_package_has_readme_changelog_license_and_one_version(package):
    root = ElementTree.parse(os.path.join(package, 'package.xml')).getroot()
    assert root.get('format') == '3'
    assert root.find('license').text == 'BSD-3-Clause'
    assert root.find('version').text == '0.1.0'
    for name in ('README.md', 'CHANGELOG.rst'):
        assert os.path.exists(os.path.join(package, name)), name
