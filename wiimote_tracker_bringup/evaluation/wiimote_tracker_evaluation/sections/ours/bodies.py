"""Poses of rigid bodies: rows of the tracker's benchmark."""

from wiimote_tracker_bringup.files import read_json

PROGRAM = 'wiimote_tracker_triangulation/benchmark_bodies'
QUICK, FULL = 1, 20  # runs of 10 s
SECTIONS = 'accuracy', 'hidden'
# Of the table: name, unit, key of the benchmark.
COLUMNS = (('position', 'mm', 'position mm'), ('over_bound', '', '/ bound'),
           ('rotation', 'deg', 'rotation deg'), ('rotation_over_bound', '', '/ bound '),
           ('with_a_pose', '%', 'known %'), ('of_these_right', '%', 'right %'))


def file(run, section):
    return run.file(f'bodies_{section}.json')


def commands(run):
    return [[PROGRAM, '--section', section, '--runs', QUICK if run.quick else FULL, '--seed',
             run.seed, '--json', file(run, section)] for section in SECTIONS]


def tell(run):
    rows = {}
    for section in SECTIONS:
        rows.update((row['name'], row) for row in read_json(file(run, section))[section])
    run.say(
        '### Body poses\n\n'
        'Bodies of 10 cm radius, with three or four LEDs, before the cameras of Fig. 1; pixels '
        'have 0.5 px of noise. The pose is tracked directly by the pixels. RMS errors, beside the '
        'Cramér-Rao bound of one image by each camera; the share of the time with a pose, and of '
        'these the share within 20°.')
    run.table('bodies', [('setting', '')] + [(name, unit) for name, unit, _ in COLUMNS],
              [[name] + [row[key] for _, _, key in COLUMNS] for name, row in rows.items()])
    for count in (2, 4):
        row = rows[f'four_leds, {count} cameras, hand-held']
        for name, unit, key in (COLUMNS[0], COLUMNS[2]):
            run.figure(f'body_{name}_{count}_cameras', row[key], unit,
                       QUICK if run.quick else FULL, None,
                       f'RMS error of the {name} of a hand-held body, {count} cameras')
