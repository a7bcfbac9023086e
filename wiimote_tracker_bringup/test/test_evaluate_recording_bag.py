"""evaluate_recording bag says why it can say little of a bag that import_multicamselfcal did not
make."""

import pytest
import rosbag
from wiimote_tracker_msgs.msg import IrBlobArray, RigCalibration

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.recordings import program, replay, reprojection


def test_the_bag_is_not_overwritten(tmp_path, monkeypatch):
    (tmp_path / 'in.bag').write_text('recorded')
    (tmp_path / 'link').symlink_to(tmp_path / 'in.bag')
    monkeypatch.setattr('sys.argv', ['evaluate_recording', 'bag', str(tmp_path / 'in.bag'),
                                     '--json', str(tmp_path / 'link')])
    with pytest.raises(SystemExit, match='link: write to another file'):
        program.main()
    assert (tmp_path / 'in.bag').read_text() == 'recorded'


def test_a_bag_that_does_not_exist(tmp_path, monkeypatch):
    monkeypatch.setattr('sys.argv', ['evaluate_recording', 'bag', str(tmp_path / 'in.bag')])
    with pytest.raises(SystemExit, match='in.bag: No such file or directory; check its name'):
        program.main()


@pytest.mark.parametrize('raised, seen', [
    (Refusal('no points'), SystemExit('evaluate_recording: no points')),
    (ValueError('no points'), ValueError('no points'))])
def test_only_refusals_are_told_in_words(raised, seen, monkeypatch):
    """A mistake of the program shows where it was made."""
    def fail(*_):
        raise raised
    monkeypatch.setattr(replay, 'evaluate', fail)
    monkeypatch.setattr('sys.argv', ['evaluate_recording', 'bag', 'in.bag'])
    with pytest.raises(type(seen), match=f'^{seen}$'):
        program.main()


def test_a_bag_that_is_too_short_for_the_tracker(tmp_path, monkeypatch):
    with rosbag.Bag(str(tmp_path / 'in.bag'), 'w') as bag:
        bag.write('/calibration/rig', RigCalibration())
        image = IrBlobArray()
        image.header.stamp.secs = 10
        bag.write('/camera/ir_blobs', image)
    monkeypatch.setattr(replay, 'track', lambda recorded, mode: [])
    with pytest.raises(Refusal, match='in.bag is too short'):
        replay.evaluate(str(tmp_path / 'in.bag'))


@pytest.mark.parametrize('points, by_two, observed, words', [
    (50, 50, [1.0], ''), (50, 0, [1.0], 'not synchronised'), (50, 0, [], 'exactly one spot'),
    (0, 50, [], 'check that the rig')])
def test_what_a_bag_of_others_lacks(points, by_two, observed, words):
    result = {'instants': 100, 'instants_seen_by_two': by_two, 'points': points,
              'method': 'mean', 'inlier_px': 5.0, 'points_in_tracks': 0,
              'tracks_confirmed': 0, 'tracked_instants_with_an_outlier': 0}
    result['published'] = result['tracks'] = {'all': reprojection.figures(observed)}
    rows = dict(replay.rows_of(result))
    assert words in rows.get('note', '')
    assert ('note' in rows) == bool(words)
    assert rows['all, published'] == (
        'median 1.000, mean 1.000, RMS 1.000, p95 1.000 px, 1 of 1 within 5 px'
        if observed else 'no observation')
