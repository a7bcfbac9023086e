"""What a person sees while a camera's lens is measured with a board."""

from wiimote_tracker_msgs.msg import BoardStatus, CalibrationStatus

from fakes import camera, guide_at, status
from guide import board_screen


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
    assert '|O               |' in lines  # what the camera sees
    assert ('There is no camera wiimote_2: name one of wiimote_1.' in
            board_screen.render(guide, 1.0, 'wiimote_2'))


def test_a_board_before_another_camera_does_not_count():
    guide = guide_at(status(CalibrationStatus.IDLE,
                            cameras=[camera('wiimote_1'), camera('wiimote_2', blobs=4)]))
    other = BoardStatus(camera='wiimote_2', views=5, views_needed=12)
    assert not guide.on_board(other)
    assert guide.on_board(BoardStatus(camera='wiimote_2', views=6, views_needed=12))
    assert not guide.on_board(BoardStatus(camera='wiimote_1', views=7, views_needed=12))
    guide.on_board(other)
    assert board_screen.advice(guide, 'wiimote_1').word == 'start'
    text = '\n'.join(board_screen.render(guide, 1.0, 'wiimote_1'))
    assert '1 spot' in text and '4 spots' not in text and 'of 12 views' not in text


def test_a_lens_whose_view_is_dropped_is_solved_again():
    guide = guide_at(status(CalibrationStatus.IDLE))
    guide.on_board(BoardStatus(camera='wiimote_1', views=13, views_needed=12))
    for word, following in (('start', 'solve'), ('solve', 'commit'), ('undo', 'solve'),
                            ('solve', 'commit'), ('commit', None), ('start', 'solve')):
        guide.on_answer(word, True, '', 1.0)
        assert board_screen.advice(guide, 'wiimote_1').word == following
