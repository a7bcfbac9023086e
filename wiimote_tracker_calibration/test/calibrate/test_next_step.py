"""What calibrate says is next, what SPACE requests, and how long all took."""

import pytest
from wiimote_tracker_msgs.msg import CalibrationStatus

from fakes import FakeNode, camera, dialogue_with, guide_at, status
from guide import commands
from guide.board_screen import advice as board_advice
from guide.guide import PLAIN_WORDS, Guide


@pytest.mark.parametrize('wanted, word', [
    ('learn_masks', 'masks'), ('check_connection', 'connection'), ('start', 'start'),
    ('capture_corner', 'capture'), ('start_wave', 'wave'), ('stop_wave', 'wave'),
    ('solve', 'solve'), ('save', 'save'), ('continuous/apply', 'apply')])
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
    wand = guide_at(status(CalibrationStatus.READY, 'start_wave', 'begin',
                           corners_needed=0)).advice()
    assert wand.word is None and wand.sentence == 'Do this. w asks for the length.'


def test_a_camera_that_was_moved_is_not_to_be_checked():
    moved = [camera(health='drifted; put it back')]
    assert guide_at(status(CalibrationStatus.SAVED, cameras=moved)).advice().sentence == 'Do this.'


def test_a_change_of_continuous_calibration_is_used_and_undone_by_keys():
    node = FakeNode()
    dialogue = dialogue_with(node, status(CalibrationStatus.SAVED, 'continuous/apply', 'use it'))
    for press in (dialogue.next, lambda: dialogue.command('A'), lambda: dialogue.command('b')):
        press()
        node.events.put(('answer', dialogue.guide.running[-1], True, 'done'))
        dialogue.take_events(1.0)
    assert [(each.name, each.type) for each in node.sent] == [
        ('continuous/apply', 'Trigger'), ('continuous/apply', 'Trigger'),
        ('continuous/revert', 'Trigger')]


def test_space_starts_with_the_side_that_was_given():
    start = status(CalibrationStatus.IDLE, 'start', 'start')
    advice = guide_at(start, start=['2.5', '1']).advice()
    assert advice.arguments == ['2.5', '1']
    assert advice.sentence == 'Do this. SPACE: start with 2.5 x 1 m.'
    assert guide_at(start).advice().sentence == 'Do this. SPACE: start; n asks for the side.'


def test_space_starts_with_a_wand_that_lies_on_the_floor():
    for wanted in ('check_connection', 'start'):
        guide = guide_at(status(CalibrationStatus.IDLE, wanted, 'do it'), start=['wand', '0.5'])
        advice = guide.advice()
        assert (advice.word, advice.arguments) == ('start', ['wand', '0.5'])
        assert 'SPACE' in advice.sentence
        assert commands.find(commands.RIG, 'start').build(
            guide.status, advice.arguments).fields['wand_length'] == 0.5
    assert advice.sentence == 'Do this. SPACE: do it with the wand of 0.5 m.'
    masks = guide_at(status(CalibrationStatus.IDLE, 'learn_masks', 'mask'), start=['wand', '0.5'])
    assert masks.advice().word == 'masks'


@pytest.mark.parametrize('corner', range(4))
def test_a_bad_corner_is_to_be_taken_again(corner):
    guide = guide_at(status(CalibrationStatus.SOLVED, 'capture_corner', 'capture it again',
                            next_corner=corner))
    assert guide.advice().word == 'capture' and guide.advice().arguments == [str(corner + 1)]


@pytest.mark.parametrize('step, request_, key', [
    ('IDLE', 'learn_masks', 'k'), ('COMPLETE', 'start_wave', 's'), ('SOLVED', '', 'v'),
    ('SOLVED', 'capture_corner', 'v'), ('SAVED', '', 'c')])
def test_the_key_of_another_way_on_is_named(step, request_, key):
    sentence = guide_at(
        status(getattr(CalibrationStatus, step), request_, 'do it')).advice().sentence
    assert f' {key} ' in sentence
    assert commands.find(commands.RIG, key) is not None


@pytest.mark.parametrize('step, request_, corners, sentence', [
    ('IDLE', 'learn_masks', 4, 'The word next: do it. The word connection goes on without.'),
    ('IDLE', 'start', 4, 'The word next: do it; start METRES gives the side.'),
    ('READY', 'start_wave', 0, 'wave METRES begins.'),
    ('COMPLETE', 'start_wave', 4, 'The word next: do it. The word solve solves.'),
    ('SOLVED', '', 4, 'The word save saves.'), ('SAVED', '', 4, 'check X Y Z checks it.')])
def test_line_by_line_words_are_named_in_place_of_keys(step, request_, corners, sentence):
    guide = guide_at(status(getattr(CalibrationStatus, step), request_, 'do it',
                            corners_needed=corners), asking=PLAIN_WORDS)
    assert guide.advice().sentence == 'Do this. ' + sentence
    assert board_advice(guide, 'wiimote_1').sentence.endswith('. The word next starts.')


def test_a_board_is_refused_before_a_camera_that_does_not_exist():
    cameras = [camera('wiimote_1'), camera('wiimote_2')]
    advice = board_advice(guide_at(status(CalibrationStatus.IDLE, cameras=cameras)), 'wiimote_77')
    assert advice.word is None
    assert advice.sentence == 'There is no camera wiimote_77: name one of wiimote_1, wiimote_2.'


def test_it_says_how_long_it_took():
    guide = Guide(100.0)
    assert guide.took(160.4) == 'No calibration was saved; this took 1 min 0 s.'
    guide.on_status(status(CalibrationStatus.READY, corners_captured=3), 160.4)
    assert guide.took(160.4).endswith('The node keeps 3 corners: calibrate goes on with them.')
    guide.on_status(status(CalibrationStatus.SAVED, corners_captured=4), 100.0)  # nothing is left
    assert guide.took(160.4) == 'No calibration was saved; this took 1 min 0 s.'
    guide.on_answer('start', True, '', 110.0)
    guide.on_status(status(CalibrationStatus.READY, corners_captured=3), 120.0)
    guide.on_answer('save', True, '', 125.0)  # the rig of an earlier calibration
    assert guide.took(130.0).startswith('No calibration was saved')
    guide.on_status(status(CalibrationStatus.COMPLETE, corners_captured=4), 150.0)
    guide.on_status(status(CalibrationStatus.SOLVED, corners_captured=4), 170.0)
    assert guide.elapsed(171.0) == 61.0
    guide.on_answer('save', True, '', 180.0)
    guide.on_answer('check', True, '', 200.0)
    assert guide.elapsed(999.0) == 70.0
    assert guide.took(999.0) == 'Calibrated and saved in 1 min 10 s, 40 s of it for the square.'


def test_a_recalibrated_camera_that_was_saved_is_told():
    guide = guide_at(status(CalibrationStatus.SAVED))
    guide.on_answer('recalibrate', True, '', 20.0)
    guide.on_status(status(CalibrationStatus.SOLVED), 21.0)
    assert guide.took(22.0).startswith('No calibration was saved')
    guide.on_answer('save', True, '', 30.0)
    guide.on_status(status(CalibrationStatus.SAVED), 31.0)
    assert guide.took(60.0).startswith('The rig was saved; this took ')


def test_at_the_end_it_says_that_a_change_since_is_not_saved():
    guide = guide_at(status(CalibrationStatus.SOLVED))
    guide.on_answer('start', True, '', 10.0)
    guide.on_answer('save', True, '', 20.0)
    guide.on_status(status(CalibrationStatus.SOLVED), 20.1)  # was on its way
    assert 'not saved' not in guide.took(30.0)
    guide.on_status(status(CalibrationStatus.SAVED), 21.0)
    assert 'not saved' not in guide.took(30.0)
    for at in (22.0, 23.0):  # a corrected rig that is still approached
        guide.on_status(status(CalibrationStatus.SOLVED, next_title='Wait'), at)
    assert 'not saved' not in guide.took(30.0)
    guide.on_answer('remove', True, '', 25.0)
    for at in (25.5, 26.0):
        guide.on_status(status(CalibrationStatus.SOLVED), at)
    assert guide.took(30.0) == ('Calibrated and saved in 10 s. The change since is not saved: '
                                'start calibrate again. v saves it.')


def test_at_the_end_it_says_what_the_node_goes_on_with():
    guide = guide_at(status(CalibrationStatus.MEASURING))
    guide.on_request('recalibrate')
    assert guide.took(9.0).endswith(' The node goes on with recalibrate: calibrate shows it, and x '
                                    'stops it there.')
    guide.on_request('cancel')
    assert 'goes on' not in guide.took(9.0)
    guide.on_answer('cancel', True, '', 9.0)
    guide.on_answer('recalibrate', False, '', 9.0)
    assert 'goes on' not in guide.took(9.0)


def test_a_rig_whose_cameras_send_no_images_is_not_to_be_checked():
    silent = status(CalibrationStatus.SAVED, next_title='No images', next_sentence='Start them.')
    assert guide_at(silent).advice().sentence == 'Start them.'
