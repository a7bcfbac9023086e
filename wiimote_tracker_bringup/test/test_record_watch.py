"""record_watch says in the diagnostics what rosbag does not tell of a recording."""

import collections
import os
import shlex
import types
from unittest import mock

import program_module
import pytest

from launch_files import configuration

watch = program_module.load('launch/record_watch')
OK, WARN, ERROR = range(3)


@pytest.mark.parametrize('free, level, words', [
    (0.96, ERROR, 'the recording ends, since only 0.96 GB of disk are free in /bags: remove'),
    (4.2, WARN, '4.20 GB of disk are free in /bags, and the recording ends at 1 GB: remove files, '
     'or keep less of the recording, by gigabytes:='),
    (6.0, OK, '6.00 GB of disk are free in /bags')])
def test_a_full_disk_is_told(monkeypatch, free, level, words):
    usage = collections.namedtuple('usage', 'free')
    monkeypatch.setattr('shutil.disk_usage', lambda folder: usage(int(free * (1 << 30))))
    found, said = watch.judge('/bags', '/points', ['/points'])
    assert found == level and said.startswith(words)


def test_a_folder_that_is_gone_is_told(tmp_path):
    assert watch.judge(str(tmp_path / 'gone'), '.*', ['/points']) == (
        ERROR, f'{tmp_path}/gone cannot be looked at: No such file or directory')


def test_topics_that_match_nothing_are_told(tmp_path):
    level, words = watch.judge(str(tmp_path), 'points', ['/points', '/rosout'])
    assert level == WARN
    assert words == (
        'nothing is recorded, since no published topic matches topics:=points: start what '
        'publishes it, or give the whole name, such as /points')


def statuses(monkeypatch, given, published):
    """Those of the node with these arguments, and what it says on the console. published: the names
    of the topics for each 6 s, or OSError."""
    ros = mock.Mock()
    ros.is_shutdown.side_effect = [False] * len(published) + [True]
    ros.get_published_topics.side_effect = [
        names if names is OSError else [(name, '') for name in names] for names in published]
    clock = iter(range(0, 1000, 6))
    monkeypatch.setattr(watch, 'rospy', ros)
    monkeypatch.setattr(watch, 'time', types.SimpleNamespace(
        monotonic=lambda: next(clock), sleep=lambda seconds: None))
    monkeypatch.setattr(watch.nodes, 'start', lambda *_: given)
    monkeypatch.setattr(watch.shutil, 'disk_usage', lambda _: types.SimpleNamespace(free=1 << 40))
    watch.main()
    published = ros.Publisher.return_value.publish.call_args_list
    return ([call[0][0].status[0] for call in published],
            [call[0][1] for call in ros.logwarn.call_args_list])


@pytest.mark.parametrize('published, levels, warnings', [
    ([['/rosout'], ['/rosout', '/points']], [WARN, OK], 0),  # the tracker is started, too
    ([['/rosout']] * 3, [WARN] * 3, 1),
    ([['/points'], [], [], ['/points'], []], [OK, WARN, WARN, OK, WARN], 2),
    ([OSError, OSError, OSError], [OK] * 3, 0),  # the master does not answer
    ([['/points'], OSError, OSError], [OK] * 3, 0)])
def test_the_console_is_told_of_topics_that_stay_away(monkeypatch, published, levels, warnings):
    found, said = statuses(monkeypatch, ['/bags/run', '/points'], published)
    assert [status.level for status in found] == levels and len(said) == warnings
    assert all(words.startswith('Nothing is recorded, since no published topic') for words in said)


def test_the_console_is_told_of_a_full_disk_at_once():
    assert watch.is_for_console(ERROR, 0.0)


@pytest.mark.parametrize('given, folder, level', [
    ([], os.getcwd(), OK), (['/bags/run'], '/bags', OK), (['/bags/run', 'points'], '/bags', WARN)])
def test_arguments_may_be_left_out(monkeypatch, given, folder, level):
    (status,), _ = statuses(monkeypatch, given, [['/points']])
    assert status.hardware_id == folder and status.level == level


def test_it_looks_where_the_bags_are_written():
    nodes = configuration('record.launch', 'output:=/my disk/run', 'topics:=/points').nodes
    watched, = [shlex.split(node.args) for node in nodes if node.type == 'record_watch']
    recorded, = [shlex.split(node.args) for node in nodes if node.type == 'record']
    assert watched == ['/my disk/run', '/points'] and '--output-prefix=/my disk/run' in recorded
