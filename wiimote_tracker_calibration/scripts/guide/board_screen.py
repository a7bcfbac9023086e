"""The screen of a lens's calibration with the 16-LED board: from a Guide to lines of text."""

from typing import List, Optional, Tuple

from .guide import Advice, Guide
from .text import bar, duration, figure, fitted, padded, wrapped
from .screen import COLUMNS, ROWS, is_too_small, panel, prompt_lines, too_small

KEYS = ['SPACE next  n start again  u undo  s solve  v save  x cancel  q quit',
        'The board lights its LEDs in turns: see doc/board.md.']


def advice(guide: Guide, camera: str) -> Advice:
    """What to do next."""
    board, following = guide.board, guide.asking['next']
    names = [each.name for each in guide.status.cameras] if guide.status else [camera]
    if camera not in names:
        return Advice(f'There is no camera {camera}: ' + (
            f'name one of {", ".join(names)}' if names else 'start the drivers') + '.')
    if board is None or board.camera != camera:
        return Advice(f'Hold the 16-LED board in front of {camera}. {following} starts.', 'start')
    if guide.has_done('commit', 'undo'):
        return Advice('The next calibration starts with this lens: calibrate the rig now. '
                      f'{guide.asking["quit"]} ends.')
    if guide.has_done('solve', 'undo'):
        return Advice(f'{following} saves the lens and gives it to the driver.', 'commit')
    if board.missing:
        return Advice('Hold the board still for two seconds, then elsewhere: to all sides of the '
                      'image, near and far, tilted by 30 to 45 degrees to all sides.')
    return Advice(f'Enough. {following} solves the lens; more views make it better.', 'solve')


def render(guide: Guide, now: float, camera: str, rows: int = ROWS, columns: int = COLUMNS,
           prompt: Optional[Tuple[str, str]] = None) -> List[str]:
    """Exactly `rows` lines of at most `columns` characters."""
    if is_too_small(rows, columns):
        return too_small(rows, columns)
    board = guide.board if guide.board is not None and guide.board.camera == camera else None
    left = f'LENS OF {camera.upper()}'
    bars = []
    if board is not None:
        left += f'   {board.views} of {board.views_needed} views'
        bars = [f'{name:<5} {bar(share, 40)} {figure(100 * share, 0, 3)} %' for name, share in (
            ('X', board.x), ('Y', board.y), ('Size', board.size), ('Skew', board.skew))]
    lines = [left + duration(now - guide.began).rjust(columns - len(left))]
    lines += padded(wrapped(guide.silent(now) or advice(guide, camera).sentence, columns, 2), 2)
    lines += ['', *bars, '']
    for each in guide.status.cameras if guide.status else []:
        if each.name == camera:
            # The title names the camera; the last two lines are of corners and a wave.
            lines += panel(guide, each)[1:-2]
    said = wrapped(guide.answer or (board.message if board is not None else ''), columns, 3)
    if guide.running:
        said = [guide.running[-1] + ' ...']
    missing = ['- ' + line for text in (board.missing if board is not None else ())
               for line in wrapped(text, columns - 2, 1)]
    lines += padded(missing, rows - len(lines) - len(KEYS) - len(said)) + said
    lines = [fitted(line, columns) for line in lines[:rows - len(KEYS)]]
    return lines + (prompt_lines(prompt, columns) if prompt is not None else KEYS)
