"""Scores sensitivities by images without the LED and with it far away.

An image is a list of spots (x, y, size): position [px], and size 0..15 or NaN.
"""

import math
from dataclasses import dataclass
from typing import List, Optional, Set, Tuple

Spot = Tuple[float, float, float]
Image = List[Spot]

SAME_PLACE = 20.0    # [px] A spot this close to one seen without the LED is the same lamp.
EQUALLY_FEW = 0.05   # Levels whose foreign lights per image differ by less are equally good.
STEADY = 0.98        # Share of the images in which the LED must be seen.


@dataclass
class Level:
    """Result of one sensitivity."""

    name: str
    foreign: float  # lamps and reflections, mean per image
    seen: float     # share of the images in which the LED is seen [0..1]
    size: float = math.nan  # of the LED's spot, mean; grows with the sensitivity


def score(name: str, images_without: List[Image], images_with: List[Image]) -> Level:
    """The Level of images taken without the LED and with it. Raises ValueError without images."""
    if not images_without or not images_with:
        raise ValueError(f'there are no images at sensitivity {name}')
    foreign = sum(len(image) for image in images_without) / len(images_without)
    # Lamps do not move, so they have few places.
    places = {(round(x), round(y)) for image in images_without for x, y, _ in image}
    led = [[spot for spot in image if _is_new(spot, places)] for image in images_with]
    sizes = [spot[2] for spots in led for spot in spots]
    return Level(name, foreign, sum(map(bool, led)) / len(images_with),
                 sum(sizes) / len(sizes) if sizes else math.nan)


def recommend(levels: List[Level]) -> Tuple[Optional[Level], str]:
    """The recommended level and the reason; (None, reason) when none sees the LED steadily.
    levels: of those that show the LED equally large, the last is preferred."""
    steady_ones = [level for level in levels if level.seen >= STEADY]
    if not steady_ones:
        best = max(levels, key=lambda level: level.seen)
        sentence = (f'no sensitivity sees the LED steadily; the best, {best.name}, sees it in '
                    f'{100.0 * best.seen:.0f} % of the images: give the LED more current, turn it '
                    'towards the camera or bring it closer')
        # Lamps hide an LED behind them, and an LED that was never off counts as a lamp.
        if best.foreign >= EQUALLY_FEW:
            sentence += (f'; cover lamps and reflections ({best.foreign:.2f} per image), and have '
                         'the LED off when asked to')
        return None, sentence
    fewest = min(level.foreign for level in steady_ones)
    # Of equally good levels the most sensitive, which resolves positions best: it shows the LED as
    # the largest spot.
    good = [level for level in steady_ones if level.foreign < fewest + EQUALLY_FEW]
    chosen = max(reversed(good), key=lambda level: 0.0 if math.isnan(level.size) else level.size)
    lights = (f'{chosen.foreign:.2f} foreign lights per image' if chosen.foreign
              else 'no foreign light')
    sentence = (f'sensitivity {chosen.name} sees the LED in {100.0 * chosen.seen:.0f} % of the '
                f'images and {lights}')
    if chosen.foreign >= EQUALLY_FEW:
        sentence += ': cover these lamps and reflections, or turn the camera away from them'
    return chosen, sentence


def table(levels: List[Level]) -> str:
    """One line per level."""
    lines = [f'{"sensitivity":<12} {"foreign lights/image":<22} {"LED seen [%]":<14} spot size']
    lines += [f'{level.name:<12} {level.foreign:<22.2f} {100.0 * level.seen:<14.1f} '
              f'{level.size:.1f}' for level in levels]
    return '\n'.join(lines)


def _is_new(spot: Spot, places: Set[Tuple[int, int]]) -> bool:
    return all(math.hypot(spot[0] - x, spot[1] - y) > SAME_PLACE for x, y in places)
