"""The program calibrate without a node and a terminal: what a person sees and may ask for."""

import io
import os
import queue
import sys
import time

import pytest
from geometry_msgs.msg import Point
from std_msgs.msg import String
from wiimote_tracker_msgs import srv
from wiimote_tracker_msgs.msg import (BoardStatus, CalibrationCameraStatus, CalibrationStatus,
                                      CalibrationVerdict, CameraVerdict, CaptureCornerGoal,
                                      PrincipalPointTrace)

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), '../scripts'))

from guide import board_screen, commands, layout, screen  # noqa: E402
from guide.dialogue import Dialogue  # noqa: E402
from guide.guide import Guide  # noqa: E402
from guide.plain import Plain  # noqa: E402

NAN = float('nan')


def camera(name='wiimote_1', **fields):
    values = dict(connected=True, rate=99.6, blobs=1, sees_led=True, x=10.0, y=20.0,
                  image_coverage=NAN, speed=NAN, wave_seconds=NAN)
    values.update(fields)
    return CalibrationCameraStatus(name=name, **values)


def status(step, request='', label='', **fields):
    values = dict(corners_needed=4, cameras=[camera()], next_sentence='Do this.',
                  next_request=request, next_label=label, next_corner=-1)
    values.update(fields)
    return CalibrationStatus(step=step, **values)


def guide_at(*statuses, **options):
    guide = Guide(0.0, **options)
    guide.image_sizes = {each.name: (1024, 768) for message in statuses for each in message.cameras}
    for number, each in enumerate(statuses):
        guide.on_status(each, float(number))
    return guide


# --- The screen

def test_a_square_in_progress_looks_like_this():
    seen = dict(corner_x=[100.0, 900.0], corner_y=[700.0, 650.0])
    cameras = [camera('wiimote_1', samples=[52, 52], spread=[0.31, 0.31], x=900.0, y=650.0, **seen),
               camera('wiimote_2', samples=[0, 0], spread=[NAN, NAN], connected=False,
                      sees_led=False, problem='sends no images: look at its driver',
                      corner_x=[NAN, NAN], corner_y=[NAN, NAN]),
               camera('wiimote_3', samples=[1052, 1052], spread=[1.25, 1.25], blobs=3,
                      sees_led=False, masks=2, x=NAN, y=NAN)]
    guide = guide_at(
        status(CalibrationStatus.READY),
        status(CalibrationStatus.READY),
        status(CalibrationStatus.READY, 'capture_corner', 'capture corner 3', corners_captured=2,
               next_sentence='Put the LED on corner 3 (counter-clockwise seen from above puts z up).',
               progress=0.5, rig_id='0123456789', message='corner 2 captured by 2 cameras',
               cameras=cameras))
    assert screen.render(guide, 4.0) == [
        'CALIBRATION  corners        [########--------]  corners 2/4   rig 01234567  0:04',
        'Put the LED on corner 3 (counter-clockwise seen from above puts z up). SPACE:',
        'capture corner 3.',
        'wiimote_1           wiimote_2           wiimote_3',
        '+----------------+  +----------------+  +----------------+',
        '|                |  |                |  |                |',
        '|                |  |                |  |                |',
        '|                |  |                |  |                |',
        '|                |  |                |  |                |',
        '|                |  |                |  |                |',
        '| 1            O |  |                |  |                |',
        '+----------------+  +----------------+  +----------------+',
        '100 Hz  1 spot      no images           100 Hz  3+2 masked',
        'samples 52 52       samples - -         samples 1052 1052',
        'spread .3 .3        spread - -          spread 1.2 1.2',
        '',
        '- wiimote_2: sends no images: look at its driver',
        '', '', '', '',
        'corner 2 captured by 2 cameras',
        'SPACE next  m masks  k connection  n new  t take corner  u undo  h hands-free',
        'w wave  s solve  v save  c check  i verdict  TAB cameras  ? all keys  q quit']


def test_a_wave_fills_cells_and_says_what_is_missing():
    cells = [row == 2 and column in (0, 7) for row in range(6) for column in range(8)]
    guide = guide_at(status(
        CalibrationStatus.WAVING, corners_captured=4, progress=0.25, message='recording',
        missing=['wave 9 s more', 'wiimote_1 has seen nothing at the top: hold the LED higher'],
        cameras=[camera(x=512.0, y=400.0, image_cells=cells, image_coverage=0.042, speed=234.4)]))
    lines = screen.render(guide, 1.0)
    assert lines[3:15] == [
        'wiimote_1', '+----------------+',
        '|................|', '|................|', '|##............##|',
        '|........O.......|', '|................|', '|................|',
        '+----------------+', '100 Hz  1 spot', '', 'wave 4 %  234 px/s']
    assert lines[1] == 'Do this.'
    assert lines[16:18] == ['- wave 9 s more',
                            '- wiimote_1 has seen nothing at the top: hold the LED higher']
    assert lines[21] == 'recording'


def test_the_picture_is_as_large_as_the_images_are():
    guide = guide_at(status(CalibrationStatus.READY, cameras=[camera(x=639.0, y=479.0)]))
    guide.image_sizes = {'wiimote_1': (640, 480)}
    assert screen.render(guide, 1.0)[10] == '|               O|'
    guide.image_sizes = {}  # no image has come yet
    assert not any('O' in line for line in screen.render(guide, 1.0)[5:11])


def test_the_answer_is_shown_beside_the_verdict_and_the_trace():
    guide = guide_at(status(CalibrationStatus.SAVED, message='saved to rig.yaml'))
    for view in ('verdict', 'trace'):
        assert screen.render(guide, 1.0, view)[21] == 'saved to rig.yaml'


def test_a_verdict_is_a_table():
    guide = guide_at(status(CalibrationStatus.SOLVED, rig_id='0123456789'))
    guide.verdict = CalibrationVerdict(
        rig_id='0123456789', grade=CalibrationVerdict.USABLE, text='Usable: corner 3 is 8 mm off.',
        redo_corner=-1, predicted_at=[Point(0, 2.5, 0), Point(0, 2.5, 2.5)],
        predicted_stddev=[0.0031, NAN],
        cameras=[CameraVerdict('wiimote_1', 0.31, 0.0012, 0.994, 0.0003, 0.002, 1.2, 2.1, NAN,
                               0.0001)])
    assert [line for line in screen.render(guide, 1.0, 'verdict')[3:] if line][:7] == [
        'USABLE   (rig 01234567)',
        'Usable: corner 3 is 8 mm off.',
        '                 residual   fits   known to within (standard deviation)',
        'camera            px    mm     %      mm    deg   f px   c px     k1     ms',
        'wiimote_1       0.31   1.2    99     2.0  0.017    1.2    2.1      -   0.10',
        'A point will be right to within (standard deviation), at x, y, z in metres:',
        '(0.00, 2.50, 0.00) 3.1 mm (0.00, 2.50, 2.50) - mm']
    guide.verdict.text = 'Usable. ' * 30
    guide.verdict.cameras *= 4
    guide.verdict.predicted_at = [Point(0, 0, z) for z in range(9)]
    guide.verdict.predicted_stddev = [0.01] * 9
    text = '\n'.join(screen.render(guide, 1.0, 'verdict'))
    assert '(0.00, 0.00, 8.00) 10.0 mm' in text  # the highest are the worst


def test_the_keys_are_explained_in_a_high_window():
    guide = guide_at(status(CalibrationStatus.READY))
    lines = screen.render(guide, 1.0, 'keys', rows=40, command_list=commands.RIG)
    assert 'u   undo          drop the last corner' in lines


def test_the_verdict_says_what_to_measure_next_and_a_length_is_solved_at_once():
    node = FakeNode({'length': (True, 'corner 1 to corner 3 is 3.5395 m by tape'), 'undo': (True, '')})
    dialogue = dialogue_with(node, status(CalibrationStatus.COMPLETE))
    dialogue.command('d', ['1', '3', '3.5395'])
    dialogue.take_events(1.0)
    assert [r.name for r in node.sent] == ['measure_length']  # nothing was solved before
    dialogue.command('s')
    dialogue.take_events(2.0)
    node.events.put(('verdict', CalibrationVerdict(
        text='good', expected_error=0.0087,
        next_measurement='measure from corner 2 to corner 4 by tape: 8.7 -> 6.1 mm')))
    dialogue.command('length', ['2', '4', '3.5'])
    dialogue.take_events(3.0)
    assert [r.name for r in node.sent][1:] == ['solve', 'measure_length', 'solve']
    lines = screen.render(dialogue.guide, 3.0, 'verdict')
    assert lines[4:8] == [
        'good', 'corner 1 to corner 3 is 3.5395 m by tape',
        'Expected error of a point: 8.7 mm (RMS).',
        'Next (keys d, a): measure from corner 2 to corner 4 by tape: 8.7 -> 6.1 mm']


def test_the_correction_of_the_principal_points_is_a_table():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    assert 'not corrected' in screen.render(guide, 1.0, 'trace')[3]
    guide.trace = PrincipalPointTrace(
        cameras=['wiimote_1', 'wiimote_2'], origin_error=[0.168, 0.042], corner_error=[0.2, 0.061],
        cx=[535.0, 535.0, 520.5, 521.0], cy=[401.7, 401.7, 390.25, 391.0], table='the table\n')
    assert [line for line in screen.render(guide, 1.0, 'trace')[3:] if line][:6] == [
        'camera          principal point before and after [px]',
        'wiimote_1         535.0    401.7      520.5    390.2',
        'wiimote_2         535.0    401.7      521.0    391.0',
        'round  error of the first corner, of all corners [mm]',
        '    0       168.0      200.0',
        '    1        42.0       61.0']


def test_a_board_has_four_bars():
    guide = guide_at(status(CalibrationStatus.IDLE))
    guide.on_board(BoardStatus(camera='wiimote_1', views=5, views_needed=12, x=0.5, y=0.6,
                               size=0.2, skew=1.0, missing=['hold the board nearer'],
                               message='view 5 was kept'))
    lines = board_screen.render(guide, 9.0, 'wiimote_1')
    assert lines[0].startswith('LENS OF WIIMOTE_1   5 of 12 views') and lines[0].endswith('0:09')
    assert lines[4:8] == ['X     [####################--------------------]  50 %',
                          'Y     [########################----------------]  60 %',
                          'Size  [########--------------------------------]  20 %',
                          'Skew  [########################################] 100 %']
    assert '- hold the board nearer' in lines
    assert lines[21] == 'view 5 was kept'


def screens(rows, columns):
    """Every view of many states, with texts as long as they come."""
    long_text = 'a very long sentence that says what to do, ' * 12
    many = [camera('wiimote_%d_with_a_long_name' % i, problem=long_text, health=long_text,
                   samples=[1000] * 4, spread=[123.4] * 4, masks=12, x=1e9, y=-1e9)
            for i in range(16)]
    for step in range(12):
        for cameras in ([], many[:1], many):
            guide = guide_at(status(step, cameras=cameras, message=long_text,
                                    missing=[long_text] * 5, progress=NAN))
            guide.verdict = CalibrationVerdict(
                text=long_text, cameras=[CameraVerdict('c' * 40, *[1e9] * 9)] * 16,
                predicted_at=[Point()] * 8, predicted_stddev=[1e9] * 8)
            guide.on_board(BoardStatus(camera='wiimote_1', x=NAN, missing=[long_text] * 9,
                                       message=long_text))
            guide.trace = PrincipalPointTrace(
                cameras=['c' * 40] * 16, origin_error=[1e9] * 15, corner_error=[NAN] * 15,
                cx=[-1e9] * 240, cy=[NAN] * 240)
            for view in ('cameras', 'verdict', 'trace', 'keys'):
                for prompt in (None, ('a question?', 'typed ' * 40)):
                    yield screen.render(guide, 1.0, view, 3, rows, columns, prompt, commands.RIG)
            yield board_screen.render(guide, 1.0, 'wiimote_1', rows, columns)
            yield board_screen.render(guide, 9.0, 'nobody', rows, columns, ('why?', 'x'))


@pytest.mark.parametrize('rows, columns', [(24, 80), (24, 100), (50, 200)])
def test_every_screen_fits(rows, columns):
    count = 0
    for lines in screens(rows, columns):
        assert len(lines) == rows
        assert max(len(line) for line in lines) <= columns
        assert all(' ' <= character <= '~' for line in lines for character in line)
        count += 1
    assert count > 200


def test_a_window_that_is_too_small_is_told_so():
    for rows, columns in ((5, 80), (24, 30), (1, 12)):
        for lines in screens(rows, columns):
            assert len(lines) == rows and max(len(line) for line in lines) <= columns
    assert 'at least 80 x 24' in ' '.join(screen.render(Guide(0.0), 0.0, rows=5, columns=80))


def test_all_keys_are_on_one_screen_and_no_two_are_alike():
    lines = screen.render(guide_at(status(0)), 0.0, 'keys', command_list=commands.RIG)
    for command in commands.RIG:
        assert any('%-3s %s' % (command.key, command.word) in line for line in lines)
    for command_list in (commands.RIG, commands.board_commands('c')):
        taken = [c.key for c in command_list] + [c.word for c in command_list] + list(' qi?\t')
        assert len(taken) == len(set(taken))


def test_a_silent_node_and_none_at_all_are_one_sentence_each():
    assert screen.render(Guide(0.0), 1.0)[1] == 'Looking for the calibration node.'
    assert 'No calibration node answers' in screen.render(Guide(0.0), 4.0)[1]
    guide = guide_at(status(CalibrationStatus.READY))
    assert 'Do this.' in screen.render(guide, 2.9)[1]
    assert 'has said nothing for 5 s' in screen.render(guide, 5.0)[1]


def test_more_cameras_than_fit_are_on_further_pages():
    guide = guide_at(status(0, cameras=[camera('wiimote_%d' % i) for i in range(1, 7)]))
    assert 'cameras 1 to 4 of 6' in '\n'.join(screen.render(guide, 0.0))
    second = '\n'.join(screen.render(guide, 0.0, page=1))
    assert 'wiimote_5' in second and 'wiimote_6' in second and 'wiimote_4' not in second
    assert screen.render(guide, 0.0, page=2) == screen.render(guide, 0.0)
    assert 'wiimote_6' in '\n'.join(screen.render(guide, 0.0, columns=120))


def test_bars_and_wrapping():
    assert layout.bar(0.0, 4) == '[----]'
    assert layout.bar(0.5, 4) == '[##--]'
    assert layout.bar(1.0, 4) == layout.bar(7.0, 4) == '[####]'
    assert layout.bar(NAN, 4) == layout.bar(-1.0, 4) == '[----]'
    assert layout.wrapped('one two three four', 9, 2) == ['one two', 'three...']
    assert layout.wrapped('', 9, 2) == []


# --- What is next

@pytest.mark.parametrize('wanted, word', [
    ('learn_masks', 'masks'), ('check_connection', 'connection'), ('start', 'start'),
    ('capture_corner', 'capture'), ('start_wave', 'wave'), ('stop_wave', 'wave'),
    ('solve', 'solve'), ('save', 'save')])
def test_space_requests_what_the_node_wants(wanted, word):
    step = CalibrationStatus.WAVING if wanted == 'stop_wave' else CalibrationStatus.READY
    guide = guide_at(status(step, wanted, 'do it'))
    advice = guide.advice()
    assert advice.word == word and advice.sentence.startswith('Do this. SPACE: do it')
    command = commands.find(commands.RIG, word)
    assert command.build(guide.status, advice.arguments).name == wanted


def test_where_there_is_nothing_to_request_space_does_nothing():
    for request in ('', 'of_a_newer_node'):
        assert guide_at(status(CalibrationStatus.SAVED, request)).advice().word is None
    wand = guide_at(status(CalibrationStatus.READY, 'start_wave', 'begin', corners_needed=0)).advice()
    assert wand.word is None and wand.sentence == 'Do this. w asks for the length.'


def test_space_starts_with_the_side_that_was_given():
    start = status(CalibrationStatus.IDLE, 'start', 'start')
    advice = guide_at(start, side=['2.5', '1']).advice()
    assert advice.arguments == ['2.5', '1']
    assert advice.sentence == 'Do this. SPACE: start with 2.5 x 1 m.'
    assert guide_at(start).advice().sentence == 'Do this. SPACE: start; n asks for the side.'


def test_a_bad_corner_is_to_be_taken_again():
    guide = guide_at(status(CalibrationStatus.SOLVED, 'capture_corner', 'capture corner 3 again',
                            next_corner=2))
    assert guide.advice().word == 'capture' and guide.advice().arguments == ['3']


@pytest.mark.parametrize('sound, rings', [
    ('captured', 1), ('refused', 2), ('enough', 1), ('solved', 1)])
def test_the_bell_rings_for_every_sound_and_twice_for_a_refusal(sound, rings):
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.READY))
    assert dialogue.take_events(1.0) == 0
    node.events.put(('sound', String(sound)))
    node.events.put(('status', status(CalibrationStatus.READY)))
    assert dialogue.take_events(2.0) == rings


@pytest.mark.parametrize('step, request_, key', [
    ('IDLE', 'learn_masks', 'k'), ('COMPLETE', 'start_wave', 's'), ('SOLVED', '', 'v'),
    ('SOLVED', 'capture_corner', 'v'), ('SAVED', '', 'c')])
def test_the_key_of_another_way_on_is_named(step, request_, key):
    sentence = guide_at(status(getattr(CalibrationStatus, step), request_, 'do it')).advice().sentence
    assert f' {key} ' in sentence
    assert commands.find(commands.RIG, key) is not None


def test_the_walk_is_shown():
    guide = guide_at(status(CalibrationStatus.IDLE, walk='the LED was seen: a 17 %'))
    assert '- the LED was seen: a 17 %' in screen.render(guide, 0.0)


def test_it_says_how_long_it_took():
    guide = Guide(100.0)
    assert guide.took(160.4) == 'Nothing was calibrated and saved; this took 1 min 0 s.'
    guide.on_status(status(CalibrationStatus.READY, corners_captured=3), 160.4)
    assert guide.took(160.4).endswith('The node keeps 3 corners: calibrate goes on with them.')
    guide.on_answer('start', True, '', 110.0)
    guide.on_status(status(CalibrationStatus.READY, corners_captured=3), 120.0)
    guide.on_status(status(CalibrationStatus.COMPLETE, corners_captured=4), 150.0)
    guide.on_status(status(CalibrationStatus.SOLVED, corners_captured=4), 170.0)
    assert guide.elapsed(171.0) == 61.0
    guide.on_answer('save', True, '', 180.0)
    guide.on_answer('check', True, '', 200.0)
    assert guide.elapsed(999.0) == 70.0
    assert guide.took(999.0) == 'Calibrated and saved in 1 min 10 s, 40 s of it for the square.'


# --- Requests

def test_words_become_requests():
    waving = status(CalibrationStatus.WAVING, hands_free=True)
    Request = commands.request
    for line, expected in (
            ('masks', Request('learn_masks', 'LearnMasks', duration=0.0)),
            ('start', Request('start', 'StartCalibration', side_x=0.0, side_y=0.0)),
            ('start 2.5 1', Request('start', 'StartCalibration', side_x=2.5, side_y=1.0)),
            ('start wand', Request('start', 'StartCalibration', without_square=True)),
            ('capture', Request('capture_corner', 'CaptureCorner')),
            ('t 3', Request('capture_corner', 'CaptureCorner', retake=True, corner=2)),
            ('hands_free', Request('hands_free', 'SetBool', data=False)),
            ('h on', Request('hands_free', 'SetBool', data=True)),
            ('wave', Request('stop_wave', 'Trigger')),
            ('wave 0.5 0.001', Request('start_wave', 'StartWave', wand_length=0.5,
                                       wand_stddev=0.001)),
            ('length 1 3 3.536', Request('measure_length', 'MeasureLength', from_corner=0,
                                         to_corner=2, length=3.536, stddev=0.0)),
            ('check 0 1.5 -2', Request('check', 'CheckPlace', known=[0.0, 1.5, -2.0],
                                       known_stddev=0.0)),
            ('known 0 0 2', Request('measure_place', 'CheckPlace', known=[0.0, 0.0, 2.0],
                                    known_stddev=0.0)),
            ('save /tmp/a b.yaml', Request('save', 'SaveRig', path='/tmp/a b.yaml')),
            ('recalibrate wiimote_2', Request('recalibrate_camera', 'RecalibrateCamera',
                                              camera='wiimote_2', duration=0.0)),
            ('recalibrate wiimote_2 8', Request('recalibrate_camera', 'RecalibrateCamera',
                                                camera='wiimote_2', duration=8.0)),
            ('fit affine', Request('known_places/fit', 'FitRemap', models=['affine']))):
        words = line.split()
        assert commands.find(commands.RIG, words[0]).build(waving, words[1:]) == expected
    assert commands.find(commands.RIG, 'wave').build(
        status(CalibrationStatus.COMPLETE), []).name == 'start_wave'
    assert commands.find(commands.board_commands('w'), 'solve').build(
        None, ['equidistant']).fields == {'model': srv.SolveBoardRequest.EQUIDISTANT}
    assert len(commands.LENS_MODELS) == srv.SolveBoardRequest.EQUIDISTANT + 1


@pytest.mark.parametrize('line', [
    'check', 'check 1 2', 'check 1 2 x', 'check nan 0 0', 'check 1 2 3 4 5', 'capture 0',
    'capture 5', 'capture 1 2', 'start a', 'start 1 2 3', 'wave x', 'hands_free maybe', 'undo 1',
    'recalibrate', 'recalibrate a b', 'masks soon', 'solve now', 'place 1 2', 'length 1 3',
    'length 1 13 2.5', 'length 0 1 2.5', 'length 1 2 x', 'length 1 2 2.5 0.001 9'])
def test_words_that_make_no_sense_are_refused_with_what_would(line):
    words = line.split()
    with pytest.raises(commands.UsageError) as refusal:
        commands.find(commands.RIG, words[0]).build(None, words[1:])
    assert len(str(refusal.value)) > 15


def test_every_request_has_the_fields_of_its_service():
    for command_list in (commands.RIG, commands.board_commands('wiimote_1')):
        for command in command_list:
            words = {'check': ['1', '2', '3'], 'place': ['1', '2', '3'], 'length': ['1', '3', '2'],
                     'known': ['1', '2', '3'],
                     'recalibrate': ['wiimote_1']}.get(command.word, [])
            request = command.build(status(CalibrationStatus.READY), words)
            if request.type in ('Trigger', 'SetBool'):
                assert set(request.fields) <= {'data'}
            elif request.type == 'CaptureCorner':
                assert set(request.fields) <= set(CaptureCornerGoal.__slots__)
            else:
                message = getattr(srv, request.type + 'Request')
                assert set(request.fields) <= set(message.__slots__), request


# --- The dialogue

class FakeNode:
    """Answers with what it is told to, or not at all."""

    def __init__(self, answers=None):
        self.events = queue.Queue()
        self.sent = []
        self.called_off = 0
        self._answers = answers

    def send(self, word, request):
        self.sent.append(request)
        if self._answers is not None:
            self.events.put(('answer', word) + self._answers.get(word, (True, word + ' done')))

    def call_off_capture(self):
        self.called_off += 1


CAPTURE = status(CalibrationStatus.READY, 'capture_corner', 'capture')


def dialogue_with(node, *statuses):
    guide = Guide(0.0)
    for each in statuses:
        node.events.put(('status', each))
    dialogue = Dialogue(guide, node, commands.RIG, guide.advice)
    dialogue.take_events(0.0)
    return dialogue


def test_one_request_at_a_time_but_it_can_be_called_off():
    node = FakeNode()
    dialogue = dialogue_with(node, CAPTURE)
    dialogue.next()
    assert [r.name for r in node.sent] == ['capture_corner']
    dialogue.command('s')
    assert len(node.sent) == 1 and 'capture has not been answered' in dialogue.guide.answer
    dialogue.command('x')
    assert node.called_off == 1 and len(node.sent) == 1
    node.events.put(('feedback', 'wiimote_1 lacks 20', 0.6))
    dialogue.take_events(1.0)
    assert '[############--------] wiimote_1 lacks 20' in screen.render(dialogue.guide, 1.0)
    node.events.put(('answer', 'capture', False, 'corner 1 was not captured: the request was cancelled'))
    dialogue.take_events(2.0)
    assert screen.render(dialogue.guide, 2.0)[21] == 'corner 1 was not captured: the request was cancelled'
    dialogue.command('s')
    dialogue.command('x')  # the service cancels solving
    assert [r.name for r in node.sent] == ['capture_corner', 'solve', 'cancel']


def test_space_waits_for_what_the_latest_answer_has_led_to():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.SOLVED))
    node.events.put(('answer', 'solve', True, 'good'))
    dialogue.take_events(1.0)
    dialogue.next()  # of a status from before the answer nobody knows what comes next
    assert not node.sent and dialogue.is_busy()
    node.events.put(('status', status(CalibrationStatus.SAVED)))
    dialogue.take_events(2.0)
    assert not node.sent and not dialogue.is_busy()
    assert dialogue.guide.answer == 'Do this. c checks it.'
    node.events.put(('status', CAPTURE))
    dialogue.take_events(3.0)
    dialogue.next()
    assert [r.name for r in node.sent] == ['capture_corner']


def test_what_is_typed_wrongly_reaches_no_node():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.READY))
    dialogue.command('check', ['here'])
    assert 'three numbers' in dialogue.guide.answer
    dialogue.command('?!')
    assert 'there is no' in dialogue.guide.answer
    assert not node.sent


def plain(text, node, *statuses):
    """Exit count of failures and all that was said."""
    said = []
    dialogue = dialogue_with(node, *statuses)
    face = Plain(dialogue, said.append, io.StringIO(text))
    dialogue.guide.on_status(statuses[-1], time.monotonic())
    face.run()
    return face.failures, said


def test_plain_words_are_carried_out_one_after_the_other():
    node = FakeNode({})
    failures, said = plain('undo # a remark\n\nstart 2.5\nquit\nsolve\n', node,
                           status(CalibrationStatus.READY, message='ready'))
    assert [r.name for r in node.sent] == ['undo', 'start']
    assert failures == 0
    assert 'undo done' in said and 'start done' in said
    assert any('ready' in line for line in said)


def test_plain_counts_what_was_refused_and_what_was_not_understood():
    node = FakeNode({'solve': (False, 'only 2 of 4 corners are captured')})
    failures, said = plain('solve\ncheck here\nfoo\nwait 0\n', node,
                           status(CalibrationStatus.READY, missing=['corner 3']))
    assert failures == 4
    assert 'refused: only 2 of 4 corners are captured' in said
    assert 'waited for 0 s; corner 3' in said


def test_plain_next_without_a_node_fails_and_does_not_hang():
    said = []
    guide = Guide(-10.0)
    face = Plain(Dialogue(guide, FakeNode(), commands.RIG, guide.advice), said.append,
                 io.StringIO('next\n'))
    face.run()
    assert face.failures == 1
    assert 'Waiting for the calibration node.' in said


def test_plain_waits_until_nothing_is_missing():
    node = FakeNode({})
    dialogue = dialogue_with(node, status(CalibrationStatus.WAVING, missing=['3 s']))
    said = []

    def say(text):
        said.append(text)
        if text == 'missing: 1 s':
            node.events.put(('status', status(CalibrationStatus.WAVING, message='enough')))

    # After an answer, one status may be from before it.
    node.events.put(('answer', 'wave', True, 'recording'))
    node.events.put(('status', status(CalibrationStatus.COMPLETE)))
    face = Plain(dialogue, say, io.StringIO('wait 30\nsolve\n'))

    def tell_more(text, say=say):
        say(text)
        if text == 'recording':
            node.events.put(('status', status(CalibrationStatus.WAVING, missing=['1 s'])))
    face._say = tell_more
    face.run()
    assert face.failures == 0
    assert said.index('missing: 1 s') < said.index('  0 %  enough') < said.index('solve done')
