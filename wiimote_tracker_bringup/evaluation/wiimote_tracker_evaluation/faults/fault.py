"""What a fault is; causes one, and judges the figures taken before, during and after it."""

import dataclasses
import time
from typing import Callable, Dict, List, Optional

from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_evaluation.faults.figures import PIECE, Figures, is_normal, normal_since

BEFORE = 2.0     # measured before the fault [s]
AFTER = 2.0      # of normal points, after which all counts as recovered [s]
PATIENCE = 40.0  # for the recovery [s]


@dataclasses.dataclass(frozen=True)
class Fault:
    """name: as on the command line; what: in words. cause: a generator function of a room; it
    causes the fault, yields for how long it shall last [s], and then takes the cause away. It may
    return a list of sentences: what went wrong.

    quick: also in the quick form. room: how the room differs (arguments of Room). ends: nodes that
    may end and start again; '*' for all. named: what some warning or error must contain; empty:
    none is needed. names_may_change: whether LEDs may get other names. wrong_allowed: wrong points
    cannot be avoided. spends_room: no other fault can be tried in this room afterwards. why_not:
    says why it cannot be caused here; empty: it can.
    """

    name: str
    what: str
    cause: Callable
    quick: bool = False
    room: Dict = dataclasses.field(default_factory=dict)
    ends: tuple = ()
    named: str = ''
    names_may_change: bool = False
    wrong_allowed: bool = False
    spends_room: bool = False
    why_not: Callable[[], str] = lambda: ''


@dataclasses.dataclass(eq=False)
class Result:
    """during: until all was normal again. recovery: from the end of the cause until all was normal
    [s]; None: never. ended: nodes that ended or were started again. renamed: LEDs with another
    label than before. said: the first sentence that names the cause. problems: what must not be."""

    name: str
    what: str
    before: Optional[Figures] = None
    during: Optional[Figures] = None
    after: Optional[Figures] = None
    recovery: Optional[float] = None
    ended: List[str] = dataclasses.field(default_factory=list)
    renamed: List[str] = dataclasses.field(default_factory=list)
    said: str = ''
    problems: List[str] = dataclasses.field(default_factory=list)


def fault(**how):
    """Turns a generator function with a docstring into a Fault; how: its other fields."""
    return lambda cause: Fault(cause.__name__, cause.__doc__.strip().rstrip('.'), cause, **how)


def carry_out(chosen: Fault, room) -> Result:
    result = Result(chosen.name, chosen.what)
    nodes = room.nodes()
    rig = room.rig_bytes()
    begin = time.time()
    time.sleep(BEFORE)
    result.before = room.figures(begin, begin + BEFORE)
    start = time.time()
    course = chosen.cause(room)
    time.sleep(next(course))
    try:
        next(course)
        raise Refusal(f'{chosen.name} yields more than once')
    except StopIteration as ended:
        result.problems += ended.value or []
    gone = time.time()
    since = wait_until_normal(room, gone, result.before, lambda: is_complete(chosen, room, nodes))
    end = time.time()
    result.during = room.figures(start, max(gone, since or end))
    if since is not None:
        result.recovery = since - gone
        result.after = room.figures(end - AFTER, end)
    judge(chosen, result, room, start, end, nodes)
    if room.rig_bytes() != rig:
        result.problems.append('rig.yaml is another one')
    return result


def is_complete(chosen, room, nodes):
    """Whether all nodes run; and, if all may end, none is still the one of before."""
    now = room.nodes()
    return set(nodes) <= set(now) and (
        chosen.ends != ('*',) or all(now[name] != nodes[name] for name in nodes))


def wait_until_normal(room, gone, before, complete):
    """Waits until all nodes run (complete() says so) and points are normal for AFTER seconds.
    Returns since when; None: never."""
    while time.time() < gone + PATIENCE:
        time.sleep(0.5)
        end = time.time()
        if end - gone < AFTER or not complete():
            continue
        if not is_normal(room.window(end - AFTER, end), AFTER, before):
            continue
        since = normal_since(room.window(gone, end), gone, end, before)
        if since is not None and end - since > AFTER - PIECE:
            return since
    return None


def judge(chosen, result, room, start, end, nodes):
    whole = room.figures(start, end)
    if result.recovery is None:
        result.problems.append(f'not normal again within {PATIENCE:.0f} s')
    if whole.wrong and not chosen.wrong_allowed:
        result.problems.append(f'{whole.wrong} of {whole.number} points were wrong, by up to '
                               f'{1e3 * whole.worst:.0f} mm')
    if result.after:
        result.renamed = sorted(led for led, label in result.after.names.items()
                                if result.before.names.get(led) != label)
    if result.renamed and not chosen.names_may_change:
        result.problems.append('other names: ' + ', '.join(result.renamed))
    now = room.nodes()
    result.ended = sorted(name for name in nodes if now.get(name) != nodes[name])
    lost = [name for name in nodes if name not in now]
    if lost:
        result.problems.append('gone for good: ' + ', '.join(lost))
    others = [name for name in result.ended if name not in chosen.ends and name not in lost]
    if others and chosen.ends != ('*',):
        result.problems.append('ended, too: ' + ', '.join(others))
    naming = [sentence for _, _, sentence in room.window(start, end).said
              if chosen.named in sentence]
    if naming:
        result.said = naming[0]
    elif chosen.named:
        result.problems.append(f'nothing said "{chosen.named}"')
