"""Cameras with a wrong clock, and cameras with ghosts."""

from wiimote_tracker_evaluation.faults.fault import Fault

LAST = 8.0  # [s]
ONE, TWO = ('wiimote_4',), ('wiimote_3', 'wiimote_4')


def changed(name, what, relayed=ONE, named='wiimote_4', **change):
    """The images of the relayed cameras are changed for a while."""
    def cause(room):
        for relay in room.relays:
            relay.change(**change)
        yield LAST
        for relay in room.relays:
            relay.change()
    return Fault(name, what, cause, room={'relayed': relayed}, named=named)


FAULTS = (
    changed('clock_off_by_30_ms', "The clock of one camera's computer jumps by 30 ms, and back "
            'after 8 s', clock_ahead=0.03),
    changed('clock_off_by_500_ms', "The clock of one camera's computer jumps by 0.5 s, and back "
            'after 8 s', clock_ahead=0.5),
    changed('clock_behind_by_500_ms', "The clock of one camera's computer jumps back by 0.5 s, and "
            'forward after 8 s', clock_ahead=-0.5),
    changed('clock_that_drifts', "The clock of one camera's computer runs 0.1 % fast for 8 s, and "
            'is then set', drift=1e-3),
    changed('ghosts_in_one_camera',
            '100 spots at random places in every image of one camera, for 8 s', ghosts=100),
    changed('two_clocks_off_by_500_ms', 'The clocks of two of four cameras jump by 0.5 s, and back '
            'after 8 s', TWO, 'clock', clock_ahead=0.5))
