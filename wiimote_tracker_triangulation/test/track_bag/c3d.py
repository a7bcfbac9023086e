"""Reader of C3D files, from the C3D File Format User Guide (Motion Lab Systems). Shares no code
with the writer, and uses what other programs use: the header for the layout, POINT for the
meaning."""

import struct
from types import SimpleNamespace

import numpy as np

BLOCK = 512
TYPES = {-1: ('S1', 1), 1: ('i1', 1), 2: ('<u2', 2), 4: ('<f4', 4)}


def parameters_of(content, first_block):
    """Parameters by 'GROUP:NAME', as numpy arrays; texts as lists."""
    start = (first_block - 1) * BLOCK
    blocks, processor = content[start + 2], content[start + 3]
    assert processor == 84, 'Intel'
    end = start + blocks * BLOCK
    groups, found = {}, []
    at = start + 4
    while True:
        assert at < end
        length, group = struct.unpack_from('<bb', content, at)
        name = content[at + 2:at + 2 + length].decode('ascii')
        at += 2 + length
        offset, = struct.unpack_from('<H', content, at)
        if group < 0:
            groups[-group] = name
        else:
            kind, dimensions = struct.unpack_from('<bB', content, at + 2)
            size = list(content[at + 4:at + 4 + dimensions])
            dtype, width = TYPES[kind]
            count = int(np.prod(size)) if size else 1
            begin = at + 4 + dimensions
            raw = content[begin:begin + count * width]
            if kind == -1:
                width = size[0]
                value = [raw[i * width:(i + 1) * width].decode('ascii').rstrip()
                         for i in range(count // width)]
            else:
                value = np.frombuffer(raw, dtype)
            found.append((group, name, value))
            description = begin + len(raw)
            assert offset in (0, description + 1 + content[description] - at)
        if offset == 0:
            break
        at += offset
    return {f'{groups[group]}:{name}': value for group, name, value in found}


def read(path):
    """labels, rate [Hz], units, frames x points x 3 positions (NaN where invalid), analog
    channels, time of frame 1 as text [s since 1970]."""
    with open(path, 'rb') as file:
        content = file.read()
    assert len(content) % BLOCK == 0
    assert content[1] == 0x50
    points, analog, first, last = struct.unpack_from('<4H', content, 2)
    scale, = struct.unpack_from('<f', content, 12)
    data_block, analog_per_frame = struct.unpack_from('<2H', content, 16)
    rate, = struct.unpack_from('<f', content, 20)
    parameters = parameters_of(content, content[0])
    assert scale < 0 and parameters['POINT:SCALE'][0] == scale, 'floating-point numbers'
    assert (analog, analog_per_frame, parameters['ANALOG:USED'][0]) == (0, 0, 0)
    assert parameters['POINT:USED'][0] == points
    assert parameters['POINT:DATA_START'][0] == data_block
    assert parameters['POINT:RATE'][0] == np.float32(rate)
    start, end = ([int(low) + 65536 * int(high)] for low, high in (
        parameters['TRIAL:ACTUAL_START_FIELD'], parameters['TRIAL:ACTUAL_END_FIELD']))
    frames = end[0] - start[0] + 1
    assert (first, last) == (1, min(frames, 65535))
    assert parameters['POINT:FRAMES'][0] == min(frames, 65535)
    data = np.frombuffer(content, '<f4', frames * points * 4, (data_block - 1) * BLOCK)
    data = data.reshape(frames, points, 4).astype(float)
    positions = np.where(data[..., 3:] < 0, np.nan, data[..., :3])
    labels = [label for name, value in parameters.items() if name.startswith('POINT:LABELS')
              for label in value]
    assert len(labels) == points
    return SimpleNamespace(labels=labels, rate=rate, units=parameters['POINT:UNITS'][0],
                           positions=positions, analog=analog,
                           start=parameters.get('WIIMOTE_TRACKER:START_TIME', [None])[0])
