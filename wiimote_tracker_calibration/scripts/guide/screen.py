"""The screen of the rig's calibration: from a Guide to lines of text."""

import math
from typing import Dict, List, Optional, Sequence, Tuple

from .guide import Guide
from .text import bar, duration, figure, fitted, in_columns, padded, wrapped

ROWS, COLUMNS = 24, 80          # the smallest window
CELL_ROWS, CELL_COLUMNS = 6, 8  # as CalibrationCameraStatus.image_cells
CELL = 2                        # columns of a cell in the smallest window; half as many rows
GAP = 2                         # columns between two cameras
KEYS = ['SPACE next  m masks  k connection  n new  t take corner  u undo  h hands-free',
        'w wave  s solve  v save  c check  i verdict  TAB cameras  ? all keys  q quit']
VERDICT_ROW = '{:<14} {:>5} {:>5} {:>5}  {:>6} {:>6} {:>6} {:>6} {:>6} {:>6}'

Prompt = Optional[Tuple[str, str]]


def steps(status) -> dict:
    """Name of each step."""
    return {status.IDLE: 'not started', status.READY: 'corners', status.CAPTURING: 'capturing',
            status.WAVING: 'waving', status.COMPLETE: 'complete', status.SOLVING: 'solving',
            status.SOLVED: 'solved', status.SAVED: 'saved', status.MASKING: 'learning masks',
            status.MEASURING: 'measuring'}


def render(guide: Guide, now: float, view: str = 'cameras', page: int = 0, rows: int = ROWS,
           columns: int = COLUMNS, prompt: Prompt = None, command_list: Sequence = ()
           ) -> List[str]:
    """Exactly `rows` lines of at most `columns` characters. view: 'cameras', 'verdict', 'trace' or
    'keys'. prompt: a question with what was typed so far, in the place of the keys."""
    if is_too_small(rows, columns):
        return too_small(rows, columns)
    lines = [title(guide, now, columns)]
    lines += padded(wrapped(guide.silent(now) or guide.advice().sentence, columns, 2), 2)
    room = rows - len(lines) - len(KEYS)
    shown = guide.verdict.text if guide.verdict else ''
    said = (saying(guide, columns, room // 2, '...', shown) if view == 'verdict' else
            saying(guide, columns, 3 + (rows - ROWS) // 2, '... (i: more)'))
    if view == 'keys':
        lines += padded(key_lines(command_list, room), room)
    elif view == 'verdict':
        lines += part(verdict_lines(guide, columns), page, room - len(said)) + said
    elif view == 'trace':
        lines += part(trace_lines(guide.trace), page, room - len(said)) + said
    else:
        lines += camera_lines(guide, page, room - len(said), rows, columns) + said
    lines = [fitted(line, columns) for line in lines]
    return lines + (prompt_lines(prompt, columns) if prompt is not None else KEYS)


def is_too_small(rows: int, columns: int) -> bool:
    return rows < ROWS or columns < COLUMNS


def too_small(rows: int, columns: int) -> List[str]:
    """What is drawn in such a window."""
    lines = wrapped(f'Make this window at least {COLUMNS} x {ROWS}; it is {columns} x {rows} now. '
                    'Or use --plain.', max(columns, 10), max(rows, 1))
    return [fitted(line, columns) for line in padded(lines, rows)]


def prompt_lines(prompt: Tuple[str, str], columns: int) -> List[str]:
    question, typed = prompt
    room = columns - 4 if typed.isascii() else (columns - 4) // 2  # some letters are twice as wide
    return [fitted(question, columns), '> ' + typed[-room:]]


def part(lines: List[str], page: int, room: int) -> List[str]:
    """Exactly `room` lines; if there are more, those of a page, and which they are."""
    if len(lines) <= room:
        return padded(lines, room)
    first = page % -(-len(lines) // (room - 1)) * (room - 1)
    last = min(first + room - 1, len(lines))
    return padded(lines[first:last], room - 1) + [
        f'lines {first + 1} to {last} of {len(lines)}; TAB shows others']


def title(guide: Guide, now: float, columns: int) -> str:
    status = guide.status
    left = 'CALIBRATION'
    right = duration(guide.elapsed(now))
    if status is not None:
        left += f'  {steps(status).get(status.step, "?"):<14} {bar(status.progress, 16)}'
        if status.corners_needed:
            left += f'  corners {status.corners_captured}/{status.corners_needed}'
        if status.rig_id:
            right = f'rig {status.rig_id[:8]}  {right}'
    return left + right.rjust(columns - len(left))


def saying(guide: Guide, columns: int, most: int, cut: str, shown: str = '') -> List[str]:
    """The node's answer or message unless it is shown already, or how far it is; at most so many
    lines, at the end of which `cut` stands for more."""
    if guide.running:
        text = guide.feedback or guide.running[-1] + ' ...'
        if guide.progress > 0.0:
            text = f'{bar(guide.progress, 20)} {text}'
        return wrapped(text, columns, most)
    text = guide.said()
    return wrapped(text, columns, most, cut) if text != shown else []


# --- Cameras

def camera_lines(guide: Guide, page: int, room: int, rows: int, columns: int) -> List[str]:
    """The cameras, and the problems."""
    if guide.status is None:
        return [''] * room
    lines = panels(guide, page, rows, columns) + ['']
    return lines + padded(remarks(guide.status, columns, room - len(lines)), room - len(lines))


def panel_width(cell: int) -> int:
    """Of a camera's picture with its border and the gap [columns]."""
    return CELL_COLUMNS * cell + 2 + GAP


def cell_width(cameras: int, rows: int, columns: int) -> int:
    """The widest cell [columns] with which so many cameras fit side by side; half of the rows that
    a window has beyond the smallest one are for larger pictures."""
    widest = (columns // cameras - 2 - GAP) // CELL_COLUMNS
    highest = CELL + (rows - ROWS) // CELL_ROWS
    return max(min(widest, highest), CELL)


def panels(guide: Guide, page: int, rows: int, columns: int) -> List[str]:
    """As many cameras side by side as fit."""
    cameras = guide.status.cameras
    if not cameras:
        return ['No camera is there yet: start the drivers.']
    shown = max(columns // panel_width(CELL), 1)
    pages = (len(cameras) + shown - 1) // shown
    first = page % pages * shown
    cell = cell_width(min(shown, len(cameras)), rows, columns)
    drawn = [panel(guide, camera, cell) for camera in cameras[first:first + shown]]
    lines = [''.join(part.ljust(panel_width(cell)) for part in line) for line in zip(*drawn)]
    if pages > 1:
        last = min(first + shown, len(cameras))
        lines.append(f'cameras {first + 1} to {last} of {len(cameras)}; TAB shows others')
    return lines


def panel(guide: Guide, camera, cell: int = CELL) -> List[str]:
    """What one camera sees: its image with the captured corners (1 to 4), the LED now (O) and the
    cells that the wave has filled (##); its rate, and the samples of each corner or the wave."""
    width = panel_width(cell) - 1
    border = '+' + '-' * CELL_COLUMNS * cell + '+'
    lines = [fitted(camera.name, width - 1), border]
    lines += [f'|{"".join(row)}|' for row in picture(guide, camera, cell)] + [border]
    if camera.connected:
        spots = (f'{camera.blobs}+{camera.masks} masked' if camera.masks else
                 f'{camera.blobs} spot{"" if camera.blobs == 1 else "s"}')
        lines.append(f'{figure(camera.rate, 0)} Hz  {spots}'[:width])
    else:
        lines.append('no images')
    lines.append(row_of('samples', [str(n) if n else '-' for n in camera.samples], width))
    if math.isnan(camera.image_coverage):
        lines.append(row_of('spread', [figure(s, 1).lstrip('0') for s in camera.spread], width))
    else:
        lines.append(f'wave {100.0 * camera.image_coverage:.0f} %  {figure(camera.speed, 0)} px/s')
    return lines


def row_of(name: str, values: List[str], width: int) -> str:
    """Values per corner, with their name when there is room for it."""
    text = ' '.join([name] + values) if values else ''
    return (text if len(text) <= width else ' '.join(values))[:width]


def picture(guide: Guide, camera, cell: int) -> List[List[str]]:
    """Characters are twice as high as wide."""
    height, width = CELL_ROWS * cell // 2, CELL_COLUMNS * cell
    has_wave = len(camera.image_cells) == CELL_ROWS * CELL_COLUMNS
    rows = []
    for row in range(height):
        rows.append([])
        for column in range(CELL_COLUMNS):
            filled = has_wave and camera.image_cells[row * CELL_ROWS // height * CELL_COLUMNS +
                                                     column]
            rows[-1] += ['#' if filled else '.' if has_wave else ' '] * cell
    marks = [(place, str(number))
             for number, place in enumerate(zip(camera.corner_x, camera.corner_y), 1)]
    if camera.sees_led:
        marks.append(((camera.x, camera.y), 'O'))
    size = guide.image_sizes.get(camera.name)
    for place, sign in marks if size else ():
        if all(math.isfinite(value) for value in place):
            row = int(place[1] / size[1] * height)
            column = int(place[0] / size[0] * width)
            rows[min(max(row, 0), height - 1)][min(max(column, 0), width - 1)] = sign
    return rows


def remarks(status, columns: int, room: int) -> List[str]:
    """What is missing, and the problems of each camera; the most urgent first."""
    sentences = [status.walk] if status.walk else []
    sentences += status.missing
    # Once there is a rig, a camera may see several LEDs, or none.
    is_calibrated = (status.step == status.SAVED or
                     status.step == status.IDLE and status.rig_id)
    for kind in ('health',) if is_calibrated else ('problem', 'health'):
        named: Dict[str, List[str]] = {}  # the cameras of each text
        for camera in status.cameras:
            named.setdefault(getattr(camera, kind), []).append(camera.name)
        sentences += [f'{", ".join(names)}: {text}' for text, names in named.items() if text]
    lines: List[str] = []
    for number, sentence in enumerate(sentences):
        more = [('  ' if i else '- ') + line
                for i, line in enumerate(wrapped(sentence, columns - 2, 2))]
        left = len(sentences) - number
        if len(lines) + len(more) > room - (1 if left > 1 else 0):
            return (lines + [f'- and {left} more'])[:room]
        lines += more
    return lines


# --- Verdict, trace, keys

def verdict_lines(guide: Guide, columns: int) -> List[str]:
    verdict = guide.verdict
    if verdict is None:
        return ['There is no verdict yet: solve first.']
    grade = {verdict.GOOD: 'GOOD', verdict.USABLE: 'USABLE', verdict.REDO: 'DO IT AGAIN'}.get(
        verdict.grade, '?')
    lines = [f'{grade}   (rig {verdict.rig_id[:8]})', *wrapped(verdict.text, columns, ROWS),
             *measurement_lines(guide, columns), '',
             '                 residual   fits   known to within (standard deviation)',
             VERDICT_ROW.format('camera', 'px', 'mm', '%', 'mm', 'deg', 'f px', 'c px', 'k1', 'ms')]
    for camera in verdict.cameras:
        lines.append(VERDICT_ROW.format(
            camera.name[:14], figure(camera.residual_px, 2), figure(1e3 * camera.residual_m, 1),
            figure(1e2 * camera.inlier_share, 0), figure(1e3 * camera.position_stddev, 1),
            figure(math.degrees(camera.rotation_stddev), 3), figure(camera.focal_stddev, 1),
            figure(camera.principal_point_stddev, 1), figure(camera.k1_stddev, 4),
            figure(1e3 * camera.time_offset_stddev, 2)))
    if verdict.predicted_at:
        lines.append('A point will be right to within (standard deviation), at x, y, z in metres:')
        lines += in_columns([
            f'({figure(at.x, 2)}, {figure(at.y, 2)}, {figure(at.z, 2)}) {figure(1e3 * sigma, 1)} mm'
            for at, sigma in zip(verdict.predicted_at, verdict.predicted_stddev)], 3)
    return lines


def measurement_lines(guide: Guide, columns: int) -> List[str]:
    """What was measured last, and what to measure next."""
    lines = [guide.measured] if guide.measured else []
    if guide.verdict.expected_error > 0.0:
        lines.append('Expected error at the corners and above them: '
                     f'{1e3 * guide.verdict.expected_error:.1f} mm (RMS).')
    if guide.verdict.next_measurement:
        lines.append(f'Next (keys d, a): {guide.verdict.next_measurement}')
    return [line for text in lines for line in wrapped(text, columns, 2)]


def trace_lines(trace) -> List[str]:
    """How the correction of the principal points went."""
    if trace is None:
        return ['The principal points were not corrected (see doc/principal_point.md).']
    lines = ['camera          principal point before and after [px]']
    last = (len(trace.origin_error) - 1) * len(trace.cameras)
    for i, name in enumerate(trace.cameras):
        lines.append(f'{name[:14]:<14} {trace.cx[i]:8.1f} {trace.cy[i]:8.1f}   '
                     f'{trace.cx[last + i]:8.1f} {trace.cy[last + i]:8.1f}')
    lines.append('round  error of the first corner, of all corners [mm]')
    for number, errors in enumerate(zip(trace.origin_error, trace.corner_error)):
        lines.append(f'{number:5d}  {1e3 * errors[0]:10.1f} {1e3 * errors[1]:10.1f}')
    return lines


def key_lines(command_list: Sequence, room: int) -> List[str]:
    """Keys, the words that stand for them with --plain, and what they do, if there is room. What
    may be typed after the word stands there for keys that ask for it; the others act at once."""
    lines = ['?   back       y   how the principal points were corrected', '']
    if room >= len(lines) + len(command_list):
        return lines + [f'{command.key:<3} {command.word:<13} {command.label}'
                        for command in command_list]
    return lines + in_columns([
        f'{command.key} {command.word} {command.arguments if command.ask else ""}'.rstrip()
        for command in command_list], 2)
