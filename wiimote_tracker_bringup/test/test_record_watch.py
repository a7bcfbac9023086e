"""record_watch says in the diagnostics what rosbag does not tell of a recording."""

import collections
import os
import shlex

import program_module
import pytest
import roslaunch.config

watch = program_module.load('launch/record_watch')
LAUNCH = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../launch/record.launch')
OK, WARN, ERROR = range(3)


@pytest.mark.parametrize('free, level, words', [
    (0.96, ERROR, 'the recording ends, since only 0.96 GB of disk are free in /bags: remove'),
    (4.2, WARN, '4.20 GB of disk are free in /bags, and the recording ends at 1 GB: remove files'),
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
    assert words.startswith('nothing is recorded, since no topic matches topics:=points: it must')


def test_it_looks_where_the_bags_are_written():
    arguments = ['output:=/my disk/run', 'topics:=/points']
    nodes = roslaunch.config.load_config_default([(LAUNCH, arguments)], 11311, verbose=False).nodes
    watched, = [shlex.split(node.args) for node in nodes if node.type == 'record_watch']
    recorded, = [shlex.split(node.args) for node in nodes if node.type == 'record']
    assert watched == ['/my disk/run', '/points'] and '--output-prefix=/my disk/run' in recorded
