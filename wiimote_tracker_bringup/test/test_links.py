"""Every link between the documents leads to a file, and to a heading if it names one; and what
CONTRIBUTING.md names is in the sources."""

import pathlib
import re

import pytest

TOP = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = sorted(TOP.glob('*.md')) + sorted(TOP.glob('wiimote_tracker_*/**/*.md'))
LINK = re.compile(r'\[([^]]*)\]\(([^)\s]*)\)')  # text, target


def anchors_of(document):
    """As GitHub makes them of the headings."""
    headings = re.findall(r'^#+ (.*)$', document.read_text(encoding='utf-8'), re.MULTILINE)
    return [re.sub(r'[^\w\- ]', '', LINK.sub(r'\1', heading)).lower().replace(' ', '-')
            for heading in headings]


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: str(path.relative_to(TOP)))
def test_links_lead_somewhere(document):
    links = [link for _, link in LINK.findall(document.read_text(encoding='utf-8'))
             if not link.startswith(('http:', 'https:', 'mailto:'))]
    for link in links:
        path, _, anchor = link.partition('#')
        target = (document.parent / path).resolve() if path else document
        assert target.exists(), link
        assert not anchor or anchor in anchors_of(target), link


def test_what_contributing_names_exists():
    """Each `name` or `path` is that of a file or folder, or a word of some source."""
    files = sorted(TOP.glob('wiimote_tracker_*/**/*'))
    paths = '\n'.join(str(path.relative_to(TOP)) for path in files)
    words = '\n'.join(path.read_text(encoding='utf-8') for path in files
                      if path.suffix in ('.cmake', '.cpp', '.h', '.msg', '.py', '.txt'))
    names = re.findall(r'`([\w./]+)`', (TOP / 'CONTRIBUTING.md').read_text(encoding='utf-8'))
    assert len(names) > 100
    lacking = [name for name in names if name not in words and name not in paths
               and f'wiimote_tracker_{name}' not in paths and not (TOP / name).exists()]
    assert lacking == []


def test_there_are_documents_with_links():
    assert len(DOCUMENTS) > 20
    assert LINK.findall((TOP / 'README.md').read_text(encoding='utf-8'))
