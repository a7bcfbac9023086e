"""report.html: a single file with plots as SVG."""

import base64
import html as escaping
import re

from wiimote_tracker_evaluation.page import data, words
from wiimote_tracker_evaluation.page.markdown import TITLE
from wiimote_tracker_evaluation.section import Plot, Table, Text

MOST_INLINE = 200000  # [bytes] of one table
STYLE = '''
:root { --ink: #1c2430; --soft: #5d6878; --line: #d9dee5; --accent: #1f5fa8; --bad: #a4262c; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 60rem; padding: 2.5rem 1.5rem 5rem; color: var(--ink);
  font: 16px/1.55 "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.45rem; margin: 3.2rem 0 .3rem; padding-top: .8rem; border-top: 2px solid var(--ink); }
h3 { font-size: 1.1rem; margin: 1.8rem 0 .4rem; }
p, ul { margin: .6rem 0; max-width: 46rem; }
.about, .kind, figcaption, caption { color: var(--soft); font-size: .88rem; }
.kind { margin: 0 0 .8rem; }
nav a { margin-right: 1rem; white-space: nowrap; }
a { color: var(--accent); text-decoration: none; }
.short { border-left: 4px solid var(--accent); padding: .2rem 0 .2rem 1.1rem; margin: 1.4rem 0; }
.bad { color: var(--bad); }
.failure { border-left: 4px solid var(--bad); padding-left: 1rem; color: var(--bad); }
figure { margin: 1.4rem 0; }
figure svg { display: block; max-width: 100%; height: auto; }
figure svg text { font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif !important; }
figcaption { max-width: 46rem; margin-top: .4rem; }
.scroll { overflow-x: auto; margin: 1.1rem 0; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
caption { caption-side: bottom; text-align: left; padding-top: .4rem; max-width: 46rem; }
th { text-align: left; font-weight: 600; border-bottom: 1.5px solid var(--ink); vertical-align: bottom; }
td { border-bottom: 1px solid var(--line); vertical-align: top; }
th, td { padding: .25rem .9rem .25rem 0; max-width: 24rem; }
.n { text-align: right; }
td.n { white-space: nowrap; }
code { font-size: .9em; background: #f2f4f7; padding: 0 .2em; }
@page { margin: 12mm 14mm; }
@media print { html { font-size: 9px; } body { max-width: none; padding: 0; font-size: 8.6pt; line-height: 1.3; }
  nav, #figures { display: none; } p, ul, figcaption, caption { max-width: none; } td, th { padding: .1rem .5rem .1rem 0; }
  h2, h3 { break-after: avoid; } figure, tr { break-inside: avoid; } figure svg { max-height: 54mm; max-width: 100%; }
  table { font-size: 7.2pt; line-height: 1.2; } a { color: inherit; } }
'''


def page(report):
    parts = ['<!DOCTYPE html><html lang="en"><head><meta charset="utf-8">',
             '<meta name="viewport" content="width=device-width, initial-scale=1">',
             f'<title>{TITLE}</title><style>{STYLE}</style></head><body>',
             f'<h1>{TITLE}</h1>', f'<p class="about">{inline(words.about(report))}</p>',
             '<nav>' + ''.join(f'<a href="#{run.name}">{escaping.escape(run.title)}</a>'
                               for run in report.runs)
             + '<a href="#figures">Every figure</a></nav>', in_short(report)]
    parts += [section(run) for run in report.runs] + [every_figure(report)]
    return '\n'.join(parts + ['</body></html>\n'])


def in_short(report):
    items = [inline(sentence) for run in report.runs for sentence in run.summaries]
    items += [f'<span class="bad">{escaping.escape(run.title)} failed: '
              f'{escaping.escape(run.failure)}</span>'
        for run in report.runs if run.failure]
    return '<div class="short"><ul>%s</ul></div>' % ''.join(
        f'<li>{item}</li>' for item in items) if items else ''


def section(run):
    parts = [f'<section id="{run.name}"><h2>{escaping.escape(run.title)}</h2>',
             f'<p class="kind">{words.kinds(run)}; {words.duration(run.duration)}</p>']
    for each in run.contents:
        if isinstance(each, Text):
            parts.append(blocks(each.markdown))
        elif isinstance(each, Plot):
            parts.append(f'<figure>{inner_svg(run, each)}<figcaption>{inline(each.caption)}</figcaption></figure>')
        elif isinstance(each, Table):
            parts.append(content_table(run, each))
    if run.failure:
        parts.append(f'<p class="failure">This section failed: {escaping.escape(run.failure)}</p>')
    return '\n'.join(parts + ['</section>'])


def every_figure(report):
    return '\n'.join(
        ['<section id="figures"><h2>Every figure</h2>', '<p class="kind">As in figures.json.</p>']
        + [f'<h3>{escaping.escape(run.title)}</h3>{figures_table(run)}'
           for run in report.runs if run.figures] + ['</section>'])


def inner_svg(run, plot):
    """The SVG element alone; ids of several plots in one page must differ."""
    svg = plot.svg[plot.svg.index('<svg'):]
    svg = re.sub(r'<metadata>.*?</metadata>', '', svg, flags=re.S)
    prefix = f'{run.name}-{plot.name}-'
    svg = re.sub(r'\bid="', 'id="' + prefix, svg)
    svg = re.sub(r'(xlink:href="#|url\(#)', r'\g<1>' + prefix, svg)
    return svg.replace('<svg', '<svg role="img" aria-label="%s"' % escaping.escape(
        plot.caption, quote=True), 1)


# --- Tables

def table(heads, rows, caption=''):
    """heads: strings; rows: (text, is a number) cells; all already HTML."""
    numeric = [all(row[i][1] for row in rows) and bool(rows) for i in range(len(heads))]
    align = [' class="n"' if each else '' for each in numeric]
    return '<div class="scroll"><table>%s<thead><tr>%s</tr></thead><tbody>%s</tbody></table></div>' % (
        f'<caption>{caption}</caption>' if caption else '',
        ''.join('<th%s>%s</th>' % each for each in zip(align, heads)),
        ''.join('<tr>%s</tr>' % ''.join(f'<td{align[i]}>{cell[0]}</td>'
                                        for i, cell in enumerate(row)) for row in rows))


def csv_link(run, content):
    """With the data in it, so that the page can be mailed alone; a large table stays a file."""
    name, text = content.name + '.csv', data.csv_text(content).encode()
    if len(text) > MOST_INLINE:
        return f'<a href="{run.name}/{name}">{name}</a>'
    return (f'<a download="{name}" href="data:text/csv;base64,{base64.b64encode(text).decode()}">'
            f'{name}</a>')


def content_table(run, content):
    link = csv_link(run, content)
    if not content.shown:
        return f"<p>{inline(content.caption or words.plain(content.name) + '.')} {len(content.rows)} rows: {link}</p>"
    return table([inline(words.with_unit(name, unit)) for name, unit in content.columns],
                 [[(inline(words.number(cell)), not isinstance(cell, str)) for cell in row]
                  for row in content.rows],
                 inline(content.caption) + ' ' + link)


def figures_table(run):
    numeric = (False, True, True, True, False)
    return table(['', 'value', '95 %', 'samples', ''], [
        list(zip(map(inline, words.cells(figure)), numeric)) for figure in run.figures])


# --- The subset of Markdown that sections use

def blocks(markdown: str) -> str:
    """Paragraphs, headings (###) and lists."""
    parts = []
    for block in re.split(r'\n\s*\n', markdown.strip()):
        lines = block.strip().split('\n')
        if lines[0].startswith('#'):
            parts.append('<h3>%s</h3>' % inline(lines[0].lstrip('# ')))
            lines = lines[1:]
        items = [line for line in lines if line.lstrip().startswith('- ')]
        if items:
            text = re.split(r'(?:^|\n)\s*- ', '\n'.join(lines))
            if text[0].strip():
                parts.append(f'<p>{inline(text[0])}</p>')
            parts.append('<ul>%s</ul>' % ''.join(f'<li>{inline(item)}</li>' for item in text[1:]))
        elif lines:
            parts.append(f"<p>{inline(' '.join(lines))}</p>")
    return '\n'.join(parts)


def inline(text: str) -> str:
    text = escaping.escape(text, quote=False)
    text = re.sub(r'`([^`]+)`', r'<code>\1</code>', text)
    text = re.sub(r'\*\*([^*]+)\*\*', r'<b>\1</b>', text)
    text = re.sub(r'(?<![\w*])\*([^*\s][^*]*)\*(?!\w)', r'<i>\1</i>', text)
    return re.sub(r'\[([^\]]+)\]\(([^)\s]+)\)', r'<a href="\2">\1</a>', text)
