"""The evaluation's framework: report and files of test sections."""

import base64
import csv
import dataclasses
import html.parser
import json
import os
import re
import types

import numpy as np
import pytest
import scipy.io

from section_run import section_run
from wiimote_tracker_bringup import charts
from wiimote_tracker_evaluation import evaluation, results_table, sections
from wiimote_tracker_evaluation.recordings import formats
from wiimote_tracker_evaluation.report import data
from wiimote_tracker_evaluation.section import Option
from wiimote_tracker_evaluation.sections import recordings

HERE = os.path.dirname(os.path.realpath(__file__))
PAPER_RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')


# --- A report of test sections

def a_section(name, run):
    module = types.ModuleType(name)
    module.TITLE, module.SECONDS, module.run = 'About ' + name, (10, 10), run
    return module


def a_good_run(run):
    run.progress(1, 2, 'half')
    run.say('### Head\nSome *soft*, **loud** and `code` <text>.\n\n- one\n- two')
    figure, axes = charts.figure()
    axes.plot([0.0, 1.0], [0.0, 1.0], label='a curve')
    axes.set_xlabel('error [µm]')
    charts.key(axes)
    run.plot('line', figure, 'A line.')
    run.table('line', [('x', '')], [[0], [1]], 'The same line.')
    run.table('places', [('name', ''), ('error', 'mm'), ('share', '%')],
              [('P1', 1.25, 3), ('a, "b"', None, np.float64(50.0))], 'Two places.')
    run.table('many', [('n', '')], [[i] for i in range(100)])
    run.figure('rms', 1.25, 'mm', 7, (1.0, 1.5), 'RMS | error', end_to_end=True, headline=True)
    run.figure('count', 3, '', 1)
    run.summary('It can be **trusted**.')


def a_failing_run(run):
    run.say('Before the fall.')
    raise RuntimeError('the lamp <broke>; use __another__ *one*')


def an_interrupted_run(run):
    run.say('As far as this.')
    raise KeyboardInterrupt


@pytest.fixture
def evaluate(monkeypatch, tmp_path):
    """evaluate(modules, arguments) -> exit status; the report is in tmp_path/out."""
    def carry_out(modules, *arguments):
        by_name = {module.__name__: module for module in modules}
        monkeypatch.setattr(sections, 'NAMES', list(by_name))
        monkeypatch.setattr(sections, 'load', by_name.get)
        return evaluation.evaluate(evaluation.parse(
            ['--rig', PAPER_RIG, '--output', str(tmp_path / 'out')] + list(arguments)))
    return carry_out


def figures(tmp_path):
    return json.loads((tmp_path / 'out' / 'figures.json').read_text(encoding='utf-8'))


def test_every_number_is_in_the_files(evaluate, tmp_path):
    assert evaluate([a_section('first', a_good_run)], '--quick', '--seed', '5') == 0
    content = figures(tmp_path)
    assert content['failed'] == [] and content['quick'] is True
    assert content['figures'][0] == {
        'name': 'rms', 'section': 'first', 'value': 1.25, 'unit': 'mm', 'note': 'RMS | error',
        'seed': 5, 'samples': 7, 'interval': [1.0, 1.5], 'simulated': True, 'end_to_end': True,
        'headline': True}
    assert content['figures'][1]['interval'] is None

    with open(str(tmp_path / 'out/first/places.csv'), newline='') as file:
        assert list(csv.reader(file)) == [['name', 'error_mm', 'share_percent'],
                                          ['P1', '1.25', '3'], ['a, "b"', '', '50.0']]
    matlab = scipy.io.loadmat(str(tmp_path / 'out/first/first.mat'), simplify_cells=True)['first']
    assert matlab['figures']['rms']['value'] == 1.25 and matlab['figures']['rms']['unit'] == 'mm'
    assert matlab['figures']['rms']['interval'].tolist() == [1.0, 1.5]
    assert matlab['table_places']['name'].tolist() == ['P1', 'a, "b"']
    assert np.array_equal(matlab['table_places']['error'], [1.25, np.nan], equal_nan=True)
    assert matlab['table_many']['n'].tolist() == list(range(100))


class Reader(html.parser.HTMLParser):
    """Checks that tags are closed in order; collects ids, references and text."""

    VOID = ('meta', 'br', 'hr', 'path', 'use', 'rect', 'stop')

    def __init__(self, page):
        super().__init__()
        self.open, self.ids, self.links, self.text = [], [], [], []
        self.feed(page)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.handle_startendtag(tag, attributes)
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        for name, value in attributes:
            if name == 'id':
                self.ids.append(value)
            if name in ('href', 'xlink:href', 'src'):
                self.links.append(value)

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def test_the_page_is_self_contained(evaluate, tmp_path):
    assert evaluate([a_section('first', a_good_run), a_section('second', a_good_run)]) == 0
    page = (tmp_path / 'out/report.html').read_text(encoding='utf-8')
    reader = Reader(page)
    assert len(set(reader.ids)) == len(reader.ids)
    assert {'first', 'second'} <= set(reader.ids)
    for link in reader.links:
        if link.startswith('#'):
            assert link[1:] in reader.ids
        else:  # the tables; nothing is loaded from elsewhere
            assert link.startswith('data:text/csv;base64,')
    tables = [base64.b64decode(link.split(',')[1]) for link in reader.links if ',' in link]
    assert tables[:2] == [(tmp_path / f'out/first/{name}.csv').read_bytes()
                          for name in ('line', 'places')]
    assert not re.search(r'url\((?!#)', page)
    text = ''.join(reader.text)
    for words in ('error [µm]', 'a curve', 'RMS | error', '<text>', 'It can be trusted.',
                  'simulated, full stack', 'simulated, in process', '1 … 1.5', 'with version 0.',
                  'Portable and Low-Cost 3D Tracking'):
        assert words in text
    plain = (tmp_path / 'out/report.md').read_text(encoding='utf-8')
    for words in ('It can be **trusted**.', '| P1 | 1.25 | 3 |', 'first/line.svg',
                  'RMS \\| error'):
        assert words in plain


NAMES = ['a | b', '<b>c</b>', '*d*', '_e_ f_g', '`h', '[i](http://j)', 'k \\| l', '&lt;',
         '<http://m>']


def test_names_are_no_markup(evaluate, tmp_path):
    def with_names(run):
        run.table('names', [('name', ''), ('other', '')], [[name, name] for name in NAMES])
        for number, name in enumerate(NAMES):
            run.figure(f'number_{number}', 1.0, '', 1, note=name)
            recordings.tell(run, name, formats.Outcome(
                'Measured', {}, [], {}, 'time [s]', np.arange(20.0), 'mm', np.ones(20)))
    assert evaluate([a_section('first', with_names)]) == 0
    page = (tmp_path / 'out/report.html').read_text(encoding='utf-8')
    Reader(page)
    rows = [[html.unescape(cell) for cell in re.findall('<td[^>]*>(.*?)</td>', row)]
            for row in re.findall('<tr>(.*?)</tr>', page, re.S)]
    for name in NAMES:
        assert [name, name] in rows
        assert [name, '1', '', '1', 'simulated, in process'] in rows
    heads = [html.unescape(head) for head in re.findall('<h3[^>]*>(.*?)</h3>', page)]
    assert [name for name in NAMES if name not in heads] == []


def test_the_same_figure_is_the_same_svg(tmp_path):
    def drawn():
        run = section_run(tmp_path)
        figure, axes = charts.figure()
        charts.cumulative(axes, [3.0, 1.0, 2.0], charts.BLUE)
        run.plot('line', figure, '')
        return run.contents[0].svg
    assert drawn() == drawn()


def test_a_failed_section_is_reported_and_the_others_run(evaluate, tmp_path, capsys):
    assert evaluate([a_section('bad', a_failing_run), a_section('good', a_good_run)]) == 1
    assert figures(tmp_path)['failed'] == ['bad']
    assert [each['section'] for each in figures(tmp_path)['figures']] == ['good', 'good']
    page = (tmp_path / 'out/report.html').read_text(encoding='utf-8')
    assert 'the lamp &lt;broke&gt;; use __another__ *one*' in page and 'Before the fall.' in page
    assert 'the lamp <broke>' in (tmp_path / 'out/bad/failure.txt').read_text()
    assert 'Failed: bad' in capsys.readouterr().out


def test_results_before_an_interruption_are_kept(evaluate, tmp_path):
    modules = [a_section('good', a_good_run), a_section('cut', an_interrupted_run),
               a_section('never', a_failing_run)]
    with pytest.raises(KeyboardInterrupt):
        evaluate(modules)
    assert figures(tmp_path)['failed'] == ['cut']
    page = (tmp_path / 'out/report.html').read_text(encoding='utf-8')
    assert 'As far as this.' in page and 'It can be <strong>trusted</strong>.' in page
    assert 'About never' not in page


def test_a_measured_figure_among_simulated_ones_is_marked(evaluate, tmp_path):
    def with_own(run):
        a_good_run(run)
        run.figure('own', 2.0, '', 3, simulated=False)
    assert evaluate([a_section('first', with_own)]) == 0
    assert [each['simulated'] for each in figures(tmp_path)['figures']] == [True, True, False]
    for name in ('report.md', 'report.html'):
        assert 'measured' in (tmp_path / 'out' / name).read_text(encoding='utf-8')
    matlab = scipy.io.loadmat(str(tmp_path / 'out/first/first.mat'), simplify_cells=True)['first']
    assert not matlab['figures']['own']['simulated'] and matlab['figures']['rms']['simulated']


def test_only_the_chosen_sections_run_and_others_are_refused(evaluate, tmp_path, capsys):
    modules = [a_section('bad', a_failing_run), a_section('good', a_good_run)]
    assert evaluate(modules, '--sections', 'good') == 0
    calibrated = tmp_path / 'rig.yaml'
    calibrated.write_text('format: 1\ncameras: {}\n')
    for option, value, words in (
            ('--sections', 'nothing', "there is no section 'nothing'; choose from bad, good"),
            ('--sections', '', "there is no section ''; choose from bad, good"),
            ('--rig', '/nowhere.yaml', 'argument --rig: there is no file /nowhere.yaml'),
            ('--rig', str(calibrated), 'describes no simulated rig'),
            ('--seed', '-1', 'argument --seed: -1 is not within 0 and 2147483647')):
        with pytest.raises(SystemExit) as raised:
            evaluate(modules, option, value)
        assert raised.value.code == 2
        assert words in capsys.readouterr().err


def test_files_that_a_section_cannot_use_are_refused(tmp_path, capsys):
    (tmp_path / 'people' / 'anna').mkdir(parents=True)
    for option, value, words in (
            ('--led', '/nowhere', 'argument --led: there is no file /nowhere'),
            ('--faults', '/nowhere', 'there is no file /nowhere'),
            ('--gestures', '/nowhere', '/nowhere needs folders of at least two people'),
            ('--gestures', str(tmp_path / 'people'), 'needs folders of at least two people'),
            ('--sections=cost', '--faults=' + PAPER_RIG,
             'is for the section faults, which is not')):
        with pytest.raises(SystemExit) as raised:
            evaluation.parse(['--rig', PAPER_RIG, option, value])
        assert raised.value.code == 2
        assert words in capsys.readouterr().err


def test_a_section_that_cannot_be_measured_live_is_refused(evaluate, tmp_path, capsys):
    live, simulated = a_section('live', a_good_run), a_section('simulated', a_good_run)
    live.live = a_good_run
    with pytest.raises(SystemExit):
        evaluate([live, simulated], '--live', '--sections', 'simulated')
    assert 'simulated cannot be measured live; choose from live' in capsys.readouterr().err
    assert evaluate([live, simulated], '--live') == 0
    assert {each['section'] for each in figures(tmp_path)['figures']} == {'live'}


def test_results_do_not_replace_what_the_user_gives(tmp_path, capsys):
    recording = tmp_path / 'out' / 'recordings' / 'flight' / 'bearings.csv.gz'
    recording.parent.mkdir(parents=True)
    recording.write_bytes(b'')
    for given in (tmp_path / 'out' / 'recordings', recording.parent):
        with pytest.raises(SystemExit):
            evaluation.parse(['--rig', PAPER_RIG, '--output', str(tmp_path / 'out'),
                              '--recordings', str(given)])
        assert 'choose another folder with --output' in capsys.readouterr().err
    assert recording.exists()


def test_a_section_may_have_options(evaluate):
    seen = []
    section = a_section('a', lambda run: seen.append(run.options.mine))
    section.OPTION = Option('mine', 'TEXT', str, 'of mine')
    assert evaluate([section], '--mine', 'right') == 0
    assert seen == ['right']
    section.OPTION = dataclasses.replace(section.OPTION, is_needed=True)
    assert evaluate([section, a_section('b', a_good_run)]) == 0
    assert seen == ['right']


def outcome(unit, result):
    pixels = dict.fromkeys(('median', 'mean', 'rms', 'p95', 'inliers', 'observations'), 1.0)
    return formats.Outcome('Measured', result, [], {'pixels': pixels}, 'time [s]',
                           np.arange(20.0), unit, np.ones(20))


def test_recordings_by_others_are_marked_as_measured(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(formats, 'measure', lambda name, path: outcome('px', {}))
    run = ['--rig', PAPER_RIG, '--output', str(tmp_path / 'out'), '--recordings']
    assert evaluation.parse(run + [HERE]).sections[-1] == 'recordings'
    assert 'recordings' not in evaluation.parse(run[:-1]).sections
    chosen = ['--sections', 'recordings']
    for wrong, words in ((run[:-1] + chosen, 'the section recordings needs --recordings'),
                         (run + ['/nowhere'] + chosen, 'there is no folder /nowhere')):
        with pytest.raises(SystemExit):
            evaluation.parse(wrong)
        assert words in capsys.readouterr().err
    real = os.path.join(HERE, 'data', 'flydra_excerpt')
    assert evaluation.evaluate(evaluation.parse(run + [real] + chosen)) == 0
    content = figures(tmp_path)
    assert not content['simulated'] and not any(each['simulated'] for each in content['figures'])
    page = (tmp_path / 'out/report.md').read_text(encoding='utf-8')
    assert 'Measured on recordings by others' in page and 'Simulated' not in page
    table = results_table.written(f'{results_table.BEGIN}\n{results_table.END}\n', content)
    assert '|median error of predicted pixels, ' in table and '|measured|' in table
    assert 'evaluate --sections recordings' in table
    # A folder without recordings is a failure that says so.
    assert evaluation.evaluate(evaluation.parse(run + [str(tmp_path)] + chosen)) == 1
    assert 'has no recording' in (tmp_path / 'out/report.md').read_text(encoding='utf-8')


@pytest.mark.parametrize('title', ['2021-05-01', 'Flüge/über dem Tisch', 20 * 'long'])
def test_a_recording_may_have_any_name(title, tmp_path):
    run = section_run(tmp_path)
    recordings.tell(run, title, outcome('mm', {'tracked': 0.9}))
    data.write_section(run)
    assert [figure.value for figure in run.figures] == [1.0, 90.0]


def test_the_fault_matrix_is_a_table_of_the_report(tmp_path, capsys):
    part = dict.fromkeys(('error_95', 'age', 'names', 'cameras'), None)
    results = [
        {'name': 'kill_driver', 'what': 'kill -9 of a driver',
         'before': dict(part, rate=254.0, error=0.0012),
         'during': dict(part, rate=0.0, error=None), 'after': dict(part, rate=235.0, error=0.0011),
         'recovery': 1.4, 'problems': []},
        {'name': 'lost', 'what': 'all lost', 'before': None, 'during': None, 'after': None,
         'recovery': None, 'problems': ['not normal again']}]
    path = tmp_path / 'faults.json'
    path.write_text(json.dumps(results))
    run = ['--rig', PAPER_RIG, '--output', str(tmp_path / 'out')]
    assert 'faults' not in evaluation.parse(run).sections
    run += ['--sections', 'faults']
    with pytest.raises(SystemExit):
        evaluation.parse(run)
    assert 'the section faults needs --faults' in capsys.readouterr().err
    run += ['--faults', str(path)]
    assert evaluation.evaluate(evaluation.parse(run)) == 0
    page = (tmp_path / 'out/report.md').read_text(encoding='utf-8')
    rows = [[cell.strip() for cell in line.strip('|').split('|')] for line in page.splitlines()
            if line.startswith('|')]
    assert ['kill -9 of a driver', '254', '1.2', '0', '', '235', '1.1', '1.4', 'none'] in rows
    assert ['all lost'] + 7 * [''] + ['not normal again'] in rows
    path.write_text('[{}]')
    assert evaluation.evaluate(evaluation.parse(run)) == 1
    assert 'is not what fault_matrix' in (tmp_path / 'out/report.md').read_text(encoding='utf-8')


def test_a_second_run_removes_the_results_of_the_first(evaluate, tmp_path):
    assert evaluate([a_section('first', a_good_run)]) == 0
    stale = tmp_path / 'out/first/stale.csv'
    stale.write_text('old')
    mine = tmp_path / 'out/notes.txt'
    mine.write_text('of a person')
    assert evaluate([a_section('first', a_good_run)]) == 0
    assert not stale.exists() and mine.exists()


@pytest.mark.parametrize('value, interval', [(float('nan'), None), (1.0, (0.0, float('inf')))])
def test_a_figure_is_a_finite_number(value, interval, tmp_path):
    run = section_run(tmp_path)
    with pytest.raises(ValueError, match='size'):
        run.figure('size', value, 'm', 1, interval)


def test_names_are_plain_and_used_once(tmp_path):
    run = section_run(tmp_path)
    run.figure('size', 1.0, 'm', 1)
    for name, reason in (('size', 'size is there twice'), ('2nd', "'2nd' must be letters"),
                         ('a b', "'a b' must be letters")):
        with pytest.raises(ValueError, match=reason):
            run.figure(name, 1.0, 'm', 1)
    with pytest.raises(ValueError, match='2 cells'):
        run.table('t', [('a', ''), ('b', '')], [[1]])
