"""Scores sensitivities by what the camera saw at each: without the LED, and with it far away.

An image is a list of spots (x, y) [px].
"""

import math

# A spot that is at most so far from one that was there without the LED is the same lamp [px].
SAME_PLACE = 20.0
# Levels whose foreign spots per image differ by less are equally good.
EQUALLY_FEW = 0.05
# The LED must be seen in this share of the images.
STEADY = 0.98


class Level(object):
    """How one sensitivity does."""

    def __init__(self, name, foreign, seen):
        self.name = name
        self.foreign = foreign  # lamps and reflections, mean per image
        self.seen = seen        # share of the images in which the LED is seen [0..1]

    def __repr__(self):
        return 'Level(%r, %g, %g)' % (self.name, self.foreign, self.seen)


def score(name, images_without, images_with):
    """The Level of images taken without the LED and with it; ValueError when one kind lacks."""
    if not images_without or not images_with:
        raise ValueError('there are no images at sensitivity %s' % name)
    foreign = sum(len(image) for image in images_without) / float(len(images_without))
    # Lamps stand still: few places, however many images.
    places = set((round(x), round(y)) for image in images_without for x, y in image)
    seen = sum(1 for image in images_with
               if any(_is_new(spot, places) for spot in image)) / float(len(images_with))
    return Level(name, foreign, seen)


def recommend(levels, steady=STEADY):
    """The level to use, and a sentence why; (None, sentence) when none sees the LED steadily.
    levels: from the least sensitive to the most."""
    steady_ones = [level for level in levels if level.seen >= steady]
    if not steady_ones:
        best = max(levels, key=lambda level: level.seen)
        sentence = ('no sensitivity sees the LED steadily; the best, %s, sees it in %.0f %% of '
                    'the images: give the LED more current, turn it towards the camera or bring '
                    'it closer' % (best.name, 100.0 * best.seen))
        # Where a lamp is, the LED does not count; and one that was never off is a lamp itself.
        if best.foreign >= EQUALLY_FEW:
            sentence += ('; cover lamps and reflections (%.2f per image), and have the LED off when '
                         'asked to' % best.foreign)
        return None, sentence
    fewest = min(level.foreign for level in steady_ones)
    # Of the equally good the most sensitive: it measures the finest positions.
    chosen = [level for level in steady_ones if level.foreign < fewest + EQUALLY_FEW][-1]
    sentence = ('%s sees the LED in %.0f %% of the images and %s'
                % (chosen.name, 100.0 * chosen.seen,
                   'no foreign light' if chosen.foreign == 0.0
                   else '%.2f foreign lights per image' % chosen.foreign))
    if chosen.foreign >= EQUALLY_FEW:
        sentence += ': cover these lamps and reflections, or turn the camera away from them'
    return chosen, sentence


def table(levels):
    """The levels in lines, for people."""
    lines = ['%-12s %-22s %s' % ('sensitivity', 'foreign lights/image', 'LED seen [%]')]
    for level in levels:
        lines.append('%-12s %-22.2f %.1f' % (level.name, level.foreign, 100.0 * level.seen))
    return '\n'.join(lines)


def _is_new(spot, places):
    return all(math.hypot(spot[0] - x, spot[1] - y) > SAME_PLACE for x, y in places)
