"""Parts of the evaluation, without its sections: statistics compared with closed forms, the table
of results, rigs, programs and load."""

import io
import json
import os

import numpy as np
import pytest
import scipy.stats

from section_run import section_run
from wiimote_tracker_bringup import descriptions, files, programs, scene, statistics
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation import progress, results_table, sessions
from wiimote_tracker_evaluation.report import words
from wiimote_tracker_evaluation.sections.cost import load

HERE = os.path.dirname(os.path.realpath(__file__))
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


# --- Progress

class Clock:
    def __init__(self):
        self.time = 0.0

    def __call__(self):
        return self.time


def test_remaining_time_goes_from_expected_to_measured():
    clock = Clock()
    shown = progress.Progress([100, 50], io.StringIO(), clock)
    shown.begin('A')
    assert shown.remaining() == pytest.approx(150.0)
    clock.time = 30.0
    shown.within(9, 10)   # three times as fast as expected
    assert 50.0 < shown.remaining() < 65.0
    clock.time = 33.0
    shown.within(1, 1)
    assert shown.remaining() == pytest.approx(50.0)


def test_without_a_terminal_lines_are_few_and_plain():
    clock, output = Clock(), io.StringIO()
    shown = progress.Progress([100], output, clock)
    shown.begin('A')
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


def test_table_is_written_between_its_marks():
    content = content_of(9.1234, [8.0, 10.0])
    text = results_table.written(README, content)
    assert text.startswith('Before.\n') and text.endswith('\nAfter.\n') and 'old' not in text
    assert '|rms|9.12 mm|8 … 10|simulated, in process|' in text
    assert results_table.written(text, content) == text


@pytest.mark.parametrize('text', ['no marks', README + README, README.replace('begin', 'x')])
def test_table_needs_its_marks(text):
    with pytest.raises(Refusal, match='document'):
        results_table.written(text, content_of(1.0, None))


def test_a_document_without_marks_is_left_as_it_is(tmp_path):
    readme, figures_file = tmp_path / 'README.md', tmp_path / 'figures.json'
    readme.write_text('no marks', encoding='utf-8')
    figures_file.write_text(json.dumps(content_of(1.0, None)), encoding='utf-8')
    with pytest.raises(SystemExit, match='^results_table: .* once each'):
        results_table.main([str(figures_file), str(readme)])
    assert readme.read_text(encoding='utf-8') == 'no marks'


@pytest.mark.parametrize('figures, words', [
    (None, 'figures.json: No such file or directory; check its name'),
    ('no JSON', 'figures.json is no figures.json: name one that evaluate wrote'),
    ('{}', 'figures.json is no figures.json: name one that evaluate wrote')])
def test_a_table_needs_figures(figures, words, tmp_path):
    readme, figures_file = tmp_path / 'README.md', tmp_path / 'figures.json'
    readme.write_text(README, encoding='utf-8')
    if figures is not None:
        figures_file.write_text(figures, encoding='utf-8')
    with pytest.raises(SystemExit, match=words):
        results_table.main([str(figures_file), str(readme)])
    assert readme.read_text(encoding='utf-8') == README


# --- Rigs made from another one

def test_more_cameras_see_the_same_space(tmp_path):
    description = descriptions.with_cameras(files.read_yaml(PAPER_RIG), 8)
    path = str(tmp_path / 'rig.yaml')
    files.write_yaml(path, description)
    cameras = scene.read_scene(path).cameras
    assert len(cameras) == 8 and len({camera.name for camera in cameras}) == 8
    assert len(set(descriptions.identities(description).values())) == 8
    distance = [np.linalg.norm((camera.position - descriptions.MIDDLE)[:2]) for camera in cameras]
    assert np.allclose(distance, distance[0], rtol=1e-4)
    nearest = min(np.linalg.norm(a.position - b.position)
                  for i, a in enumerate(cameras) for b in cameras[:i])
    assert nearest > 0.7 * distance[0]  # 8 on a circle: 2 sin(22.5 deg) = 0.77
    assert not any(scene.read_scene(path).missed(np.array([[1.25, 1.25, 1.0]])))
    assert list(descriptions.with_cameras(description, 2)['cameras']) == [
        'wiimote_1', 'wiimote_2']


def test_the_scaled_rig_sees_its_space_about_the_origin(tmp_path):
    path = str(tmp_path / 'rig.yaml')
    files.write_yaml(path, descriptions.centred(files.read_yaml(PAPER_RIG), 0.4))
    corners = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 0.5)])
    assert not any(scene.read_scene(path).missed(corners))


@pytest.mark.parametrize('lens', [
    {'distortion': [0.1, 0.2, 0.0, 0.0, 0.0]},
    {'distortion_model': 'equidistant', 'distortion': [0.1, 0.0, 0.0, 0.0]}])
def test_the_scene_of_a_lens_with_more_than_k1_is_refused(tmp_path, lens):
    description = files.read_yaml(PAPER_RIG)
    description['cameras']['wiimote_2']['intrinsics'].update(lens)
    path = str(tmp_path / 'rig.yaml')
    files.write_yaml(path, description)
    with pytest.raises(Refusal, match='wiimote_2 has distortion other than k1 of plumb_bob'):
        scene.read_scene(path)


# --- Programs and load

def test_earlier_results_are_removed_but_not_what_they_link_to(tmp_path):
    kept, folder = tmp_path / 'elsewhere' / 'kept', tmp_path / 'results'
    kept.parent.mkdir()
    kept.touch()
    (folder / 'old').mkdir(parents=True)
    (folder / 'other').touch()
    (folder / 'linked').symlink_to(kept.parent)
    (folder / 'broken').symlink_to('nowhere')
    (folder / 'mark').touch()
    files.prepare(str(folder), ['old', 'linked', 'broken', 'absent'], 'mark')
    assert sorted(os.listdir(folder)) == ['mark', 'other'] and kept.exists()


def test_what_no_earlier_run_left_is_kept(tmp_path):
    (tmp_path / 'rig.yaml').touch()
    with pytest.raises(Refusal, match='rig.yaml may be yours, .* no mark of an earlier'):
        files.prepare(str(tmp_path), ['absent', 'rig.yaml'], 'mark')
    assert os.listdir(tmp_path) == ['rig.yaml']
    files.prepare(str(tmp_path), ['absent'], 'mark')


def test_failed_programs_are_reported_with_their_last_line(monkeypatch, tmp_path):
    monkeypatch.setattr(programs, 'find_program', lambda name: name)
    log, ended = str(tmp_path / 'log'), []
    programs.run_programs([['true'], ['true'], ['true']], log, lambda done, of: ended.append(
        (done, of)))
    assert ended[-1] == (3, 3)
    with pytest.raises(Refusal, match='no such luck'):
        programs.run_programs([['sh', '-c', 'echo no such luck; exit 3']], log)


def test_columns_of_numbers_are_read_as_numbers(tmp_path):
    path = tmp_path / 'a.csv'
    path.write_text('case,error\nC1,1.5\nC2,nan\n')
    columns = programs.read_csv(str(path))
    assert columns['case'].tolist() == ['C1', 'C2']
    assert columns['error'][0] == 1.5 and np.isnan(columns['error'][1])


def test_the_folder_of_results_may_have_any_name(tmp_path):
    run = section_run(tmp_path / 'run[1]')
    for part in (0, 30):
        with open(run.file(f'evaluate_a_{part}.csv'), 'w') as file:
            file.write(f'session\n{part}\n')
    assert sessions.read_shared(run, 'evaluate_a')['session'].tolist() == [0, 30]


@pytest.mark.parametrize('value, text', [
    (None, ''), (np.nan, '–'), (np.inf, 'inf'), (3.0, '3'), (1234.5, '1234')])
def test_numbers_for_readers(value, text):
    assert words.number(value) == text


def test_processor_time_is_that_of_the_process():
    begin = load.processor_time(os.getpid()), sum(os.times()[:2])
    while sum(os.times()[:2]) - begin[1] < 0.2:
        pass
    assert load.processor_time(os.getpid()) - begin[0] == pytest.approx(
        sum(os.times()[:2]) - begin[1], abs=2.5 * load.TICK)
