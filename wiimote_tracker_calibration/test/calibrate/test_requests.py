"""The words of calibrate and the requests they become."""

import pytest
from wiimote_tracker_msgs import srv
from wiimote_tracker_msgs.msg import CalibrationStatus, CaptureCornerGoal

from fakes import status
from guide import commands


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
    'capture 5', 'capture 1 2', 'start a', 'start 1 2 3', 'start wand x', 'start wand 1 2 3','wave x', 'hands_free maybe', 'undo 1',
    'recalibrate', 'recalibrate a b', 'masks soon', 'solve now', 'place 1 2', 'length 1 3',
    'length 1 13 2.5', 'length 0 1 2.5', 'length 1 2 x', 'length 1 2 2.5 0.001 9'])
def test_words_that_make_no_sense_are_refused_with_what_would(line):
    words = line.split()
    with pytest.raises(commands.UsageError) as refusal:
        commands.find(commands.RIG, words[0]).build(None, words[1:])
    assert len(str(refusal.value)) > 15


@pytest.mark.parametrize('line', ['solve fisheye', 'solve equidistant plumb_bob', 'start 0.1 x',
                                  'start 0.1 0.1 0.1'])
def test_words_for_a_board_that_make_no_sense_are_refused(line):
    words = line.split()
    build = commands.find(commands.board_commands('w'), words[0]).build
    with pytest.raises(commands.UsageError):
        build(None, words[1:])


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
