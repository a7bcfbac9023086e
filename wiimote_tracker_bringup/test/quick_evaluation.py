"""A quick evaluation of some sections, and what holds for every section."""

import csv
import json
import os
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np

HERE = os.path.dirname(os.path.realpath(__file__))
EVALUATION = os.path.join(HERE, '..', 'evaluation')
PAPER_RIG = os.path.join(HERE, '..', 'simulation', 'paper_rig.yaml')
SEED = 3
LIMIT = 3600.0  # only ends a run that hangs; on a slow computer ten minutes are usual [s]
# Sections that start nodes and measure times, and those that only compute.
TIMED = ('latency', 'cost')
COMPUTED = ('distance', 'identification', 'positions', 'circles', 'ours')


class Results:
    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, 'figures.json'), encoding='utf-8') as file:
            self.content = json.load(file)

    def figure(self, section, name):
        found = [each for each in self.content['figures']
                 if (each['section'], each['name']) == (section, name)]
        assert len(found) == 1, f'{name} of {section} is there {len(found)} times'
        return found[0]

    def value(self, section, name):
        return self.figure(section, name)['value']

    def table(self, section, name):
        """Rows of a table, as dictionaries of strings."""
        with open(os.path.join(self.folder, section, name + '.csv'), newline='') as file:
            return list(csv.DictReader(file))

    def columns(self, section, name):
        """A table as arrays by name: strings, or numbers with NaN in empty cells."""
        rows, columns = self.table(section, name), {}
        for name in rows[0]:
            cells = [row[name] for row in rows]
            try:
                columns[name] = np.array([float(cell or 'nan') for cell in cells])
            except ValueError:
                columns[name] = np.array(cells)
        return columns


def evaluate(names, folder):
    """Runs these sections; all files lie in the folder."""
    done = subprocess.run(
        [sys.executable, os.path.join(EVALUATION, 'evaluate'), '--quick', '--seed', str(SEED),
         '--sections', ','.join(names), '--rig', PAPER_RIG, '--output', folder],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LIMIT)
    assert done.returncode == 0, done.stdout
    return Results(folder)


def column(rows, name):
    return np.array([float(row[name]) for row in rows])


def check(results, names):
    """What holds for these sections, of which the results are."""
    every_section_has_figures_and_plots(results, names)
    everything_is_marked_as_simulated(results)
    intervals_lie_at_their_values(results)


def every_section_has_figures_and_plots(results, names):
    assert results.content['failed'] == []
    assert {each['section'] for each in results.content['figures']} == set(names)
    for name in names:
        files = os.listdir(os.path.join(results.folder, name))
        assert name + '.mat' in files
        drawings = [each for each in files if each.endswith('.svg')]
        assert drawings
        for drawing in drawings:
            root = xml.etree.ElementTree.parse(
                os.path.join(results.folder, name, drawing)).getroot()
            texts = [text for each in root.iter('{http://www.w3.org/2000/svg}text')
                     for text in each.itertext()]
            assert texts, f'{drawing} has no text'


def everything_is_marked_as_simulated(results):
    assert results.content['simulated'] is True
    assert all(each['simulated'] and each['seed'] == SEED for each in results.content['figures'])
    page = open(os.path.join(results.folder, 'report.md'), encoding='utf-8').read()
    assert 'Simulated, rig `paper_rig.yaml`, seed %d, quick run' % SEED in page


def intervals_lie_at_their_values(results):
    """By chance a resampled interval may lie beside its value; if far, its unit is another."""
    for each in results.content['figures']:
        if each['interval'] is not None:
            low, high = each['interval']
            assert low <= high, each
            beside = high - low + 1e-9 * abs(high)
            assert low - beside <= each['value'] <= high + beside, each
            assert each['samples'] >= 2, each
