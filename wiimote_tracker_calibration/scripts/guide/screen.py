"""The screen of the rig's calibration: from a Guide to lines of text."""

import math

from .layout import bar, duration, figure, fitted, wrapped

ROWS, COLUMNS = 24, 80          # the least that is needed
PANEL = 20                      # width of a camera's panel, the gap included
CELL_ROWS, CELL_COLUMNS = 6, 8  # as CalibrationCameraStatus.image_cells
CELL = 2                        # characters per cell: they are twice as high as wide
IMAGE = (1024.0, 768.0)         # of a Wii Remote [px]
KEYS = ['SPACE next  m masks  k connection  n new  t take corner  u undo  h hands-free',
        'w wave  s solve  v save  c check  i verdict  TAB cameras  ? all keys  q quit']


def steps(status):
    """Name of each step."""
    return {status.IDLE: 'not started', status.READY: 'corners', status.CAPTURING: 'capturing',
            status.WAVING: 'waving', status.COMPLETE: 'complete', status.SOLVING: 'solving',
            status.SOLVED: 'solved', status.SAVED: 'saved', status.MASKING: 'learning masks',
            status.MEASURING: 'measuring'}


def render(guide, now, view='cameras', page=0, rows=ROWS, columns=COLUMNS, prompt=None,
           command_list=()):
    """Exactly `rows` lines of at most `columns` characters. view: 'cameras', 'verdict',
    'trace' or 'keys'.
    prompt: a question with what was typed so far, instead of the keys."""
    if rows < ROWS or columns < COLUMNS:
        lines = wrapped('Make this window at least %d x %d; it is %d x %d now. Or use --plain.'
                        % (COLUMNS, ROWS, columns, rows), max(columns, 10), max(rows, 1))
        return [fitted(line, columns) for line in lines + [''] * (rows - len(lines))][:rows]
    lines = [title(guide, now, columns)]
    lines += padded(wrapped(guide.silent(now) or guide.advice().sentence, columns, 2), 2)
    room = rows - len(lines) - len(KEYS)
    lines += body(guide, view, page, room, columns, command_list)
    lines += prompt_lines(prompt, columns) if prompt is not None else KEYS
    return [fitted(line, columns) for line in lines]


def padded(lines, count):
    return (list(lines) + [''] * count)[:count]


def prompt_lines(prompt, columns):
    question, typed = prompt
    return [question, '> ' + typed[-(columns - 4):]]


def title(guide, now, columns):
    status = guide.status
    left = 'CALIBRATION'
    if status is not None:
        left += '  %-14s %s' % (steps(status).get(status.step, '?'), bar(status.progress, 16))
        if status.corners_needed:
            left += '  corners %d/%d' % (status.corners_captured, status.corners_needed)
    right = duration(guide.elapsed(now))
    if status is not None and status.rig_id:
        right = 'rig %s  %s' % (status.rig_id[:8], right)
    return left + right.rjust(columns - len(left))


def body(guide, view, page, room, columns, command_list):
    if view == 'keys':
        return padded(key_lines(command_list), room)
    if view == 'verdict':
        return padded(verdict_lines(guide.verdict, columns), room)
    if view == 'trace':
        return padded(trace_lines(guide.trace), room)
    if guide.status is None:
        return [''] * room
    lines = panels(guide, page, columns)
    said = saying(guide, columns)
    remarks_room = room - len(lines) - len(said) - 1
    return lines + [''] + padded(remarks(guide.status, columns, remarks_room),
                                 remarks_room) + said


# --- Cameras

def panels(guide, page, columns):
    """As many cameras side by side as fit."""
    cameras = guide.status.cameras
    if not cameras:
        return ['No camera is there yet: start the drivers.']
    shown = max(columns // PANEL, 1)
    pages = (len(cameras) + shown - 1) // shown
    first = page % pages * shown
    drawn = [panel(camera, corner_places(guide, camera.name))
             for camera in cameras[first:first + shown]]
    lines = [''.join(row.ljust(PANEL) for row in rows) for rows in zip(*drawn)]
    if pages > 1:
        lines.append('cameras %d to %d of %d; TAB shows others'
                     % (first + 1, min(first + shown, len(cameras)), len(cameras)))
    return lines


def corner_places(guide, name):
    return [corner.get(name) for corner in guide.corners]


def panel(camera, corners):
    """What one camera sees: its image, the corners captured (1 to 4), the LED now (O), the cells
    that the wave has filled (##)."""
    lines = [fitted(camera.name, PANEL - 2), '+' + '-' * CELL_COLUMNS * CELL + '+']
    lines += ['|' + ''.join(row) + '|' for row in picture(camera, corners)]
    lines.append(lines[1])
    if camera.connected:
        spots = ('%d+%d masked' % (camera.blobs, camera.masks) if camera.masks else
                 '%d spot%s' % (camera.blobs, '' if camera.blobs == 1 else 's'))
        lines.append(('%s Hz  %s' % (figure(camera.rate, '%.0f'), spots))[:PANEL - 1])
    else:
        lines.append('no images')
    lines.append(row_of('samples', ['%d' % n if n else '-' for n in camera.samples]))
    if math.isnan(camera.image_coverage):
        lines.append(row_of('spread', [figure(s, '%.1f').lstrip('0') for s in camera.spread]))
    else:
        lines.append('wave %.0f %%  %s px/s' % (100.0 * camera.image_coverage,
                                              figure(camera.speed, '%.0f')))
    return lines


def row_of(name, values):
    """Values per corner, with their name when there is room for it."""
    text = ' '.join([name] + values) if values else ''
    return (text if len(text) < PANEL else ' '.join(values))[:PANEL - 1]


def picture(camera, corners):
    wave = len(camera.image_cells) == CELL_ROWS * CELL_COLUMNS
    rows = []
    for row in range(CELL_ROWS):
        rows.append([])
        for column in range(CELL_COLUMNS):
            filled = wave and camera.image_cells[row * CELL_COLUMNS + column]
            rows[-1] += ['#' if filled else '.' if wave else ' '] * CELL
    for number, place in enumerate(corners, 1):
        if place is not None:
            mark(rows, place, str(number))
    if camera.sees_led:
        mark(rows, (camera.x, camera.y), 'O')
    return rows


def mark(rows, place, sign):
    """Draws a sign at a place [px]."""
    if not all(math.isfinite(value) for value in place):
        return
    row = int(place[1] / IMAGE[1] * CELL_ROWS)
    column = int(place[0] / IMAGE[0] * CELL_COLUMNS * CELL)
    rows[min(max(row, 0), CELL_ROWS - 1)][min(max(column, 0), CELL_COLUMNS * CELL - 1)] = sign


# --- Sentences

def remarks(status, columns, room):
    """What is missing, and what is wrong with which camera; the most urgent first."""
    sentences = list(status.missing)
    sentences += ['%s: %s' % (camera.name, camera.problem)
                  for camera in status.cameras if camera.problem]
    sentences += ['%s: %s' % (camera.name, camera.health)
                  for camera in status.cameras if camera.health]
    lines = []
    for number, sentence in enumerate(sentences):
        more = ['- ' + line if i == 0 else '  ' + line
                for i, line in enumerate(wrapped(sentence, columns - 2, 2))]
        left = len(sentences) - number
        if len(lines) + len(more) > room - (1 if left > 1 else 0):
            return (lines + ['- and %d more' % left])[:room]
        lines += more
    return lines


def saying(guide, columns):
    """What the node answered or says, or how far it is; at most three lines."""
    if guide.running:
        text = guide.feedback or guide.running[-1] + ' ...'
        if guide.progress > 0.0:
            text = '%s %s' % (bar(guide.progress, 20), text)
        return wrapped(text, columns, 3)
    return wrapped(guide.answer or guide.status.message, columns, 3)


# --- Verdict

def verdict_lines(verdict, columns):
    if verdict is None:
        return ['There is no verdict yet: solve first.']
    grade = {verdict.GOOD: 'GOOD', verdict.USABLE: 'USABLE', verdict.REDO: 'DO IT AGAIN'}.get(
        verdict.grade, '?')
    lines = ['%s   (rig %s)' % (grade, verdict.rig_id[:8])] + wrapped(verdict.text, columns, 8)
    lines += ['', '                 residual   fits   known to within (standard deviation)',
              '%-14s %5s %5s %5s  %6s %6s %6s %6s %6s %6s' % (
                  'camera', 'px', 'mm', '%', 'mm', 'deg', 'f px', 'c px', 'k1', 'ms')]
    for camera in verdict.cameras:
        lines.append('%-14s %5s %5s %5s  %6s %6s %6s %6s %6s %6s' % (
            camera.name[:14], figure(camera.residual_px, '%.2f'),
            figure(1e3 * camera.residual_m, '%.1f'), figure(1e2 * camera.inlier_share, '%.0f'),
            figure(1e3 * camera.position_stddev, '%.1f'),
            figure(math.degrees(camera.rotation_stddev), '%.3f'),
            figure(camera.focal_stddev, '%.1f'), figure(camera.principal_point_stddev, '%.1f'),
            figure(camera.k1_stddev, '%.4f'), figure(1e3 * camera.time_offset_stddev, '%.2f')))
    if verdict.predicted_at:
        lines += ['', 'A point will be right to within (standard deviation):']
        lines += ['  at (%.2f, %.2f, %.2f) m: %s mm' % (
            at.x, at.y, at.z, figure(1e3 * sigma, '%.1f'))
                  for at, sigma in zip(verdict.predicted_at, verdict.predicted_stddev)]
    return lines


def trace_lines(trace):
    """How the correction of the principal points went."""
    if trace is None:
        return ['The principal points were not corrected (see doc/principal_point.md).']
    lines = ['camera          principal point before and after [px]']
    count, last = len(trace.cameras), len(trace.origin_error) - 1
    for number, name in enumerate(trace.cameras):
        end = last * count + number
        lines.append('%-14s %8.1f %8.1f   %8.1f %8.1f' % (
            name[:14], trace.cx[number], trace.cy[number], trace.cx[end], trace.cy[end]))
    lines.append('round  error of the first corner, of all corners [mm]')
    return lines + ['%5d  %10.1f %10.1f' % (round_, 1e3 * origin, 1e3 * corners)
                    for round_, (origin, corners) in enumerate(zip(trace.origin_error,
                                                                   trace.corner_error))]


def key_lines(command_list):
    """Two columns: keys, and the words that stand for them with --plain."""
    rows = ['%-3s %s %s' % (command.key, command.word, command.arguments)
            for command in command_list]
    half = (len(rows) + 1) // 2
    return ['?   back       y   how the principal points were corrected', ''] + [left.ljust(COLUMNS // 2) + right for left, right in
                               zip(rows[:half], rows[half:] + [''])]
