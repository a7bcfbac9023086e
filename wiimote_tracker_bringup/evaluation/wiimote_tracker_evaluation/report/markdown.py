"""report.md: the report as text."""

from wiimote_tracker_evaluation.report import words
from wiimote_tracker_evaluation.section import Plot, Table, Text

TITLE = 'Evaluation of the Wiimote tracker'


def page(report):
    lines, short = ['# ' + TITLE, '', words.about(report)], []
    for run in report.runs:
        short += ['- ' + sentence for sentence in run.summaries]
        if run.failure:
            short.append(f'- **{run.title} failed:** {words.literal(run.failure)}')
    lines += ['', '## In short', ''] + short if short else []
    for run in report.runs:
        lines += section(run)
    lines += ['', '## Every figure', '', 'As in figures.json.']
    for run in report.runs:
        if run.figures:
            lines += ['', '### ' + run.title, '', row(['', 'value', '95 %', 'samples', '']),
                      '|---|--:|--:|--:|---|'] + [row(words.cells(each)) for each in run.figures]
    return '\n'.join(lines) + '\n'


def section(run):
    lines = ['', '## ' + run.title, '', f'{words.kinds(run)}; {words.duration(run.duration)}']
    for each in run.contents:
        lines.append('')
        if isinstance(each, Text):
            lines.append(each.markdown)
        elif isinstance(each, Plot):
            lines += [f'![{each.name}]({run.name}/{each.name}.svg)', '', each.caption]
        elif isinstance(each, Table):
            lines += content_table(run, each)
    if run.failure:
        lines += ['', '**This section failed:** ' + words.literal(run.failure)]
    return lines


def row(cells):
    return '| ' + ' | '.join(words.escaped(cell) for cell in cells) + ' |'


def content_table(run, table):
    link = f'[{table.name}.csv]({run.name}/{table.name}.csv)'
    if not table.shown:
        return [f"{table.caption or words.plain(table.name) + '.'} {len(table.rows)} rows: {link}"]
    signs = ['---' if any(isinstance(cells[i], str) for cells in table.rows) else '--:'
             for i in range(len(table.columns))]
    lines = [row([words.with_unit(name, unit) for name, unit in table.columns]), row(signs)]
    lines += [row([words.number(cell) for cell in cells]) for cells in table.rows]
    return lines + ['', (table.caption + ' ' if table.caption else '') + link]
