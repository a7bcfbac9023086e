"""The demonstration's results as a table, a sentence, and files."""

import csv

import numpy as np

from wiimote_tracker_bringup import charts, experiment
from wiimote_tracker_bringup.alignment import KINDS
from wiimote_tracker_bringup.files import write_json
from wiimote_tracker_evaluation.demo.scoring import milli


def table(score, bounds, best):
    """best: for this rig, by the kind of alignment [m]."""
    lines = [f"{'':<3}  {'true [m]':<22}  {'measured [m]':<22}  {'error [mm]'}"]
    for place in score['points']:
        lines.append('%-3s  %s  %s  %10.1f' % (
            place['name'], '  '.join(f'{v:6.3f}' for v in place['true_m']),
            '  '.join(f'{v:6.3f}' for v in place['measured_m']), place['error_mm']))
    lines += ['', '%-24s  %8s  %13s  %9s  %s' % (
        'RMS over the points [mm]', 'measured', 'best here (1)', 'bound (2)', '95 % of rigs (2)')]
    for kind in KINDS:
        bound = bounds[kind]
        lines.append('%-24s  %8.1f  %13.1f  %9.1f  %.1f .. %.1f' % (
            '  ' + {'absolute': 'absolute', 'rigid': 'rigid-aligned (3)',
                    'similarity': 'similarity-aligned (3)'}[kind],
            score['position_rms_mm'][kind], 1e3 * best[kind], 1e3 * bound.rms, 1e3 * bound.low,
            1e3 * bound.high))
    lines += ['', f"{'RMS on the circles [mm]':<30}  {'radial':>8}  {'height':>8}"]
    for circle in score['circles']:
        lines.append('  {name:<28}  {radial_rms_mm:8.1f}  {height_rms_mm:8.1f}'.format(**circle))
    lines += ['',
              'scatter of a single point    %.2f mm' % score['point_scatter_mm'],
              'points published             %.0f Hz' % score['rate_hz'],
              'latency report -> point      {p50:.2f} ms median, {p99:.2f} ms p99'.format(
                  **score['latency_ms']),
              'age of a point               %.1f ms median, from exposure to publication' % (
                  score['point_age_ms']['p50']),
              '',
              '(1) Error of the best estimate for this rig, from the square alone, to first order.',
              '(2) Cramer-Rao bound from the square alone, averaged over rigs with corners placed',
              '    to %.0f mm and lenses known to 3 %%, 15 px and 0.02. One rig may differ.'
              % (1e3 * experiment.CORNER_STDDEV),
              '(3) Alignment fitted to points other than the scored ones.']
    return lines


def sentence(mode, score):
    """The results in one sentence. mode: 'tracks' or 'instant'."""
    return ('Simulated rig, mode %s, %d points: RMS error %.1f mm absolute, %.1f mm rigid-aligned, '
            '%.1f mm similarity-aligned; %.0f points/s; latency from report to published point '
            '%.2f ms median, %.2f ms p99.' % (
                (mode, len(score['points']))
                + tuple(score['position_rms_mm'][kind] for kind in KINDS)
                + (score['rate_hz'], score['latency_ms']['p50'], score['latency_ms']['p99'])))


def write_summary(path, mode, score, bounds, best):
    write_json(path, {
        'simulated': True, 'mode': mode, 'position_rms_mm': score['position_rms_mm'],
        'best_for_this_rig_mm': {kind: milli(best[kind]) for kind in KINDS},
        'bound_rms_mm': {kind: milli(bounds[kind].rms) for kind in KINDS},
        'bound_95_percent_mm': {kind: [milli(bounds[kind].low), milli(bounds[kind].high)]
                                for kind in KINDS}, **score})


def write_csv(path, recording, segments):
    """All points published while measuring, with the truth."""
    with open(path, 'w', newline='') as file:
        writer = csv.writer(file)
        writer.writerow(['phase', 'name', 'stamp_s', 'x_m', 'y_m', 'z_m', 'true_x_m', 'true_y_m',
                         'true_z_m', 'stddev_x_m', 'stddev_y_m', 'stddev_z_m', 'rays',
                         'residual_px'])
        for segment in segments:
            inside = np.flatnonzero(recording.between(segment.start, segment.end))
            truth = recording.truth_at(recording.stamp[inside])
            for i, true in zip(inside, truth):
                writer.writerow(
                    [segment.kind, segment.name, f'{recording.stamp[i]:.6f}']
                    + [f'{v:.6f}' for v in recording.position[i]] + [f'{v:.6f}' for v in true]
                    + [f'{v:.6f}' for v in recording.stddev[i]]
                    + ['%d' % recording.rays[i], f'{recording.residual[i]:.3f}'])


def draw_tracks(path, recording, segments, score):
    figure, views = charts.figure(1, 2, height=6.4, width=13.0)
    for axes, (h, v), title in zip(views, ((0, 1), (0, 2)),
                                   ('from above', 'from the side')):
        for number, segment in enumerate(s for s in segments if s.kind == 'circle'):
            inside = recording.between(segment.start, segment.end)
            truth = recording.truth_at(recording.stamp[inside])
            axes.plot(truth[:, h], truth[:, v], color='0.65', linewidth=3.0,
                      label='true' if number == 0 else None)
            axes.plot(recording.position[inside][:, h], recording.position[inside][:, v],
                      color='tab:blue', linewidth=0.8, label='measured' if number == 0 else None)
        for number, place in enumerate(score['points']):
            true, measured = (np.array(place[key])[[h, v]] for key in ('true_m', 'measured_m'))
            axes.plot(*true, 'o', color='0.65', markersize=11)
            axes.plot(*measured, '+', color='tab:red', markersize=10,
                      label='measured point' if number == 0 else None)
            # The error is magnified: a centimetre is not visible at this scale.
            axes.annotate('', xytext=true, xy=true + 25.0 * (measured - true),
                          arrowprops=dict(arrowstyle='->', color='tab:red'))
        side = experiment.SIDE
        axes.plot([0, side, side, 0, 0], [0, 0, side, side, 0], ':', color='0.4', linewidth=1.0)
        limits = -0.45, side + 0.45
        axes.set(aspect='equal', xlim=limits, ylim=limits, xlabel=f"{'xyz'[h]} [m]",
                 ylabel=f"{'xyz'[v]} [m]", title=title)
    views[1].legend(loc='upper center', bbox_to_anchor=(0.5, 0.8))
    figure.suptitle('Simulated rig: ten points and three circles; RMS %.1f mm absolute, %.1f mm '
                    'similarity-aligned; arrows: error x 25' % (
                        score['position_rms_mm']['absolute'],
                        score['position_rms_mm']['similarity']))
    figure.savefig(path, dpi=110)
