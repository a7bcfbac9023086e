"""The sections of the quick evaluation that only compute: errors are compared with bounds of Cramér
and Rao that are computed here."""

import numpy as np
import pytest

from point_bounds import ring_bounds
from quick_evaluation import COMPUTED, PAPER_RIG, TIMED, check, evaluate

from wiimote_tracker_bringup import bound, experiment, scene, statistics
from wiimote_tracker_evaluation import sections

SIGMAS = 4.0


@pytest.fixture(scope='module')
def results(tmp_path_factory):
    return evaluate(COMPUTED, str(tmp_path_factory.mktemp('evaluation')))


def test_every_section_is_run_by_a_test():
    need_files = {'recordings', 'faults'}
    assert set(sections.NAMES) - need_files == set(TIMED + COMPUTED)


def test_every_section_is_complete(results):
    check(results, COMPUTED)


def paper_scene(cameras):
    rig = scene.read_scene(PAPER_RIG)
    return scene.Scene(rig.cameras[:cameras], rig.pixel_noise)


def sums_by_session(results, cameras, method, model='calibrated'):
    """Squared errors of the ten points from where the LED was, and the traces of the
    covariances."""
    rows = [row for row in results.table('positions', 'points')
            if (row['cameras'], row['method'], row['ray_model']) == (cameras, method, model)]

    def triple(name):
        return np.array([[float(row[f'{name}_{axis}_m'] or 'nan') for axis in 'xyz']
                         for row in rows])
    squared = ((triple('measured') - triple('true')) ** 2).sum(axis=1)
    traces = sum(np.array([float(row[f'var_{axes}_m_2'] or 'nan') for row in rows])
                 for axes in ('xx', 'yy', 'zz'))
    return squared.reshape(-1, 10).sum(axis=1), traces.reshape(-1, 10).sum(axis=1)


@pytest.mark.parametrize('cameras', ['1 2', '1 2 3 4'])
def test_our_calibrations_reach_their_bounds_and_the_papers_first_does_not(results, cameras):
    for method in ('square', 'wave', 'wand'):
        squared, _ = sums_by_session(results, cameras, method)
        _, least = sums_by_session(results, cameras, 'bound_' + method)
        # A sum of squares of Gaussian errors with covariance S has the variance 2 tr(S^2), at most
        # 2 tr(S)^2: three standard deviations of the mean over the sessions.
        by_chance = 3.0 * np.sqrt(2.0 / len(squared))
        assert squared.mean() < (1.0 + by_chance) * least.mean(), method
        first, _ = sums_by_session(results, cameras, 'C1', 'image_center')
        assert first.mean() > (1.0 + by_chance) * least.mean(), method


def test_with_two_cameras_the_correction_repairs_rays_from_the_image_centre(results):
    before, _ = sums_by_session(results, '1 2', 'C1', 'image_center')
    after, _ = sums_by_session(results, '1 2', 'C3', 'image_center')
    assert (after < before / 4.0).all()


@pytest.mark.parametrize('cameras, number', [('1 2', 2), ('1 2 3 4', 4)])
def test_the_bound_agrees_with_another_implementation(results, cameras, number):
    """bound.py has its own camera model and derivatives; the description's rig is another draw."""
    _, least = sums_by_session(results, cameras, 'bound_square')
    drawn = np.sqrt(least / 10.0)
    rig = paper_scene(number)
    corner_pixel = 0.2  # as in the sessions [px]
    other = bound.position_bounds(
        rig, experiment.CORNERS, experiment.TEST_POINTS, experiment.alignment_points(1),
        (rig.effective_noise() / corner_pixel) ** 2, 100, 100,
        bound.Knowledge(focal_ratio=0.005))['absolute'].rms
    assert abs(other - drawn.mean()) < 4.0 * drawn.std(ddof=1)


def test_tracks_are_better_than_the_bound_of_single_images(results):
    """Exactly known cameras, slow circles: radial and height error, compared with the bound for one
    image of each camera."""
    rig = paper_scene(4)
    least = []
    for center in experiment.CIRCLE_CENTERS:
        for angle in np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False):
            outwards = np.array([np.cos(angle), np.sin(angle), 0.0])
            point = center + experiment.CIRCLE_RADIUS * outwards
            by_point = np.concatenate([bound.point_derivative(camera, point)
                                       for camera in rig.cameras])
            covariance = rig.effective_noise() ** 2 * np.linalg.inv(by_point.T @ by_point)
            least.append(outwards @ covariance @ outwards + covariance[2, 2])
    measured = sum(results.value('circles', f'four_exact_tracks_{which}_0_5') ** 2
                   for which in ('radial', 'height'))
    square_millimetres = 1e6  # in a square metre
    assert 0.0 < measured < square_millimetres * np.mean(least)


def test_single_points_reach_the_bound_and_the_papers_mean_does_not(results):
    table = results.columns('ours', 'cameras')
    counts = (2, 4, 8)
    bounds = dict(zip(counts, ring_bounds(PAPER_RIG, table, counts)))
    for count, least in bounds.items():
        errors = table['error_mm'][(table['cameras'] == count) & (table['method'] == 'most_likely')]
        assert np.isfinite(errors).all(), 'a point was not measured'
        # A mean of squares of about three normal coordinates each; rounding is not quite normal
        # noise.
        spread = np.sqrt(2.0 / len(errors)) * least ** 2
        assert abs(np.mean(errors ** 2) - least ** 2) < SIGMAS * spread
    four = table['cameras'] == 4
    mean = statistics.rms(table['error_mm'][four & (table['method'] == 'mean_closest')])
    assert mean > 1.2 * bounds[4]


def test_tracks_continue_where_fewer_than_two_cameras_see(results):
    table = results.columns('ours', 'occlusion')
    instants, tracks = table['method'] == 'instants', table['method'] == 'tracks'
    assert instants.any()
    # Each time that they end they cover 25 ms more; in 10 s there are at most about 20 ends.
    assert (table['covered_share'][instants] <= table['two_views_share'][instants] + 0.06).all()
    hidden = (table['hidden_share'] >= 0.3) & (table['cameras'] == 4)
    assert (table['covered_share'][tracks & hidden].mean()
            > table['two_views_share'][tracks & hidden].mean())
    # With fewer than two cameras distances are extrapolated; such points are not marked as tracked.
    tracked = table['method'] == 'tracked'
    hidden = (table['hidden_share'] >= 0.3) & (table['cameras'] == 2)
    assert table['astray_share'][tracked].max() < 0.01
    assert table['astray_share'][tracks & hidden].mean() > 0.05


def test_cameras_on_their_own_clocks_need_estimated_times(results):
    by_arrival, estimated = (results.value('circles', f'exact_{name}_whole')
                             for name in ('arrivals', 'tracks'))
    # The jitter of arrivals, 2.4 ms, is 2.4 mm per m/s in each camera. The mean of four cameras and
    # of a few images of each reduces it. Noise of the pixels is in both.
    assert by_arrival > 0.5 * 2.4 * 2.0
    assert estimated < 0.65 * by_arrival
