"""check_body warns where a launch file waits for a body that nobody publishes."""

import program_module
import pytest

check_body = program_module.load('launch/check_body')


def topics_of(body):
    return [body + '/odometry', body + '/pose', body + '/twist']


@pytest.fixture
def said(monkeypatch, capsys):
    """What it says of a body in a namespace, while the topics come one list after the other."""
    def said(body, namespace, *topics):
        lists = list(topics)
        now = [0.0]

        class Master:
            def __init__(self, name):
                pass

            def getSystemState(self):
                names = lists.pop(0) if len(lists) > 1 else lists[0]
                return [[name, ['/triangulation']] for name in names], [], []

        monkeypatch.setattr(check_body.rosgraph, 'Master', Master)
        monkeypatch.setattr('time.monotonic', lambda: now[0])
        monkeypatch.setattr('time.sleep', lambda duration: now.append(now.pop() + duration))
        monkeypatch.setenv('ROS_NAMESPACE', namespace)
        check_body.main(body)
        return capsys.readouterr().err
    return said


@pytest.mark.parametrize('body, namespace, topics, sentence', [
    ('robot', '', topics_of('/stick') + ['/wheel/odometry', '/odometry'],
     'Nobody publishes /robot/odometry: learn this body (learn_body), or name another by body:=; '
     'there are /stick.'),
    ('stick', '', topics_of('/second/stick'), 'Nobody publishes /stick/odometry: learn '
     'this body (learn_body), or name another by body:=; there are /second/stick.'),
    ('stick', '/second', [], 'Nobody publishes /second/stick/odometry: learn '
     'this body (learn_body), or name another by body:=; there is none.')])
def test_a_body_that_nobody_publishes_is_named(said, body, namespace, topics, sentence):
    assert said(body, namespace, topics) == f'[WARN] {sentence}\n'


@pytest.mark.parametrize('namespace, body', [('', 'stick'), ('', '/stick'), ('/second', '/stick')])
def test_a_body_that_is_published_soon_is_fine(said, namespace, body):
    assert said(body, namespace, [], ['/rosout'], topics_of('/stick')) == ''


def test_a_body_of_the_own_namespace_is_fine(said):
    assert said('stick', '/second', topics_of('/second/stick')) == ''
