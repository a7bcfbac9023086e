"""The screen of a lens's calibration with the 16-LED board: from a Guide to lines of text."""

from .guide import Advice
from .layout import bar, duration, figure, fitted, wrapped
from .screen import COLUMNS, ROWS, padded, panel, prompt_lines

KEYS = ['SPACE next  n start again  u undo  s solve  v save  x cancel  q quit',
        'The board lights its LEDs in turns: see doc/board.md.']


def advice(guide, camera):
    """What to do next."""
    board = guide.board
    if board is None or board.camera != camera:
        return Advice('Hold the 16-LED board in front of %s. SPACE starts.' % camera, 'start')
    if guide.has_done('commit'):
        return Advice('The lens is in use. Calibrate the rig now. q ends.')
    if guide.has_done('solve'):
        return Advice('SPACE saves the lens and gives it to the driver.', 'commit')
    if board.missing:
        return Advice('Hold the board still for two seconds, then elsewhere: to all sides of the '
                      'image, near and far, tilted by 30 to 45 degrees to all sides.')
    return Advice('Enough. SPACE solves the lens; more views make it better.', 'solve')


def render(guide, now, camera, rows=ROWS, columns=COLUMNS, prompt=None):
    """Exactly `rows` lines of at most `columns` characters."""
    board = guide.board if guide.board is not None and guide.board.camera == camera else None
    left = 'LENS OF %s' % camera.upper()
    if board is not None:
        left += '   %d of %d views' % (board.views, board.views_needed)
    right = duration(now - guide.began)
    lines = [left + right.rjust(columns - len(left))]
    lines += padded(wrapped(guide.silent(now) or advice(guide, camera).sentence, columns, 2), 2)
    lines += [''] + [
        '%-5s %s %s' % (name, bar(share, 40), figure(100 * share, '%3.0f %%'))
        for name, share in ((('X', board.x), ('Y', board.y), ('Size', board.size),
                             ('Skew', board.skew)) if board is not None else ())]
    lines += ['']
    seen = [c for c in guide.status.cameras if c.name == camera] if guide.status else []
    if seen:
        lines += panel(seen[0], [])[1:-2]
    elif guide.status:
        lines.append('There is no camera %s; there are: %s'
                     % (camera, ', '.join(c.name for c in guide.status.cameras) or 'none'))
    said = wrapped(guide.answer or (board.message if board is not None else ''), columns, 3)
    if guide.running:
        said = [guide.running[-1] + ' ...']
    room = rows - len(lines) - len(KEYS) - len(said)
    missing = ['- ' + line for text in (board.missing if board is not None else ())
               for line in wrapped(text, columns - 2, 1)]
    lines += padded(missing, room) + said
    lines += prompt_lines(prompt, columns) if prompt is not None else KEYS
    return [fitted(line, columns) for line in lines[:rows]]
