"""The evaluation's framework: statistics compared with closed forms, report and files of test
sections."""

import base64
import csv
import html.parser
import io
import json
import os
import re
import sys
import types

import numpy as np
import pytest
import scipy.io
import scipy.stats

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', 'evaluation'))

from wiimote_tracker_evaluation import (charts, evaluation, load, programs, progress,  # noqa: E402
                                        results_table, rigs, scene, section, sections, statistics)
from wiimote_tracker_evaluation.interruption import Interrupted  # noqa: E402

PAPER_RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')


# --- Statistics

@pytest.mark.parametrize('units', [8, 30])
def test_bootstrap_of_a_mean_has_its_nominal_coverage(units):
    random = np.random.RandomState(3)
    runs, covered = 120, 0
    for run in range(runs):
        # Values of one unit share an offset: drawing single values would cover far less.
        values = [2.0 + random.randn() + 0.1 * random.randn(5) for _ in range(units)]
        low, high = statistics.bootstrap(values, np.mean, seed=run, resamples=200)
        covered += low <= 2.0 <= high
    # Three standard deviations of that many runs. Plain percentiles cover 88 % with 8 units.
    assert abs(covered / runs - 0.95) < 3.0 * np.sqrt(0.95 * 0.05 / runs)


def test_bootstrap_of_few_units_is_as_wide_as_students_interval():
    values = np.random.RandomState(5).randn(12)
    low, high = statistics.bootstrap(values, seed=1, resamples=5000)
    student = scipy.stats.t.ppf(0.975, 11) * values.std(ddof=1) / np.sqrt(12.0)
    assert high - low == pytest.approx(2.0 * student, rel=0.05)


def test_bootstrap_is_repeatable_and_needs_two_units():
    units = np.random.RandomState(1).randn(20, 3)
    assert statistics.bootstrap(units, seed=1) == statistics.bootstrap(units, seed=1)
    assert statistics.bootstrap(units, seed=1) != statistics.bootstrap(units, seed=2)
    with pytest.raises(ValueError):
        statistics.bootstrap([[1.0, 2.0]])


@pytest.mark.parametrize('successes, trials', [(0, 10), (3, 10), (81, 263), (15, 148), (10, 10)])
def test_wilson_limits_solve_the_equation_they_are_defined_by(successes, trials):
    for limit in statistics.wilson(successes, trials):
        deviation = abs(successes / trials - limit)
        expected = statistics.NORMAL_QUANTILE * np.sqrt(limit * (1.0 - limit) / trials)
        assert deviation == pytest.approx(expected, abs=1e-7)


def test_wilson_refuses_invalid_counts():
    for successes, trials in ((0, 0), (3, 2), (-1, 2)):
        with pytest.raises(ValueError):
            statistics.wilson(successes, trials)


def test_blocks_keep_every_value_in_its_order():
    values = np.arange(23.0)
    pieces = statistics.blocks(values, 5)
    assert len(pieces) == 5 and np.array_equal(np.concatenate(pieces), values)
    assert len(statistics.blocks([1.0], 5)) == 1


# --- A report of test sections

def a_section(name, run):
    module = types.ModuleType(name)
    module.NAME, module.TITLE, module.run = name, 'About ' + name, run
    return module


def a_good_run(run):
    run.progress(1, 2, 'half')
    run.say('### Head\nSome *soft*, **loud** and `code` <text>.\n\n- one\n- two')
    figure, axes = charts.figure()
    axes.plot([0.0, 1.0], [0.0, 1.0], label='a curve')
    axes.set_xlabel('error [µm]')
    charts.key(axes)
    run.plot('line', figure, 'A line.')
    run.table('places', [('name', ''), ('error', 'mm'), ('share', '%')],
              [('P1', 1.25, 3), ('a, "b"', None, np.float64(50.0))], 'Two places.')
    run.table('many', [('n', '')], [[i] for i in range(100)])
    run.figure('rms', 1.25, 'mm', 7, (1.0, 1.5), 'RMS | error', end_to_end=True, headline=True)
    run.figure('count', 3, '', 1)
    run.summary('It can be **trusted**.')


def a_failing_run(run):
    run.say('Before the fall.')
    raise RuntimeError('the lamp <broke>; use another one')


def an_interrupted_run(run):
    run.say('As far as this.')
    raise Interrupted()


@pytest.fixture
def evaluate(monkeypatch, tmp_path):
    """evaluate(modules, arguments) -> exit status; the report is in tmp_path/out."""
    def carry_out(modules, *arguments):
        by_name = {module.NAME: module for module in modules}
        monkeypatch.setattr(sections, 'names', lambda: list(by_name))
        monkeypatch.setattr(sections, 'load', by_name.get)
        monkeypatch.setattr(sections, 'seconds', lambda name, quick: 10)
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
    assert tables[0] == (tmp_path / 'out/first/places.csv').read_bytes()
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


def test_the_same_figure_is_the_same_svg():
    def drawn():
        run = section.Run('a', 'A', PAPER_RIG, '/tmp')
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
    assert 'the lamp &lt;broke&gt;; use another one' in page and 'Before the fall.' in page
    assert 'the lamp <broke>' in (tmp_path / 'out/bad/failure.txt').read_text()
    assert 'Failed: bad' in capsys.readouterr().out


def test_results_before_an_interruption_are_kept(evaluate, tmp_path):
    modules = [a_section('good', a_good_run), a_section('cut', an_interrupted_run),
               a_section('never', a_failing_run)]
    assert evaluate(modules) == 130
    assert figures(tmp_path)['failed'] == ['cut']
    page = (tmp_path / 'out/report.html').read_text(encoding='utf-8')
    assert 'As far as this.' in page and 'It can be <b>trusted</b>.' in page
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
    (tmp_path / 'people' / 'anna').mkdir(parents=True)
    calibrated = tmp_path / 'rig.yaml'
    calibrated.write_text('format: 1\ncameras: {}\n')
    for wrong in (['--sections', 'nothing'], ['--rig', '/nowhere.yaml'], ['--seed', '-1'],
                  ['--gestures', '/nowhere'], ['--gestures', str(tmp_path / 'people')],
                  ['--rig', str(calibrated)]):
        with pytest.raises(SystemExit) as raised:
            evaluate(modules, *wrong)
        assert raised.value.code == 2
    said = capsys.readouterr().err
    assert 'there is no section' in said and 'describes no simulated rig' in said


def test_the_users_files_reach_the_sections(evaluate, tmp_path):
    for person in ('anna', 'ben'):
        (tmp_path / 'people' / person).mkdir(parents=True)
    led, people, seen = str(tmp_path / 'led.yaml'), str(tmp_path / 'people'), []
    (tmp_path / 'led.yaml').write_text('')
    assert evaluate([a_section('a', lambda run: seen.append((run.led, run.gestures)))],
                    '--led', led, '--gestures', people) == 0
    assert seen == [(led, people)]


def test_recordings_by_others_are_marked_as_measured(tmp_path):
    run = ['--rig', PAPER_RIG, '--output', str(tmp_path / 'out'), '--recordings']
    assert evaluation.parse(run + [HERE]).sections[-1] == 'recordings'
    assert 'recordings' not in evaluation.parse(run[:-1]).sections
    chosen = ['--sections', 'recordings']
    for wrong in (run[:-1] + chosen, run + ['/nowhere'] + chosen):
        with pytest.raises(SystemExit):
            evaluation.parse(wrong)
    real = os.path.join(HERE, 'data', 'flydra_excerpt')
    assert evaluation.evaluate(evaluation.parse(run + [real] + chosen)) == 0
    content = figures(tmp_path)
    assert not content['simulated'] and not any(each['simulated'] for each in content['figures'])
    page = (tmp_path / 'out/report.md').read_text(encoding='utf-8')
    assert 'Measured on recordings by others' in page and 'Simulated' not in page
    table = results_table.written(README, content)
    assert '|median error of predicted pixels, ' in table and '|measured|' in table
    assert 'evaluate --sections recordings' in table
    # A folder without recordings is a failure that says so.
    assert evaluation.evaluate(evaluation.parse(run + [str(tmp_path)] + chosen)) == 1
    assert 'has no recording' in (tmp_path / 'out/report.md').read_text(encoding='utf-8')


def test_the_fault_matrix_is_a_table_of_the_report(tmp_path):
    part = dict.fromkeys(('error_95', 'age', 'names', 'cameras'), None)
    results = [
        {'name': 'kill_driver', 'what': 'kill -9 of a driver', 'before': dict(part, rate=254.0, error=0.0012),
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
    run = section.Run('a', 'A', PAPER_RIG, str(tmp_path))
    with pytest.raises(ValueError, match='size'):
        run.figure('size', value, 'm', 1, interval)


def test_names_are_plain_and_used_once(tmp_path):
    run = section.Run('a', 'A', PAPER_RIG, str(tmp_path))
    run.figure('size', 1.0, 'm', 1)
    for name in ('size', '2nd', 'a b'):
        with pytest.raises(ValueError):
            run.figure(name, 1.0, 'm', 1)
    with pytest.raises(ValueError, match='2 cells'):
        run.table('t', [('a', ''), ('b', '')], [[1]])


# --- Progress

class Clock:
    def __init__(self):
        self.time = 0.0

    def __call__(self):
        return self.time


def test_remaining_time_goes_from_expected_to_measured():
    clock = Clock()
    shown = progress.Progress([('a', 100), ('b', 50)], io.StringIO(), clock)
    shown.begin('a', 'A')
    assert shown.remaining() == pytest.approx(150.0)
    clock.time = 30.0
    shown.within(9, 10)   # three times as fast as expected
    assert 50.0 < shown.remaining() < 65.0
    clock.time = 33.0
    shown.within(1, 1)
    assert shown.remaining() == pytest.approx(50.0)


def test_without_a_terminal_lines_are_few_and_plain():
    clock, output = Clock(), io.StringIO()
    shown = progress.Progress([('a', 100)], output, clock)
    shown.begin('a', 'A')
    for second in range(61):
        clock.time = second
        shown.within(second, 60, 'at it')
    shown.end('done')
    assert '\r' not in output.getvalue() and '\033' not in output.getvalue()
    assert len(output.getvalue().splitlines()) == 1 + 4 + 1


# --- The table of results

def content_of(value, interval, name='rms'):
    return {'quick': False, 'seed': 1, 'rig': 'paper_rig.yaml', 'figures': [
        {'name': name, 'section': 's', 'value': value, 'unit': 'mm', 'note': '', 'seed': 1,
         'samples': 9, 'interval': interval, 'simulated': True, 'end_to_end': False,
         'headline': True}]}


README = f'Before.\n{results_table.BEGIN}\nold\n{results_table.END}\nAfter.\n'


def test_table_is_written_between_its_marks_and_agrees_with_itself():
    content = content_of(9.1234, [8.0, 10.0])
    text = results_table.written(README, content)
    assert text.startswith('Before.\n') and text.endswith('\nAfter.\n') and 'old' not in text
    assert '|rms|9.12 mm|8 … 10|simulated, in process|' in text
    assert results_table.written(text, content) == text
    assert results_table.disagreements(text, content) == ([], [])


@pytest.mark.parametrize('fresh, agrees', [
    (content_of(10.1, [9.5, 10.6]), True), (content_of(12.0, [11.0, 13.0]), False),
    (content_of(10.5, [9.9, 11.0]), False),  # touching intervals differ: the probability is 1 in 90
    (content_of(9.12, None), True), (content_of(9.0, [8.0, 10.0], 'other'), False),
    # The interval of a short run is long towards the other value, or away from it.
    (content_of(12.0, [8.5, 12.1]), True), (content_of(12.0, [11.9, 15.5]), False)])
def test_table_disagrees_when_the_difference_exceeds_the_uncertainty(fresh, agrees):
    text = results_table.written(README, content_of(9.1234, [8.0, 10.0]))
    assert (results_table.disagreements(text, fresh) == ([], [])) == agrees


def test_numbers_that_depend_on_the_machine_are_not_checked(tmp_path, capsys):
    content, other = content_of(9.0, [8.0, 10.0]), content_of(20.0, [19.0, 21.0])
    for each in (content, other):
        each['figures'][0]['end_to_end'] = True
    readme, figures_file = tmp_path / 'README.md', tmp_path / 'figures.json'
    readme.write_text(results_table.written(README, content), encoding='utf-8')
    figures_file.write_text(json.dumps(other), encoding='utf-8')
    assert results_table.main([str(figures_file), str(readme), '--check']) == 0
    said = capsys.readouterr().out
    assert 'depends on the machine' in said and 'the table says 9 (8 … 10)' in said
    other['figures'][0]['end_to_end'] = False
    figures_file.write_text(json.dumps(other), encoding='utf-8')
    assert results_table.main([str(figures_file), str(readme), '--check']) == 1


def table_of(random, truths, spread):
    """A run whose figures scatter about the truth as their 95 % intervals state."""
    content = content_of(0.0, None)
    half = statistics.NORMAL_QUANTILE * spread
    content['figures'] = [dict(content['figures'][0], name=f'f{i}', value=value, interval=[
        value - half, value + half]) for i, value in enumerate(truths + spread * random.randn(
            len(truths)))]
    return content


def test_a_fresh_run_of_another_length_agrees_at_the_nominal_rate():
    random, truths, runs = np.random.RandomState(2), 10.0 + np.arange(20.0), 300
    agreed, found = 0, 0
    for _ in range(runs):
        text = results_table.written(README, table_of(random, truths, 0.1))
        agreed += results_table.disagreements(text, table_of(random, truths, 0.4))[0] == []
        moved = truths + 6.0 * np.hypot(0.1, 0.4) * (np.arange(20) == 7)
        found += results_table.disagreements(text, table_of(random, moved, 0.4))[0] != []
    # 95 % of agreeing runs must pass, and more because of rounding. One figure with an error of six
    # standard deviations hardly ever passes by chance.
    assert agreed / runs > 0.95 - 3.0 * np.sqrt(0.95 * 0.05 / runs)
    assert found / runs > 0.98


@pytest.mark.parametrize('text', ['no marks', README + README, README.replace('begin', 'x')])
def test_table_needs_its_marks(text):
    with pytest.raises(results_table.TableError, match='document'):
        results_table.written(text, content_of(1.0, None))


# --- Rigs made from another one

def test_more_cameras_see_the_same_space(tmp_path):
    description = rigs.with_cameras(rigs.read(PAPER_RIG), 8)
    path = str(tmp_path / 'rig.yaml')
    rigs.write(path, description)
    cameras = scene.read_scene(path).cameras
    assert len(cameras) == 8 and len({camera.name for camera in cameras}) == 8
    assert len(set(rigs.identities(description).values())) == 8
    distance = [np.linalg.norm((camera.position - rigs.MIDDLE)[:2]) for camera in cameras]
    assert np.allclose(distance, distance[0], rtol=1e-4)
    nearest = min(np.linalg.norm(a.position - b.position)
                  for i, a in enumerate(cameras) for b in cameras[:i])
    assert nearest > 0.7 * distance[0]  # 8 on a circle: 2 sin(22.5 deg) = 0.77
    assert not any(scene.read_scene(path).missed(np.array([[1.25, 1.25, 1.0]])))
    assert list(rigs.with_cameras(description, 2)['cameras']) == ['wiimote_1', 'wiimote_2']


def test_the_scaled_rig_sees_its_space_about_the_origin(tmp_path):
    path = str(tmp_path / 'rig.yaml')
    rigs.write(path, rigs.centred(rigs.read(PAPER_RIG), 0.4))
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 0.5)])
    assert not any(scene.read_scene(path).missed(corners))


# --- Programs and load

def test_failed_programs_are_reported_with_their_last_line(monkeypatch, tmp_path):
    monkeypatch.setattr(programs, 'find_program', lambda name: name)
    log, ended = str(tmp_path / 'log'), []
    programs.run_programs([['true'], ['true'], ['true']], log, lambda done, of: ended.append(
        (done, of)))
    assert ended[-1] == (3, 3)
    with pytest.raises(programs.ExperimentError, match='no such luck'):
        programs.run_programs([['sh', '-c', 'echo no such luck; exit 3']], log)


def test_columns_of_numbers_are_read_as_numbers(tmp_path):
    path = tmp_path / 'a.csv'
    path.write_text('case,error\nC1,1.5\nC2,nan\n')
    columns = programs.read_csv(str(path))
    assert columns['case'].tolist() == ['C1', 'C2']
    assert columns['error'][0] == 1.5 and np.isnan(columns['error'][1])


def test_processor_time_is_that_of_the_process():
    begin = load.processor_time(os.getpid()), sum(os.times()[:2])
    while sum(os.times()[:2]) - begin[1] < 0.2:
        pass
    assert load.processor_time(os.getpid()) - begin[0] == pytest.approx(
        sum(os.times()[:2]) - begin[1], abs=2.5 * load.TICK)
