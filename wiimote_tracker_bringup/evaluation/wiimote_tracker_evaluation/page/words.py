"""Numbers and names as people read them; the same in every page."""


def number(value, digits=3):
    """A number with so many significant digits; texts as they are, nothing for None."""
    if value is None:
        return ''
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    value = float(value)
    if value != value:
        return '–'
    if value == int(value) and abs(value) < 1e6:
        return '%d' % value
    text = '%.*g' % (digits, value)
    if 'e' not in text:
        return text
    return '%.0f' % value if 1e3 <= abs(value) < 1e7 else text


def plain(name):
    """An under_scored name in words."""
    return name.replace('_', ' ')


def with_unit(name, unit):
    return '%s [%s]' % (plain(name), unit) if unit else plain(name)


def interval(figure):
    if figure.interval is None:
        return ''
    return '%s … %s' % tuple(number(limit) for limit in figure.interval)


def kind(simulated, end_to_end):
    """How a number came about."""
    if not simulated:
        return 'measured'
    return 'simulated, full stack' if end_to_end else 'simulated, in process'


def kinds(run):
    """How the numbers of a section came about."""
    found = sorted({kind(figure.simulated, figure.end_to_end) for figure in run.figures})
    return '; '.join(found) if found else ('simulated' if run.simulated else 'measured')


def duration(seconds):
    return '%.0f s' % seconds if seconds < 100 else '%.0f min' % (seconds / 60.0)


def about(report):
    """One line about the whole run."""
    if report.live:
        how = ('Rehearsed on a simulated rig, with prompts' if report.simulated else
               'Measured on a real rig')
    else:
        how = 'Simulated, rig `%s`' % report.rig
    return '%s, seed %d, %s; took %s.' % (
        how, report.seed,
        'quick run' if report.quick else 'full run', duration(report.seconds))
