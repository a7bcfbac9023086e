"""The words of calibrate and the requests they become."""

import io

import pytest
import std_srvs.srv
from wiimote_tracker_msgs import srv
from wiimote_tracker_msgs.msg import CalibrationStatus, CaptureCornerGoal

from fakes import status
from guide import commands
from guide.node import fill


def test_words_become_requests():
    waving = status(CalibrationStatus.WAVING, hands_free=True)
    Request = commands.request
    for line, expected in (
            ('masks', Request('learn_masks', 'LearnMasks', duration=0.0)),
            ('start', Request('start', 'StartCalibration', side_x=0.0, side_y=0.0)),
            ('start 2.5 1', Request('start', 'StartCalibration', side_x=2.5, side_y=1.0)),
            ('start wand', Request('start', 'StartCalibration', without_square=True,
                                   wand_length=0.0, wand_stddev=0.0)),
            ('start wand 0.5 0.001', Request('start', 'StartCalibration', without_square=True,
                                             wand_length=0.5, wand_stddev=0.001)),
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
            ('R wiimote_2', Request('remove_camera', 'RemoveCamera', camera='wiimote_2')),
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
    'capture 5', 'capture 1 2', 'start a', 'start 1 2 3', 'start wand x', 'start wand 1 2 3',
    'wave x', 'hands_free maybe', 'undo 1', 'recalibrate', 'recalibrate a b', 'remove',
    'masks soon', 'solve now', 'place 1 2', 'length 1 3', 'length 1 13 2.5', 'length 0 1 2.5',
    'length 1 2 x', 'length 1 2 2.5 0.001 9'])
def test_words_that_make_no_sense_are_refused_with_what_would(line):
    words = line.split()
    with pytest.raises(commands.UsageError) as refusal:
        commands.find(commands.RIG, words[0]).build(None, words[1:])
    assert len(str(refusal.value)) > 15


@pytest.mark.parametrize('given, fields, question', [
    (['3'], {'side_x': 3.0, 'side_y': 0.0}, 'Enter: 3 m'),
    (['3', '2'], {'side_x': 3.0, 'side_y': 2.0}, 'Enter: 3 x 2 m'),
    (['wand', '0.5'], {'without_square': True, 'wand_length': 0.5, 'wand_stddev': 0.0},
     'Enter: wand of 0.5 m'),
    ([], {'side_x': 0.0, 'side_y': 0.0}, 'Enter: parameter')])
def test_a_start_without_words_takes_those_of_the_program(given, fields, question):
    start = commands.find(commands.rig_commands(given), 'n')
    assert start.build(None, []).fields == fields
    assert start.build(None, ['1']).fields['side_x'] == 1.0
    assert start.ask.endswith(question) and len(start.ask) < 80


@pytest.mark.parametrize('words', [['0'], ['2.5', '0'], ['-1']])
def test_a_side_of_0_is_not_the_side_of_the_parameter(words):
    with pytest.raises(commands.UsageError, match='must be above 0'):
        commands.find(commands.RIG, 'start').build(None, words)


def test_a_decimal_comma_is_refused_with_a_number_as_it_must_be():
    with pytest.raises(commands.UsageError, match='a number such as 2.5, not "2,5"'):
        commands.find(commands.RIG, 'start').build(None, ['2,5'])


@pytest.mark.parametrize('line', ['solve fisheye', 'solve equidistant plumb_bob', 'start 0.1 x',
                                  'start 0.1 0.1 0.1'])
def test_words_for_a_board_that_make_no_sense_are_refused(line):
    words = line.split()
    build = commands.find(commands.board_commands('w'), words[0]).build
    with pytest.raises(commands.UsageError):
        build(None, words[1:])


def test_every_request_fits_into_the_message_of_its_service():
    for command_list in (commands.RIG, commands.board_commands('wiimote_1')):
        for command in command_list:
            place = [['1', '2', '3']]
            for words in {'check': place, 'place': place, 'known': place,
                          'length': [['1', '3', '2']], 'recalibrate': [['wiimote_1']],
                          'remove': [['wiimote_1']],
                          'start': [[], ['2', '1']], 'wave': [[], ['0.5', '0.001']],
                          'capture': [[], ['3']], 'fit': [['affine']]}.get(command.word, [[]]):
                request = command.build(status(CalibrationStatus.READY), words)
                package = std_srvs.srv if request.type in ('Trigger', 'SetBool') else srv
                message = (CaptureCornerGoal() if request.type == 'CaptureCorner' else
                           getattr(package, request.type + 'Request')())
                fill(message, request.fields)  # raises an error for other fields
                message.serialize(io.BytesIO())  # and for values of other types
                if 'known' in request.fields:
                    assert (message.known.x, message.known.y, message.known.z) == (1.0, 2.0, 3.0)
    wand = commands.find(commands.RIG, 'start').build(None, ['wand', '0.5', '0.001'])
    message = srv.StartCalibrationRequest()
    fill(message, wand.fields)
    message.serialize(io.BytesIO())
