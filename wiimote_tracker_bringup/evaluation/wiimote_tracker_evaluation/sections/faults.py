"""Faults that fault_matrix caused: what was published before, during and after each."""

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import existing_file, read_json
from wiimote_tracker_evaluation.section import Option

TITLE = 'Faults'
SECONDS = 1, 1
OPTION = Option('faults', 'FILE', existing_file, 'what fault_matrix --json wrote', is_needed=True)

TIMES = ('before', 'during', 'after')


def run(run):
    try:
        results = read_json(run.options.faults)
        rows = [row(result) for result in results]
    except (OSError, ValueError, KeyError, TypeError):
        raise Refusal(f'{run.options.faults} is not what fault_matrix --json writes')
    survived = sum(not result['problems'] for result in results)
    run.table('faults', [('fault', '')] + [
        (f'{name}_{time}', unit) for time in TIMES
        for name, unit in (('rate', '1/s'), ('error', 'mm'))
    ] + [('recovery', 's'), ('problems', '')], rows,
        'Points a second and LED, and their median error; during: until all was normal again; '
        'recovery: from the end of the cause until then.', shown=True)
    run.figure('survived', survived, '', len(results), note=f'faults survived, of {len(results)}',
               end_to_end=True)


def row(result):
    figures = []
    for time in TIMES:
        part = result[time] or {'rate': None, 'error': None}
        figures += [part['rate'], None if part['error'] is None else 1e3 * part['error']]
    return [result['what'], *figures, result['recovery'], '; '.join(result['problems']) or 'none']
