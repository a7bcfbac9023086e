"""How sensitivities are scored."""

import random

import pytest

from sensitivity.scoring import Level, recommend, score, table

LAMP = (100.0, 700.0, 2.0)
LED = (500.0, 300.0, 3.0)


def chosen(*levels):
    level, _ = recommend([Level(*level) for level in levels])
    return level.name if level else None


def test_the_led_is_the_light_that_was_not_there_before():
    level = score('wii_3', [[LAMP]] * 4, [[LAMP, LED], [LED], [LAMP], []])
    assert (level.name, level.foreign, level.seen) == ('wii_3', 1.0, 0.5)
    assert level.size == 3.0


def test_a_lamp_that_flickers_by_some_pixels_is_not_the_led():
    rng = random.Random(1)

    def lamp():
        return [(LAMP[0] + rng.uniform(-5, 5), LAMP[1] + rng.uniform(-5, 5), 2.0)]

    assert score('max', [lamp() for _ in range(200)], [lamp() for _ in range(200)]).seen == 0.0
    # A light that is on in some images only counts as foreign in those.
    assert score('max', [lamp(), []], [lamp()]).foreign == 0.5


def test_no_images_are_an_error():
    for without, with_led in (([], [[LED]]), ([[]], [])):
        with pytest.raises(ValueError, match='wii_1'):
            score('wii_1', without, with_led)


def test_the_fewest_foreign_lights_win_among_those_that_see_the_led():
    assert chosen(('wii_1', 0.0, 0.0), ('wii_2', 0.0, 0.5), ('wii_3', 1.0, 1.0),
                  ('wii_4', 2.0, 1.0)) == 'wii_3'


def test_among_equals_the_most_sensitive_wins():
    assert chosen(('wii_1', 0.0, 1.0), ('wii_2', 0.0, 1.0), ('wii_3', 0.01, 1.0),
                  ('wii_4', 1.0, 1.0)) == 'wii_3'


def test_the_most_sensitive_is_the_one_that_shows_the_led_largest():
    assert chosen(('wii_3', 0.0, 1.0, 2.0), ('wii_5', 0.0, 1.0, 5.0),
                  ('max', 0.0, 1.0, 3.0)) == 'wii_5'
    assert chosen(('wii_3', 0.0, 1.0, 2.0), ('wii_5', 0.1, 1.0, 5.0)) == 'wii_3'
    nan = float('nan')
    assert chosen(('wii_3', 0.0, 1.0, nan), ('wii_5', 0.0, 1.0, nan)) == 'wii_5'


def test_a_level_that_flickers_is_not_steady():
    assert chosen(('wii_1', 0.0, 0.97), ('wii_2', 0.5, 0.99)) == 'wii_2'


def test_unavoidable_lamps_are_named():
    _, sentence = recommend([Level('wii_5', 2.0, 1.0)])
    assert '2.00 foreign lights' in sentence and 'cover these lamps' in sentence
    _, sentence = recommend([Level('wii_5', 0.0, 1.0)])
    assert 'no foreign light' in sentence and 'cover' not in sentence


def test_an_led_that_no_level_sees_needs_more_light():
    level, sentence = recommend([Level('wii_5', 0.0, 0.2), Level('max', 0.0, 0.6)])
    assert level is None
    assert 'max, sees it in 60 %' in sentence and 'more current' in sentence
    assert 'cover' not in sentence


def test_an_led_that_was_never_off_is_suspected():
    level, sentence = recommend([Level('wii_5', 1.0, 0.0), Level('max', 1.0, 0.0)])
    assert level is None
    assert 'have the LED off when asked to' in sentence


def test_the_table_has_a_line_for_each_level():
    text = table([Level('wii_1', 0.25, 0.5), Level('max', 4.0, 1.0)])
    assert len(text.splitlines()) == 3
    assert '0.25' in text and '50.0' in text
