"""Numbers and names for readers; the same in all pages."""

import re

PAPER = ('"The paper" is P. Peltola, M. Valtonen and J. Vanhala, A Portable and Low-Cost 3D '
         'Tracking System Using Four-Point Planar Square Calibration, IPIN 2012, doi '
         '10.1109/IPIN.2012.6418918.')


def number(value, digits: int = 3) -> str:
    """A number with significant digits; strings unchanged, empty for None."""
    if value is None:
        return ''
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    value = float(value)
    if value != value:
        return '–'
    if abs(value) < 1e6 and value == int(value):
        return '%d' % value
    text = '%.*g' % (digits, value)
    if 'e' not in text:
        return text
    return f'{value:.0f}' if 1e3 <= abs(value) < 1e7 else text


def plain(name: str) -> str:
    return name.replace('_', ' ')


def with_unit(name: str, unit: str) -> str:
    return f'{plain(name)} [{unit}]' if unit else plain(name)


def literal(text: str) -> str:
    """Text such as that of an error, as code: none of its signs is markup."""
    marks = '``' if '`' in text else '`'
    return f'{marks}{" ".join(text.split())}{marks}'


def escaped(text: str) -> str:
    """Text such as a name that a person gave, of a line: none of its signs is markup."""
    text = re.sub(r'[\\`*|]|(?<!\w)_|_(?!\w)|\](?=[(\[])', r'\\\g<0>', ' '.join(text.split()))
    return text.replace('&', '&amp;').replace('<', '&lt;')


def kind(simulated: bool, end_to_end: bool) -> str:
    if not simulated:
        return 'measured'
    return 'simulated, full stack' if end_to_end else 'simulated, in process'


def cells(figure):
    """Description, value with unit, interval (empty: none), number of samples, and origin."""
    return [figure.note or plain(figure.name), f'{number(figure.value)} {figure.unit}'.strip(),
            '' if figure.interval is None else ' … '.join(map(number, figure.interval)),
            str(figure.samples), kind(figure.simulated, figure.end_to_end)]


def kinds(run):
    found = sorted({kind(figure.simulated, figure.end_to_end) for figure in run.figures})
    return '; '.join(found) if found else ('simulated' if run.simulated else 'measured')


def duration(seconds: float) -> str:
    return f'{seconds:.0f} s' if seconds < 100 else f'{seconds / 60.0:.0f} min'


def about(report):
    """What was run, when, and which paper it is compared with."""
    if report.live:
        how = ('Rehearsed on a simulated rig, with prompts' if report.simulated else
               'Measured on a real rig')
    elif not report.simulated:
        how = 'Measured on recordings by others'
    else:
        how = f'Simulated, rig {literal(report.rig)}'
    return '%s, seed %d, %s of %s with version %s; took %s. %s' % (
        how, report.seed, 'quick run' if report.quick else 'full run',
        report.date, report.version, duration(report.seconds), PAPER)
