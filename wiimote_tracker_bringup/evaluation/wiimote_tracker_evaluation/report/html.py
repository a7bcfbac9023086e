"""report.html: report.md as a single file, with its plots as SVG and its tables to save."""

import base64
import re
from html import escape

from markdown import Markdown
from markdown.extensions.toc import TocExtension, slugify

from wiimote_tracker_evaluation.report import data, markdown
from wiimote_tracker_evaluation.section import Plot, Table

MOST_INLINE = 200000  # [bytes] of one table
ENDINGS = {Plot: 'svg', Table: 'csv'}
STYLE = '''
:root { --ink: #1c2430; --soft: #5d6878; --line: #d9dee5; --accent: #1f5fa8; --bad: #a4262c; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 2.5rem 1.5rem 5rem; color: var(--ink);
  font: 16px/1.55 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.45rem; margin: 3.2rem 0 .3rem; padding-top: .8rem;
  border-top: 2px solid var(--ink); }
h3 { font-size: 1.1rem; margin: 1.8rem 0 .4rem; }
p, ul { margin: .6rem 0; max-width: 46rem; }
h1 + p, h2 + p, figcaption, .scroll + p { color: var(--soft); font-size: .88rem; }
.toc ul { padding: 0; max-width: none; } .toc li { display: inline; margin-right: 1rem; }
.toc a { white-space: nowrap; }
a { color: var(--accent); text-decoration: none; }
#short + ul { border-left: 4px solid var(--accent); padding: .2rem 0 .2rem 2.1rem;
  margin: 1.4rem 0; }
.bad { color: var(--bad); }
p.bad { border-left: 4px solid var(--bad); padding-left: 1rem; }
figure { margin: 1.4rem 0; }
figure svg { display: block; max-width: 100%; height: auto; }
figure svg text {
  font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif !important; }
figcaption { max-width: 46rem; margin-top: .4rem; }
.scroll { overflow-x: auto; margin: 1.1rem 0; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; border-bottom: 1.5px solid var(--ink);
  vertical-align: bottom; }
td { border-bottom: 1px solid var(--line); vertical-align: top; }
th, td { padding: .25rem .9rem .25rem 0; max-width: 24rem; }
[align=right] { text-align: right; }
td[align=right], td[style*=right] { white-space: nowrap; }
code { font-size: .9em; background: #f2f4f7; padding: 0 .2em; }
@page { margin: 12mm 14mm; }
@media print { html { font-size: 9px; }
  body { max-width: none; padding: 0; font-size: 8.6pt; line-height: 1.3; }
  .toc, #figures, #figures ~ * { display: none; } p, ul, figcaption { max-width: none; }
  td, th { padding: .1rem .5rem .1rem 0; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; }
  figure svg { max-height: 54mm; max-width: 100%; }
  table { font-size: 7.2pt; line-height: 1.2; } a { color: inherit; } }
'''


def page(report):
    names = {'In short': 'short', **{run.title: run.name for run in report.runs},
             'Every figure': 'figures'}
    contents = {f'{run.name}/{each.name}.{ENDINGS[type(each)]}': each for run in report.runs
                for each in run.contents if type(each) in ENDINGS}
    converter = Markdown(extensions=['tables', TocExtension(
        toc_depth='2-2', slugify=lambda title, separator: names.get(title, slugify(
            title, separator)))])
    # Tags are text: errors contain such as <class 'int'>.
    converter.preprocessors.deregister('html_block')
    converter.inlinePatterns.deregister('html')
    text = converter.convert(markdown.page(report))
    text = text.replace('<h2', converter.toc + '<h2', 1)
    text = re.sub(r'<table>.*?</table>', r'<div class="scroll">\g<0></div>', text, flags=re.S)
    text = re.sub(r'<(li|p)>(?=<strong>[^<]* failed:)', r'<\1 class="bad">', text)
    text = re.sub(r'<p><img alt="\w+" src="(\w+/(\w+)\.svg)" /></p>\n<p>(.*?)</p>',
                  lambda plot: f'<figure>{inner_svg(plot[1], contents[plot[1]])}<figcaption>'
                  f'{plot[3]}</figcaption></figure>', text, flags=re.S)
    text = re.sub(r'href="(\w+/(\w+\.csv))"', lambda link: with_data(link, contents[link[1]]), text)
    return ('<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            f'<title>{markdown.TITLE}</title><style>{STYLE}</style></head><body>{text}</body>'
            '</html>\n')


def with_data(link, table):
    """A table's link with its data, for a page that is mailed alone; a large table stays a file."""
    text = data.csv_text(table).encode()
    if len(text) > MOST_INLINE:
        return link.group()
    return f'download="{link[2]}" href="data:text/csv;base64,{base64.b64encode(text).decode()}"'


def inner_svg(path, plot):
    """The SVG element alone; ids of several plots in one page must differ."""
    name = path.replace('/', '-').replace('.svg', '-')
    svg = plot.svg[plot.svg.index('<svg'):]
    svg = re.sub(r'<metadata>.*?</metadata>', '', svg, flags=re.S)
    svg = re.sub(r'\bid="', f'id="{name}', svg)
    svg = re.sub(r'(xlink:href="#|url\(#)', fr'\g<1>{name}', svg)
    return svg.replace('<svg', f'<svg role="img" aria-label="{escape(plot.caption)}"', 1)
