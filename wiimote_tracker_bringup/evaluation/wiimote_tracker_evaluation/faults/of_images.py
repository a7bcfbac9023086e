"""Cameras with a wrong clock, and cameras with ghosts."""

from wiimote_tracker_evaluation.faults.row import fault

LAST = 8.0  # [s]
ONE, TWO = ('wiimote_4',), ('wiimote_3', 'wiimote_4')


def changed(room, **how):
    for relay in room.relays:
        relay.change(**how)
    yield LAST
    for relay in room.relays:
        relay.change()


@fault(room={'relayed': ONE}, named='wiimote_4')
def clock_off_by_30_ms(room):
    """The clock of one camera's computer jumps by 30 ms, and back after 8 s."""
    yield from changed(room, clock_ahead=0.03)


@fault(room={'relayed': ONE}, named='wiimote_4')
def clock_off_by_500_ms(room):
    """The clock of one camera's computer jumps by 0.5 s, and back after 8 s."""
    yield from changed(room, clock_ahead=0.5)


@fault(room={'relayed': ONE}, named='wiimote_4')
def clock_behind_by_500_ms(room):
    """The clock of one camera's computer jumps back by 0.5 s, and forward after 8 s."""
    yield from changed(room, clock_ahead=-0.5)


@fault(room={'relayed': ONE}, named='wiimote_4')
def clock_that_drifts(room):
    """The clock of one camera's computer runs 0.1 % fast for 8 s, and is then set."""
    yield from changed(room, drift=1e-3)


@fault(room={'relayed': ONE}, named='wiimote_4')
def ghosts_in_one_camera(room):
    """100 spots at random places in every image of one camera, for 8 s."""
    yield from changed(room, ghosts=100)


@fault(room={'relayed': TWO}, named='clock')
def two_clocks_off_by_500_ms(room):
    """The clocks of two of four cameras jump by 0.5 s, and back after 8 s."""
    yield from changed(room, clock_ahead=0.5)
