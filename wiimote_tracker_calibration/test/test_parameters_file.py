"""config/calibration.yaml says what src/ros/parameters.cpp reads: every key, with its range.

That the values are the defaults is checked by parameters_test.
"""

import math
import os
import re

import yaml

PACKAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')
NUMBER = {'pi': math.pi, 'M_PI': math.pi, '__builtins__': {}}


def read(path):
    with open(os.path.join(PACKAGE, path), encoding='utf-8') as file:
        return file.read()


def value_of(text):
    return float(eval(text.replace(' pi', ' * pi'), NUMBER))


def parameters_of_the_code():
    """Key -> (kind, last arguments) of every parameter that the code reads."""
    code = read('src/ros/parameters.cpp')
    call = re.compile(r'reader(?:->|\.)(read|bounded|optional(?:<[^(]*>)?|choice)\(\s*'
                      r'(prefix \+ )?"(\w+)",(.*?)\);', re.DOTALL)
    return {('intrinsics/' if prefix else '') + key: (kind.split('<')[0], rest)
            for kind, prefix, key, rest in call.findall(code)}


def parameters_of_the_file():
    """Key -> the comment directly above it."""
    parameters, comment, group = {}, [], ''
    for line in read('config/calibration.yaml').splitlines():
        key = re.match(r'( *)(\w+):(.*)', line)
        if line.strip().startswith('#'):
            comment.append(line.strip('# '))
        elif key:
            if not key.group(3).strip():
                group = key.group(2) + '/'
            else:
                parameters[(group if key.group(1) else '') + key.group(2)] = ' '.join(comment)
            comment = []
        else:
            comment = []
    return parameters


def test_the_file_has_every_parameter_and_no_other():
    assert set(parameters_of_the_file()) == set(parameters_of_the_code())
    assert set(yaml.safe_load(read('config/calibration.yaml'))) == {
        key.split('/')[0] for key in parameters_of_the_file()}
    assert len(parameters_of_the_file()) > 60


def test_every_parameter_is_described():
    for key, comment in parameters_of_the_file().items():
        assert comment, key


def test_every_range_is_that_of_the_code():
    comments = parameters_of_the_file()
    for key, (kind, rest) in parameters_of_the_code().items():
        if kind == 'choice' and 'nameOf' not in rest:
            words = re.findall(r'"(\w+)"', rest[rest.index('{'):])
            assert f'[{", ".join(words)}]' in comments[key], key
        arguments = rest.split(',')
        if kind == 'bounded' or (kind == 'read' and len(arguments) == 3):
            lower, upper = [value_of(text) for text in arguments[-2:]]
        else:
            continue
        stated = re.search(r'\[(?:[^],]*, )?(\S[^],]*)\.\.([^],]+)\]', comments[key])
        assert stated, f'{key} has no range in: {comments[key]}'
        assert [value_of(text) for text in stated.groups()] == [lower, upper], key
