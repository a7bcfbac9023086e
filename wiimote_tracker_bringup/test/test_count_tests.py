"""The counter of tests, with hand-written result files."""

import os

import count_tests

GOOD = ('<testsuites><testsuite name="A"><testcase name="one" classname="A" status="run"/>'
        '<testcase name="two" classname="A" status="run"/></testsuite></testsuites>')
BAD = ('<testsuite><testcase name="one" classname="A"><failure message="1 is not 2"/></testcase>'
       '</testsuite>')


def write(build, name, text, package='pkg'):
    path = os.path.join(str(build), 'test_results', package, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, 'w') as file:
        file.write(text)


def expect(build, name, package='pkg'):
    folder = os.path.join(str(build), package, 'CMakeFiles', f'run_tests_x_{name}.dir')
    os.makedirs(folder)
    with open(os.path.join(folder, 'build.make'), 'w') as file:
        file.write('\tenv.sh /usr/bin/python3 /usr/share/catkin/cmake/test/run_tests.py '
                   f'{build}/test_results/{package}/{name} /usr/bin/something\n')


def run(capsys, *arguments):
    status = count_tests.main([str(a) for a in arguments])
    return status, capsys.readouterr().out.splitlines()


def test_counts_cases_not_files_and_succeeds_when_all_pass(tmp_path, capsys):
    build = tmp_path / 'build [1]'
    write(build, 'gtest-a.xml', GOOD)
    write(build, 'rosunit-b.xml', GOOD)
    status, lines = run(capsys, build)
    assert (status, lines[-1]) == (0, '4 passed, 0 failed, 0 skipped')


def test_a_failure_is_named_with_its_reason(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    write(tmp_path, 'pytest-b.xml', BAD)
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')
    assert any('pkg/pytest-b: A.one' in line for line in lines)
    assert any('1 is not 2' in line for line in lines)


def test_an_error_is_a_failure(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    write(tmp_path, 'rosunit-a.xml',
          '<testsuite><testcase name="x"><error>crashed</error></testcase></testsuite>')
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')
    assert any('crashed' in line for line in lines)


def test_only_at_a_release_its_own_tests_must_have_run(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    expect(tmp_path, 'release-b.xml')
    assert run(capsys, tmp_path)[0] == 0
    status, lines = run(capsys, tmp_path, '--release')
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')
    write(tmp_path, 'release-b.xml', GOOD)
    assert run(capsys, tmp_path, '--release')[1][-1] == '4 passed, 0 failed, 0 skipped'


def test_nothing_ran_is_a_failure(tmp_path, capsys):
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '0 passed, 0 failed, 0 skipped')


def test_only_skipped_is_a_failure_and_skips_are_counted(tmp_path, capsys):
    write(tmp_path, 'pytest-a.xml',
          '<testsuite><testcase name="x"><skipped/></testcase></testsuite>')
    write(tmp_path, 'gtest-b.xml',
          '<testsuite><testcase name="DISABLED_y" status="notrun"/></testsuite>')
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '0 passed, 0 failed, 2 skipped')


def test_a_rostest_wrapper_counts_only_when_it_failed(tmp_path, capsys):
    write(tmp_path, 'rosunit-a.xml', GOOD)
    write(tmp_path, 'rostest-a.xml', GOOD)
    assert run(capsys, tmp_path)[1][-1] == '2 passed, 0 failed, 0 skipped'
    write(tmp_path, 'rostest-c.xml', BAD)
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')


def test_a_test_without_result_is_a_failure(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    expect(tmp_path, 'gtest-a.xml')
    expect(tmp_path, 'gtest-crashed.xml')
    status, lines = run(capsys, tmp_path)
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')
    assert any('gtest-crashed.xml' in line for line in lines)


def test_a_result_that_catkin_found_missing_is_one_failure(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    write(tmp_path, 'MISSING-gtest-crashed.xml', BAD)
    expect(tmp_path, 'gtest-crashed.xml')
    assert run(capsys, tmp_path)[1][-1] == '2 passed, 1 failed, 0 skipped'


def test_a_damaged_or_empty_result_is_a_failure(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', '<testsuites><testsuite na')
    write(tmp_path, 'gtest-b.xml', '<testsuites/>')
    write(tmp_path, 'gtest-c.xml', GOOD)
    assert run(capsys, tmp_path)[1][-1] == '2 passed, 2 failed, 0 skipped'


def test_sanitized_tests_are_counted_apart_and_only_gtests_are_expected(tmp_path, capsys):
    plain, sanitized = tmp_path / 'plain', tmp_path / 'sanitized'
    write(plain, 'gtest-a.xml', GOOD)
    write(sanitized, 'gtest-a.xml', BAD)
    expect(sanitized, 'gtest-a.xml')
    expect(sanitized, 'rostest-b.xml')
    status, lines = run(capsys, plain, '--sanitized', sanitized)
    assert (status, lines[-1]) == (1, '2 passed, 1 failed, 0 skipped')
    assert any('with sanitizers: pkg/gtest-a: A.one' in line for line in lines)


def test_a_test_that_was_removed_is_not_expected(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    expect(tmp_path, 'gtest-a.xml')
    expect(tmp_path, 'gtest-removed.xml')
    (tmp_path / 'CMakeFiles').mkdir()
    (tmp_path / 'CMakeFiles' / 'TargetDirectories.txt').write_text(
        f'{tmp_path}/pkg/CMakeFiles/run_tests_x_gtest-a.xml.dir\n')
    status, lines = run(capsys, tmp_path)
    assert (status, lines) == (0, ['2 passed, 0 failed, 0 skipped'])


def test_a_test_in_a_subfolder_that_left_no_result_counts_as_failed(tmp_path, capsys):
    write(tmp_path, 'gtest-a.xml', GOOD)
    folder = tmp_path / 'pkg' / 'test' / 'CMakeFiles' / 'run_tests_pkg_gtest_b.dir'
    folder.mkdir(parents=True)
    (folder / 'build.make').write_text(
        '\tpython3 /usr/share/catkin/cmake/test/run_tests.py '
        f'{tmp_path}/test_results/pkg/gtest-b.xml x\n')
    status, lines = run(capsys, tmp_path)
    assert status == 1 and lines[-1] == '2 passed, 1 failed, 0 skipped'
