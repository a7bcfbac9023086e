"""The numbers that blink_codes takes are those that a file of codes may hold."""

import os
import subprocess


def run(*arguments):
    """(exit status, standard output in one line)"""
    process = subprocess.run([os.environ['BLINK_CODES']] + list(arguments), stdout=subprocess.PIPE,
                             universal_newlines=True)
    return process.returncode, ' '.join(process.stdout.split())


def test_takes_every_tolerance_of_a_file():
    for chip, tolerance in (('0.01', '0'), ('0.5', '0.05')):
        status, text = run('choose', 'left', 'right', '--chip', chip, '--tolerance', tolerance)
        assert status == 0
        assert 'chip: %s #' % chip in text and 'tolerance: %s #' % tolerance in text


def test_refuses_numbers_beyond_those_of_a_file():
    for option in (('--chip', '0.0009'), ('--chip', '1.1'), ('--tolerance', '-0.01'),
                   ('--tolerance', '0.051')):
        assert run('choose', 'left', 'right', *option) == (2, '')


def test_refuses_options_of_other_commands():
    assert run('choose', 'left', 'right', '--period', '1') == (2, '')
    for command in ('check', 'table', 'sketch'):
        assert run(command, 'codes.yaml', '--chip', '0.02') == (2, '')
    assert run('check', 'codes.yaml', '--period', '1') == (2, '')


def test_help_says_the_ranges():
    _, text = run('--help')
    for words in ('(0.02 to 5)', '(0.001 to 1, default 0.023)', '(0 to 0.05, default 0.01)'):
        assert words in text
