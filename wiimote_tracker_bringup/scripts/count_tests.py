#!/usr/bin/python3
"""Counts the tests of catkin build folders and lists failures.

    count_tests.py BUILD [--sanitized BUILD] [--release]

Reads the JUnit files in BUILD/test_results. A test of the build folder's makefiles without a result
counts as failed. The last line is "N passed, N failed, N skipped"; the exit status is 0 only if
something passed and nothing failed.
"""

import argparse
import dataclasses
import os
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import List, Optional, Set, Tuple

# A rostest also writes a "rosunit-" file for each of its test programs. Its own "rostest-" file
# repeats those as one case each, and matters only if the rostest itself failed.
LEAF_KINDS = ('gtest-', 'rosunit-', 'pytest-', 'roslaunch-')
RELEASE_KIND = 'release-'  # of tests that run at a release only
WRAPPER_KINDS = ('rostest-', 'MISSING-')

PASSED, FAILED, SKIPPED = 'passed', 'failed', 'skipped'


@dataclasses.dataclass
class Case:
    """One test case: its source and name, its verdict, the text of its failure."""

    name: str
    verdict: str
    text: str = ''


def verdict_of(testcase: ElementTree.Element) -> Tuple[str, str]:
    """Verdict and failure text of a <testcase> element."""
    for tag in ('failure', 'error'):
        problems = testcase.findall(tag)
        if problems:
            return FAILED, '\n'.join((p.text or p.get('message') or '').strip() for p in problems)
    if testcase.find('skipped') is not None or testcase.get('status') in ('notrun', 'skipped'):
        return SKIPPED, ''
    return PASSED, ''


def read_cases(path: Path, package: Path) -> List[Case]:
    """All cases of one result file. A damaged or empty file is a failed case."""
    source = f'{package}/{path.stem}'
    try:
        root = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, OSError) as error:
        return [Case(source, FAILED, f'unreadable result: {error}')]
    cases = []
    for testcase in root.iter('testcase'):
        verdict, text = verdict_of(testcase)
        name = '.'.join(part for part in (testcase.get('classname'), testcase.get('name')) if part)
        cases.append(Case(f'{source}: {name}', verdict, text))
    return cases or [Case(source, FAILED, 'no test ran')]


def expected_results(build: Path, kinds: Tuple[str, ...]) -> Set[str]:
    """Result files expected from the makefiles of a build folder, as "package/file.xml". Those of
    tests that were removed stay there: CMake lists which are its own."""
    expected = set()
    targets = build / 'CMakeFiles' / 'TargetDirectories.txt'
    current = None
    if targets.is_file():
        current = {os.path.realpath(line) for line in targets.read_text().splitlines()}
    for makefile in build.glob('**/CMakeFiles/run_tests_*.dir/build.make'):
        if current is not None and os.path.realpath(makefile.parent) not in current:
            continue
        found = re.findall(r'run_tests\.py"?\s+"?\S*?/test_results/([^/\s"]+/[^/\s"]+\.xml)',
                           makefile.read_text())
        expected.update(f for f in found if os.path.basename(f).startswith(kinds))
    return expected


def count(build: Path, expected: Tuple[str, ...]) -> List[Case]:
    """All cases of one build folder, including missing results of the expected kinds."""
    results = build / 'test_results'
    cases = []
    found = set()
    for path in sorted(results.rglob('*.xml')):
        package = path.parent.relative_to(results)
        found.add(f'{package}/{path.name}')
        if path.name.startswith(LEAF_KINDS + (RELEASE_KIND,)):
            cases += read_cases(path, package)
        elif path.name.startswith(WRAPPER_KINDS):
            cases += [case for case in read_cases(path, package) if case.verdict == FAILED]
    # A "MISSING-" file stands for the result of the same name and is reported above.
    found |= set(f.replace('/MISSING-', '/') for f in found)
    for missing in sorted(expected_results(build, expected) - found):
        cases.append(Case(missing, FAILED, 'left no result'))
    return cases


def main(arguments: Optional[List[str]] = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', type=Path, help='build folder whose tests all ran')
    parser.add_argument('--sanitized', metavar='BUILD', type=Path,
                        help='build folder whose gtests ran under sanitizers')
    parser.add_argument('--release', action='store_true',
                        help='the tests that run at a release only ran, too')
    options = parser.parse_args(arguments)

    cases = count(options.build, LEAF_KINDS + WRAPPER_KINDS
                  + ((RELEASE_KIND,) if options.release else ()))
    if options.sanitized:
        for case in count(options.sanitized, ('gtest-',)):
            cases.append(Case('with sanitizers: ' + case.name, case.verdict, case.text))

    totals = {verdict: 0 for verdict in (PASSED, FAILED, SKIPPED)}
    for case in cases:
        totals[case.verdict] += 1
        if case.verdict != PASSED:
            print(f'{case.verdict.upper()}  {case.name}')
            for line in case.text.splitlines()[:30]:
                print('    ' + line)
    print('{passed} passed, {failed} failed, {skipped} skipped'.format(**totals))
    return 0 if totals[PASSED] and not totals[FAILED] else 1


if __name__ == '__main__':
    sys.exit(main())
