"""Makes a document's results table from figures.json."""

import argparse
import types
from typing import Dict, List, Optional

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_json
from wiimote_tracker_bringup.interruption import answered
from wiimote_tracker_evaluation.report import words

BEGIN, END = '<!-- results: begin -->', '<!-- results: end -->'


def cells(entry: Dict) -> List[str]:
    description, value, interval, _, kind = words.cells(types.SimpleNamespace(**entry))
    return [description.replace('|', '/'), value, interval or '–', kind]


def headlines(content: Dict) -> List[Dict]:
    entries = [entry for entry in content['figures'] if entry['headline']]
    if not entries:
        raise Refusal('figures.json has no headline; run evaluate with all sections')
    return entries


def origin(content: Dict) -> str:
    if not any(entry['simulated'] for entry in headlines(content)):
        return ('By `rosrun wiimote_tracker_bringup evaluate --sections recordings --recordings '
                'DIR`.')
    return 'By `rosrun wiimote_tracker_bringup evaluate%s --seed %d`, rig `%s`.' % (
        ' --quick' if content['quick'] else '', content['seed'], content['rig']) + (
        ' *Full stack* runs in real time: these numbers depend on the machine and on what else it '
        'does, and their intervals are of that run alone.')


def lines(content: Dict) -> List[str]:
    return (['||value|95 % interval|how|', '|---|---|---|---|'] + [
        '|' + '|'.join(cells(entry)) + '|' for entry in headlines(content)] + [
        '', origin(content)])


def written(text: str, content: Dict) -> str:
    """The document's text with the table between its marks."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        raise Refusal(f'the document needs the lines "{BEGIN}" and "{END}", once each')
    return '\n'.join([text.partition(BEGIN)[0] + BEGIN, *lines(content),
                      END + text.partition(END)[2]])


def read(path: str) -> Dict:
    """What an evaluation wrote."""
    try:
        content = read_json(path)
    except ValueError:
        content = None
    if not isinstance(content, dict) or 'figures' not in content:
        raise Refusal(f'{path} is no figures.json: name one that evaluate wrote')
    return content


def main(arguments: Optional[List[str]] = None) -> None:
    parser = argparse.ArgumentParser(prog='results_table', description=__doc__)
    parser.add_argument('figures', help='figures.json of an evaluation')
    parser.add_argument('document', help='Markdown file with the two marks')
    options = parser.parse_args(arguments)
    with answered('results_table'):
        content = read(options.figures)
        try:
            with open(options.document, encoding='utf-8') as file:
                text = file.read()
        except UnicodeDecodeError as error:
            raise Refusal(f'{options.document} is no text ({error}): correct its path') from error
        text = written(text, content)  # before the document is emptied: it may refuse
        with open(options.document, 'w', encoding='utf-8') as file:
            file.write(text)
