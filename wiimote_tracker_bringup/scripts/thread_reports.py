#!/usr/bin/python3
"""Shows ThreadSanitizer's reports about code of the tracker.

    thread_reports.py FILE...

ROS is not built with the sanitizer, which therefore does not see all of its synchronisation and
reports its reference counts and connections. A report counts if one of its accesses or locks is in
our sources: if that is the innermost frame of a stack outside of the sanitizer and of templates of
the standard library. Frames of ROS are not in the stacks, but for the innermost one. References to
messages are counted by ROS, too, so their destruction does not count. The last line is "N reports,
N about the tracker"; the exit status is 0 if none counts.
"""

import re
import sys
from typing import List

BEGIN = 'WARNING: ThreadSanitizer:'
FRAME = re.compile(r'^    #\d+ (.*)$', re.MULTILINE)
OURS = re.compile(r'/wiimote_tracker_\w+/')
# Frames between an access or a lock and the code that wanted it.
BETWEEN = re.compile(r'/libsanitizer/|/include/c\+\+/|/include/boost/|/libstdc\+\+|^std::')
REFERENCES = re.compile(r'boost::detail::(sp_counted|atomic_)')
# Stacks that only say where something comes from.
ORIGIN = re.compile(r'^  (Thread|Mutex \w+ \(\w+\) created|Location|As if synchronized)')


def stacks(report: str) -> List[str]:
    """The stacks of a report's accesses or locks, each with its title."""
    parts = re.split(r'\n\n', report)
    return [part for part in parts if FRAME.search(part)
            and not any(ORIGIN.match(line) for line in part.splitlines()[:1])]


def concerns_us(report: str) -> bool:
    of_report = stacks(report)
    return any(map(is_ours, of_report)) and not any(map(REFERENCES.search, of_report))


def is_ours(stack: str) -> bool:
    for frame in FRAME.findall(stack):
        if not BETWEEN.search(frame):
            return bool(OURS.search(frame))
    return False


def reports(path: str) -> List[str]:
    with open(path, encoding='utf-8', errors='replace') as file:
        return [part for part in re.split(r'^={10,}\n', file.read(), flags=re.MULTILINE)
                if part.startswith(BEGIN)]


def main(paths: List[str]) -> int:
    found = [report for path in paths for report in reports(path)]
    ours = [report for report in found if concerns_us(report)]
    for report in ours:
        print(report)
    print(f'{len(found)} reports, {len(ours)} about the tracker')
    return 1 if ours else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
