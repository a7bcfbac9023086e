"""The lint, in a small tree for each test."""

import argparse
import subprocess

import program_module
import pytest

lint = program_module.load('scripts/lint')


@pytest.fixture(name='package')
def empty_package(tmp_path, monkeypatch):
    monkeypatch.setattr(lint, 'TOP', str(tmp_path))
    folder = tmp_path / 'wiimote_tracker_x'
    folder.mkdir()
    return folder


def test_finds_scripts_by_their_first_line_and_skips_hidden_folders(package):
    (package / 'program').write_text('#!/usr/bin/env python3\n')
    (package / 'module.py').write_text('')
    (package / 'data').write_text('python\n')
    (package / '.hidden').mkdir()
    (package / '.hidden' / 'other.py').write_text('')
    assert lint.scripts('python', '.py') == ['wiimote_tracker_x/module.py',
                                             'wiimote_tracker_x/program']


def test_finds_an_unused_import(package):
    (package / 'good.py').write_text('import os\nprint(os.name)\n')
    assert not lint.check_python()
    (package / 'bad.py').write_text('import os\n')
    assert 'imported but unused' in lint.check_python()


def test_finds_a_line_of_python_that_is_too_long(package):
    (package / 'good.py').write_text(100 * '#' + '\n')
    assert not lint.check_width()
    (package / 'bad.py').write_text('\n' + 101 * '#' + '\n')
    assert lint.check_width() == 'wiimote_tracker_x/bad.py:2: is longer than 100 characters'


def test_finds_a_shell_script_that_cannot_be_parsed(package):
    (package / 'good.sh').write_text('if true; then echo; fi\n')
    (package / 'bad.sh').write_text('if true; then\n')
    said = lint.check_shell()
    assert 'bad.sh' in said and 'good.sh' not in said


def test_skips_a_tool_that_is_not_installed():
    with pytest.raises(lint.Skip, match='no_such_tool is not installed'):
        lint.tool('no_such_tool')


def test_changed_files_are_those_since_the_branch_left_its_base_and_new_ones(package):
    def git(*arguments):
        subprocess.check_call(('git', '-C', lint.TOP, '-c', 'user.name=x', '-c', 'user.email=x@x')
                              + arguments, stdout=subprocess.DEVNULL)
    git('init', '-q', '-b', 'main')
    for name in ('old.cpp', 'changed.cpp', 'later.cpp'):
        (package / name).write_text('int a;\n')
    git('add', '.')
    git('commit', '-qm', 'first')
    git('branch', 'own')
    (package / 'later.cpp').write_text('int d;\n')  # after the branch left
    git('commit', '-qam', 'of the base')
    git('checkout', '-q', 'own')
    (package / 'committed.cpp').write_text('int e;\n')
    git('add', '.')
    git('commit', '-qm', 'of the branch')
    (package / 'changed.cpp').write_text('int b;\n')
    (package / 'new.cpp').write_text('int c;\n')
    assert lint.changed_since('main') == ['wiimote_tracker_x/changed.cpp',
                                          'wiimote_tracker_x/committed.cpp',
                                          'wiimote_tracker_x/new.cpp']
    with pytest.raises(lint.Skip, match='git does not know nowhere'):
        lint.changed_since('nowhere')


def test_tidy_names_a_changed_file_that_the_build_does_not_compile(package, monkeypatch, capsys):
    (package / 'compile_commands.json').write_text('[]')
    monkeypatch.setattr(lint, 'tool', lambda name: '/bin/true')
    monkeypatch.setattr(lint, 'changed_since', lambda base: ['x/new.cpp', 'x/new.h', 'README.md'])
    assert not lint.check_tidy(argparse.Namespace(build=str(package), all=False, base='main',
                                                  limit=None))
    said = capsys.readouterr().out
    assert 'does not compile it: x/new.cpp; build first' in said


def test_results_hold_passed_failed_and_skipped_checks(tmp_path):
    suite = lint.ElementTree.Element('testsuite')

    def skipping():
        raise lint.Skip('not today')
    assert lint.run_check('good', lambda: '', suite)
    assert not lint.run_check('bad', lambda: 'a problem', suite)
    assert lint.run_check('skipped', skipping, suite)
    assert [[child.tag for child in case] for case in suite] == [[], ['failure'], ['skipped']]
