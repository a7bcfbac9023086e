"""Results of checks: their lines, a file for the tests, and the exit status."""

import os
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from typing import List, Optional

PASSED, FAILED, SKIPPED = 'passed', 'failed', 'skipped'


@dataclass
class Case:
    """One check of a scenario or of a fuzz target."""

    subject: str
    name: str
    verdict: str
    seen: str

    def __str__(self) -> str:
        text = f'  {self.verdict}  {self.subject}: {self.name}'
        return f'{text} ({self.seen})' if self.seen else text


def conclude(program: str, cases: List[Case], junit_xml: Optional[str]) -> int:
    """Prints the last line, and writes the file if one is wanted. Returns the exit status."""
    totals = {verdict: sum(case.verdict == verdict for case in cases)
              for verdict in (PASSED, FAILED, SKIPPED)}
    if junit_xml:
        suite = ElementTree.Element('testsuite', name=program, tests=str(len(cases)), errors='0',
                                    failures=str(totals[FAILED]), skipped=str(totals[SKIPPED]))
        for case in cases:
            element = ElementTree.SubElement(suite, 'testcase', name=case.name,
                                             classname=f'{program}.{case.subject}')
            tag = {PASSED: 'system-out', FAILED: 'failure', SKIPPED: 'skipped'}[case.verdict]
            # XML does not allow all characters that a program can print.
            ElementTree.SubElement(element, tag).text = re.sub(r'[^\n\x20-\x7e]', '?', case.seen)
        os.makedirs(os.path.dirname(os.path.abspath(junit_xml)), exist_ok=True)
        ElementTree.ElementTree(suite).write(junit_xml, encoding='utf-8', xml_declaration=True)
    print(', '.join(f'{count} {verdict}' for verdict, count in totals.items()))
    return 1 if totals[FAILED] else 0
