"""Figures, tables and plots as files for other programs."""

import csv
import dataclasses
import io
import json

import numpy as np

from wiimote_tracker_evaluation.section import Plot, Table

FORMAT = 1  # of figures.json


def figures_json(report):
    return json.dumps({
        'format': FORMAT, 'quick': report.quick, 'seed': report.seed,
        'rig': report.rig, 'simulated': report.simulated,
        'failed': [run.name for run in report.runs if run.failure],
        'figures': [dict(dataclasses.asdict(figure), section=run.name, seed=run.seed)
                    for run in report.runs for figure in run.figures],
    }, indent=1, ensure_ascii=False) + '\n'


def write_section(run):
    """CSV of every table, SVG of every plot, and one MATLAB file."""
    for each in run.contents:
        if isinstance(each, Table):
            with open(run.file(each.name + '.csv'), 'w', newline='', encoding='utf-8') as file:
                file.write(csv_text(each))
        elif isinstance(each, Plot):
            with open(run.file(each.name + '.svg'), 'w', encoding='utf-8') as file:
                file.write(each.svg)
    write_matlab(run.file(run.name + '.mat'), run)


def csv_text(table):
    """The first line has the names with units, such as `error_mm`."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator='\n')
    writer.writerow([name + ('_' + word(unit) if unit else '') for name, unit in table.columns])
    writer.writerows(table.rows)
    return text.getvalue()


def word(unit):
    """A unit as part of a name."""
    text = unit.replace('%', 'percent').replace('/', '_per_').replace('°', 'deg')
    text = text.replace('µ', 'u').replace('²', '2').replace('³', '3')
    return ''.join(letter if letter.isalnum() and letter.isascii() else '_' for letter in text)


def column(values):
    """A table's column for MATLAB: numbers (NaN if missing), or strings."""
    if any(isinstance(value, str) for value in values):
        return np.array(['' if value is None else str(value) for value in values], dtype=object)
    return np.array([np.nan if value is None else float(value) for value in values]).reshape(-1, 1)


def write_matlab(path, run):
    """One struct with the section's name: figures.<name>, and a struct of columns per table."""
    import scipy.io
    content = {'title': run.title, 'seed': float(run.seed), 'simulated': run.simulated,
               'quick': run.quick, 'failure': run.failure}
    content['figures'] = {figure.name: dict(
        dataclasses.asdict(figure), samples=float(figure.samples),
        interval=np.array(figure.interval or (np.nan, np.nan))) for figure in run.figures}
    for table in run.contents:
        if isinstance(table, Table):
            columns = zip(*table.rows) if table.rows else [()] * len(table.columns)
            content['table_' + table.name] = {
                name: column(values) for (name, _), values in zip(table.columns, columns)}
    scipy.io.savemat(path, {run.name: content}, long_field_names=True, do_compression=True)
