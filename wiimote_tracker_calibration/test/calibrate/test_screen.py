"""What a person sees of a calibration."""

import pytest
from geometry_msgs.msg import Point
from wiimote_tracker_msgs.msg import (BoardStatus, CalibrationStatus, CalibrationVerdict,
                                      CameraVerdict, PrincipalPointTrace)

from fakes import NAN, camera, guide_at, status
from guide import board_screen, commands, screen, text
from guide.guide import Guide


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
               next_sentence='Put the LED on corner 3 (counter-clockwise seen from above puts z '
               'up).',
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


def test_spots_of_a_camera_are_no_problem_once_there_is_a_rig():
    for step, shown in ((CalibrationStatus.READY, True), (CalibrationStatus.SAVED, False)):
        guide = guide_at(status(step, cameras=[camera(problem='sees 4 spots', health='moved')]))
        lines = screen.render(guide, 1.0)
        assert ('- wiimote_1: sees 4 spots' in lines) == shown
        assert '- wiimote_1: moved' in lines


def test_what_has_no_room_is_counted():
    for count, third in ((3, '- wait 2 s'), (5, '- and 3 more')):
        missing = [f'wait {i} s' for i in range(count)]
        assert screen.remarks(status(CalibrationStatus.READY, missing=missing), 80, 3) == [
            '- wait 0 s', '- wait 1 s', third]


def test_a_large_window_has_large_pictures():
    cells = [row == 5 and column == 7 for row in range(6) for column in range(8)]
    cameras = [camera('wiimote_%d' % i, x=1023.0, y=0.0, image_cells=cells, image_coverage=0.02)
               for i in range(1, 5)]
    guide = guide_at(status(CalibrationStatus.WAVING, cameras=cameras, missing=['wave on']))
    lines = screen.render(guide, 1.0, rows=40, columns=120)
    pictures = [line for line in lines if line.startswith('|')]
    assert [line[:26] for line in pictures] == (
        ['|.......................O|'] + ['|........................|'] * 7 +
        ['|.....................###|'])
    assert all(line.count('|') == 8 for line in pictures)
    assert '- wave on' in lines


def test_the_answer_is_shown_beside_the_verdict_and_the_trace():
    guide = guide_at(status(CalibrationStatus.SAVED, message='saved to rig.yaml'))
    for view in ('verdict', 'trace'):
        assert screen.render(guide, 1.0, view)[21] == 'saved to rig.yaml'


def test_a_newer_message_of_the_node_takes_the_place_of_an_answer():
    guide = guide_at(status(CalibrationStatus.READY, message='old'))
    guide.on_answer('undo', True, 'answered', 1.0)
    guide.on_status(status(CalibrationStatus.READY, message='old'), 2.0)
    assert screen.render(guide, 2.0)[21] == 'answered'
    guide.on_status(status(CalibrationStatus.READY, message='new'), 3.0)
    assert screen.render(guide, 3.0)[21] == 'new'


def test_an_answer_goes_some_seconds_after_the_situation_that_it_was_for():
    guide = guide_at(status(CalibrationStatus.SAVED, next_title='Ready'))
    guide.on_answer('check', True, 'the calibration holds', 1.0)
    for number in range(25):
        moved = number > 5
        assert guide.said() == ('' if number > 21 else 'the calibration holds'), number
        guide.on_status(status(CalibrationStatus.SAVED, next_title='Check wiimote_2' if moved
                               else 'Ready'), 1.0 + 0.5 * number)
    guide.say('there is no such key')
    guide.on_status(status(CalibrationStatus.SAVED, next_title='Check wiimote_2'), 20.0)
    assert guide.said() == 'there is no such key'


def test_a_node_that_was_started_again_amid_a_calibration_has_lost_it():
    def numbered(seq, step, **fields):
        message = status(step, **fields)
        message.header.seq = seq
        return message
    guide = guide_at(numbered(50, CalibrationStatus.WAVING),
                     numbered(0, CalibrationStatus.IDLE),
                     numbered(1, CalibrationStatus.SAVED, message='the old rig is in use'))
    assert 'is lost. Start again.' in screen.render(guide, 3.0)[21]
    guide.on_request('start')
    guide.on_answer('start', True, 'started', 4.0)
    assert screen.render(guide, 4.0)[21] == 'started'
    saved = guide_at(numbered(50, CalibrationStatus.SAVED), numbered(0, CalibrationStatus.IDLE))
    assert not saved.lost


def test_a_verdict_stands_on_its_page_once():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    guide.verdict = CalibrationVerdict(text='Good: known to 3 mm.')
    guide.answer = guide.verdict.text
    for view in ('verdict', 'cameras'):
        assert '\n'.join(screen.render(guide, 1.0, view)).count(guide.verdict.text) == 1


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


def test_a_verdict_that_does_not_fit_is_on_pages():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    guide.verdict = CalibrationVerdict(
        text='Usable. ' * 60, next_measurement='measure ' * 15, expected_error=0.01,
        cameras=[CameraVerdict(f'wiimote_{i}', *[0.1] * 9) for i in range(9)],
        predicted_at=[Point(0, 0, z) for z in range(9)], predicted_stddev=[0.01] * 9)
    first = screen.render(guide, 1.0, 'verdict')
    assert 'lines 1 to 18 of 26; TAB shows others' in first
    assert not any('8.00) 10.0 mm' in line for line in first)
    second = screen.render(guide, 1.0, 'verdict', page=1)
    assert 'lines 19 to 26 of 26; TAB shows others' in second
    assert any('8.00) 10.0 mm' in line for line in second)
    assert screen.render(guide, 1.0, 'verdict', page=2) == first
    assert any('8.00) 10.0 mm' in line for line in screen.render(guide, 1.0, 'verdict', rows=40))


def test_what_is_typed_is_shown_as_it_is():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    lines = screen.render(guide, 1.0, prompt=('Rig file', '/home/jörg/rig.yaml'))
    assert lines[-2:] == ['Rig file', '> /home/jörg/rig.yaml']
    lines = screen.render(guide, 1.0, prompt=('Rig file', '部' * 99))  # two columns each
    assert lines[-1] == '> ' + '部' * 38


def test_beside_a_verdict_stands_what_was_measured_and_what_to_measure_next():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    guide.verdict = CalibrationVerdict(text='Good.', expected_error=0.0087,
                                       next_measurement='measure from corner 2 to corner 4')
    guide.on_answer('known', True, 'The place was taken.', 1.0)
    guide.on_answer('length', False, 'The length was refused.', 1.0)
    lines = screen.render(guide, 1.0, 'verdict')
    measured = lines.index('The place was taken.')
    assert lines[measured + 1:measured + 3] == [
        'Expected error at the corners and above them: 8.7 mm (RMS).',
        'Next (keys d, a): measure from corner 2 to corner 4']


def test_the_keys_are_explained_in_a_high_window():
    guide = guide_at(status(CalibrationStatus.READY))
    lines = screen.render(guide, 1.0, 'keys', rows=40, command_list=commands.RIG)
    assert 'u   undo          drop a length taken last, else place, else wave, else corner' in lines


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
    assert 'at least 80 x 24; it is 60 x 24' in ' '.join(
        board_screen.render(Guide(0.0), 0.0, 'wiimote_1', columns=60))


def test_all_keys_are_on_one_screen_and_no_two_are_alike():
    lines = screen.render(guide_at(status(0)), 0.0, 'keys', command_list=commands.RIG)
    for command in commands.RIG:
        # Typed after a key that does not ask, such as v, a path would be further keys.
        arguments = command.arguments if command.ask else ''
        text = f'{command.key} {command.word} {arguments}'.rstrip()
        assert any(f' {text} ' in f' {line} ' for line in lines), text
    for command_list in (commands.RIG, commands.board_commands('c')):
        taken = [c.key for c in command_list] + [c.word for c in command_list] + list(' qi?\t')
        assert len(taken) == len(set(taken))


def test_a_silent_node_and_none_at_all_are_one_sentence_each():
    assert screen.render(Guide(0.0), 1.0)[1] == 'Looking for the calibration node.'
    assert 'No calibration node answers' in screen.render(Guide(0.0), 4.0)[1]
    guide = Guide(0.0)
    guide.elsewhere = ('a calibration node runs in /second: type  ROS_NAMESPACE=/second rosrun '
                       'wiimote_tracker_calibration calibrate')
    assert ' '.join(screen.render(guide, 1.0)[1:3]).split() == (
        'None here, but ' + guide.elsewhere).split()
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
    assert text.bar(0.0, 4) == '[----]'
    assert text.bar(0.5, 4) == '[##--]'
    assert text.bar(1.0, 4) == text.bar(7.0, 4) == '[####]'
    assert text.bar(NAN, 4) == text.bar(-1.0, 4) == '[----]'
    assert text.wrapped('one two three four', 9, 2) == ['one two', 'three...']
    assert text.wrapped('', 9, 2) == []
    assert [text.figure(value, 2) for value in (-0.001, 0.0, -0.01, NAN)] == [
        '0.00', '0.00', '-0.01', '-']


def test_cameras_with_the_same_problem_are_named_together():
    cameras = [camera(f'wiimote_{i}', problem=problem) for i, problem in enumerate('xyx', 1)]
    assert screen.remarks(status(CalibrationStatus.READY, cameras=cameras), 80, 9) == [
        '- wiimote_1, wiimote_3: x', '- wiimote_2: y']


def test_what_does_not_fit_ends_before_a_number_and_after_a_word():
    assert text.wrapped('known to 2.6 mm at 2.5 m', 15, 1) == ['known to...']
    assert text.wrapped('known to within 2.6 mm', 20, 1) == ['known to within...']
    assert text.wrapped('known to (0.5 mm', 16, 1) == ['known to (0.5 mm']
    assert text.wrapped('unbreakable_as_names_are', 12, 1) == ['unbreakab...']


def test_a_high_window_shows_a_long_answer_in_full():
    answer = 'Good; points are known to 2.6 mm at the worst corner; ' * 8 + 'warning: z is down'
    guide = guide_at(status(CalibrationStatus.SOLVED, message=answer))
    for rows, is_whole in ((24, False), (40, True)):
        lines = screen.render(guide, 1.0, rows=rows, columns=100)
        assert len(lines) == rows
        assert ('warning: z is down' in ' '.join(lines)) == is_whole


def test_an_answer_that_is_cut_names_the_key_that_shows_more():
    for shown, is_verdict in (('saved; ', False), ('Good; ', True)):
        answer = shown + 'a camera did not accept its lens; ' * 12 + 'warning: z is down'
        guide = guide_at(status(CalibrationStatus.SOLVED, message=answer))
        guide.verdict = CalibrationVerdict(text=answer if is_verdict else 'Good.')
        assert screen.render(guide, 1.0)[21].endswith('... (i: more)')
        assert ' '.join(screen.render(guide, 1.0, 'verdict')).count('warning: z is down') == 1


def test_the_walk_is_shown():
    guide = guide_at(status(CalibrationStatus.IDLE, walk='the LED was seen: a 17 %'))
    assert '- the LED was seen: a 17 %' in screen.render(guide, 0.0)
