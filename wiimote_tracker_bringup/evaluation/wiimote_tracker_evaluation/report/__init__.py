"""Output of the evaluation: report.html, report.md, figures.json, and a folder of tables and plots
for each section."""

import os
import time

from wiimote_tracker_bringup import programs
from wiimote_tracker_evaluation.report import data, html, markdown


class Report:
    """Contents of all pages. command: the options of the run; seconds: its duration."""

    def __init__(self, options, runs, seconds):
        self.rig = 'the running one' if options.live else os.path.basename(options.rig)
        self.quick, self.live, self.seed = options.quick, options.live, options.seed
        self.runs = runs
        # --live can be rehearsed on virtual remotes.
        self.simulated = any(run.simulated for run in runs)
        self.version = programs.version()
        self.seconds, self.date = seconds, time.strftime('%Y-%m-%d')


def write_report(options, runs, seconds):
    """Writes the files of the latest section, and the pages of all sections so far."""
    report = Report(options, runs, seconds)
    data.write_section(runs[-1])
    write(os.path.join(options.output, 'figures.json'), data.figures_json(report))
    write(os.path.join(options.output, 'report.md'), markdown.page(report))
    write(os.path.join(options.output, 'report.html'), html.page(report))


def write(path, text):
    """Writes a file atomically."""
    with open(path + '.part', 'w', encoding='utf-8') as file:
        file.write(text)
    os.replace(path + '.part', path)
