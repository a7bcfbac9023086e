"""report.html: report.md as a single file, with its plots as SVG and its tables to save."""

import base64
import html as escaping
import re

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
nav a { margin-right: 1rem; white-space: nowrap; }
a { color: var(--accent); text-decoration: none; }
#short ul { border-left: 4px solid var(--accent); padding: .2rem 0 .2rem 2.1rem; margin: 1.4rem 0; }
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
.n { text-align: right; }
td.n { white-space: nowrap; }
code { font-size: .9em; background: #f2f4f7; padding: 0 .2em; }
@page { margin: 12mm 14mm; }
@media print { html { font-size: 9px; }
  body { max-width: none; padding: 0; font-size: 8.6pt; line-height: 1.3; }
  nav, #figures { display: none; } p, ul, figcaption { max-width: none; }
  td, th { padding: .1rem .5rem .1rem 0; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; }
  figure svg { max-height: 54mm; max-width: 100%; }
  table { font-size: 7.2pt; line-height: 1.2; } a { color: inherit; } }
'''


def page(report):
    head, *parts = markdown.page(report).split('\n## ')
    contents = {f'{run.name}/{each.name}.{ENDINGS[type(each)]}': each for run in report.runs
                for each in run.contents if type(each) in ENDINGS}
    names = {'In short': 'short', **{run.title: run.name for run in report.runs},
             'Every figure': 'figures'}
    sections = ['<section id="%s">%s</section>' % (
        names[part.split('\n', 1)[0]], blocks('## ' + part, contents)) for part in parts]
    links = [f'<a href="#{name}">{escaping.escape(title)}</a>' for title, name in names.items()
             if name != 'short']
    return '\n'.join([
        '<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f'<title>{markdown.TITLE}</title><style>{STYLE}</style></head><body>',
        blocks(head, contents), f'<nav>{"".join(links)}</nav>',
        re.sub(r'href="(\w+/(\w+\.csv))"', lambda link: with_data(link, contents[link[1]]),
               '\n'.join(sections)), '</body></html>\n'])


def with_data(link, table):
    """A table's link with its data, for a page that is mailed alone; a large table stays a file."""
    text = data.csv_text(table).encode()
    if len(text) > MOST_INLINE:
        return link.group()
    return f'download="{link[2]}" href="data:text/csv;base64,{base64.b64encode(text).decode()}"'


def inner_svg(name, plot):
    """The SVG element alone; ids of several plots in one page must differ."""
    svg = plot.svg[plot.svg.index('<svg'):]
    svg = re.sub(r'<metadata>.*?</metadata>', '', svg, flags=re.S)
    svg = re.sub(r'\bid="', f'id="{name}-', svg)
    svg = re.sub(r'(xlink:href="#|url\(#)', fr'\g<1>{name}-', svg)
    return svg.replace('<svg', '<svg role="img" aria-label="%s"' % escaping.escape(
        plot.caption, quote=True), 1)


# --- The subset of Markdown that report.md uses

def blocks(text: str, contents) -> str:
    """Paragraphs, headings, lists, tables, and plots, whose captions are the next blocks."""
    parts, rest = [], iter(re.split(r'\n\s*\n', text.strip()))
    for block in rest:
        lines = block.strip().split('\n')
        plot = re.match(r'!\[\w+\]\((\w+/\w+)\.svg\)', block)
        if plot:
            parts.append('<figure>%s%s</figure>' % (
                inner_svg(plot[1].replace('/', '-'), contents[plot[1] + '.svg']),
                element('figcaption', next(rest))))
            continue
        if lines[0].startswith('|'):
            parts.append(table(lines))
            continue
        level = re.match('#*', lines[0]).end()
        if level:
            parts.append(element(f'h{level}', lines.pop(0)[level + 1:]))
        before, *items = re.split(r'(?:^|\n)\s*- ', '\n'.join(lines))
        if before.strip():
            parts.append(element('p', before))
        if items:
            parts.append('<ul>%s</ul>' % ''.join(element('li', item) for item in items))
    return '\n'.join(parts)


def table(lines):
    heads, signs, *rows = ([cell.strip().replace('\\|', '|')
                            for cell in re.split(r'(?<!\\)\|', line)[1:-1]] for line in lines)
    classes = [' class="n"' if sign.endswith(':') else '' for sign in signs]

    def row(tag, cells):
        return '<tr>%s</tr>' % ''.join(f'<{tag}{its}>{inline(cell)}</{tag}>'
                                       for its, cell in zip(classes, cells))
    return (f'<div class="scroll"><table><thead>{row("th", heads)}</thead><tbody>'
            + ''.join(row('td', cells) for cells in rows) + '</tbody></table></div>')


def element(tag, text):
    sign = ' class="bad"' if 'failed:**' in text else ''
    return f'<{tag}{sign}>{inline(text)}</{tag}>'


def inline(text: str) -> str:
    text = escaping.escape(text, quote=False)
    text = re.sub(r'`([^`]+)`', r'<code>\1</code>', text)
    text = re.sub(r'\*\*([^*]+)\*\*', r'<b>\1</b>', text)
    text = re.sub(r'(?<![\w*])\*([^*\s][^*]*)\*(?!\w)', r'<i>\1</i>', text)
    return re.sub(r'\[([^\]]+)\]\(([^)\s]+)\)', r'<a href="\2">\1</a>', text)
