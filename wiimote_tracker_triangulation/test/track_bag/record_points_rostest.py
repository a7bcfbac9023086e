#!/usr/bin/env python3
"""record_points writes what is published on points and triggered_points, whole when it is
stopped."""

import csv
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import genpy
import roslib.packages
import rospy
from wiimote_tracker_msgs.msg import (BodyLed, TrackedBody, TrackedBodyArray, TrackedPoint,
                                      TrackedPointArray)

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
import c3d  # noqa: E402
from live import wait_for  # noqa: E402

PACKAGE = 'wiimote_tracker_triangulation'
PROGRAM = roslib.packages.find_node(PACKAGE, 'record_points')[0]


def array(number, *ids):
    message = TrackedPointArray(rig_id='0123', method='track')
    message.header.stamp = genpy.Time(1600000000, number)
    message.header.frame_id = 'world'
    for i in ids:
        point = TrackedPoint(id=i, label='led', state=TrackedPoint.TRACKED, residual=0.1 * i,
                             label_confidence=0.25, label_since=genpy.Time(1500000000, i))
        point.position.x = number / 3.0
        message.points.append(point)
    return message


class RecordPoints(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.path = os.path.join(self.folder, 'out.csv')

    def publish(self, topic, kind, queue_size):
        """A publisher for this test only: rospy counts a recorder of an earlier test, which has
        ended, as connected for a while."""
        publisher = rospy.Publisher(topic, kind, queue_size=queue_size)
        self.addCleanup(publisher.unregister)
        return publisher

    def start(self, *arguments, before=()):
        """before: words of a program that runs it."""
        # Python ignores SIGXFSZ; so does then the recorder.
        process = subprocess.Popen(list(before) + [PROGRAM] + list(arguments),
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   universal_newlines=True, restore_signals=not before)
        self.addCleanup(lambda: process.poll() is None and process.kill())
        return process

    def stop(self, process, status=0):
        """Ends it by Ctrl-C. Returns what it said."""
        process.send_signal(signal.SIGINT)
        output = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, status)
        return output

    def rows(self, path):
        with open(path, newline='') as stream:
            return [(r['time [s]'], r['triggered'], r['id'], r['label_confidence'],
                     r['label_since [s]'], float(r['x [m]'])) for r in csv.DictReader(stream)]

    def lines(self, path):
        """Whole ones, without the header."""
        with open(path) as stream:
            return stream.read().count('\n') - 1

    def test_rows_arrive_and_the_file_is_whole_at_the_end(self):
        points = self.publish('/points', TrackedPointArray, 100)
        triggered = self.publish('/triggered_points', TrackedPointArray, 100)
        process = self.start('_csv:=' + self.path, '_flush_period:=0.05')
        for publisher in (points, triggered):
            wait_for(lambda: publisher.get_num_connections() > 0, publisher.resolved_name)
        for number in range(50):
            points.publish(array(number, 3, 7))
        part = self.path + '.part'
        wait_for(lambda: os.path.exists(part) and self.lines(part) == 100, 'rows on the disk')
        triggered.publish(array(77, 3))
        wait_for(lambda: self.lines(part) == 101, 'the row of the trigger')
        self.assertFalse(os.path.exists(self.path))
        self.assertIn('51 messages came', self.stop(process))
        expected = [('1600000000.%09d' % n, '0', str(i), '0.25', '1500000000.%09d' % i, n / 3.0)
                    for n in range(50) for i in (3, 7)]
        self.assertEqual(self.rows(self.path), expected + [
            ('1600000000.000000077', '1', '3', '0.25', '1500000000.000000003', 77 / 3.0)])

    def test_c3d_trc_and_tum(self):
        points = self.publish('/points', TrackedPointArray, 1000)
        bodies = self.publish('/bodies', TrackedBodyArray, 1000)
        paths = {kind: os.path.join(self.folder, 'out.' + kind) for kind in ('c3d', 'trc')}
        process = self.start('__name:=recorder_of_trajectories', '_tum:=' + self.folder,
                             '_csv:=' + self.path, '_flush_period:=0.05', '_rate:=50',
                             *('_%s:=%s' % item for item in paths.items()))
        for publisher in (points, bodies):
            wait_for(lambda: publisher.get_num_connections() > 0, publisher.resolved_name)
        for number in range(20):
            points.publish(array(20000000 * number, 3))
        for state in (TrackedBody.TRACKED, TrackedBody.LOST):
            message = TrackedBodyArray(bodies=[TrackedBody(name='wand', state=state)])
            message.header.stamp = genpy.Time(1600000000, 5)
            message.bodies[0].pose.pose.orientation.w = 1.0
            message.bodies[0].leds = [BodyLed(label='tip')]
            bodies.publish(message)
        part = os.path.join(self.folder, 'wand.tum.part')
        wait_for(lambda: os.path.exists(part) and os.path.getsize(part) > 0, 'a pose on the disk')
        wait_for(lambda: self.lines(self.path + '.part') == 20, 'the points on the disk')
        said = self.stop(process)
        with open(part[:-5]) as file:
            self.assertEqual(file.read(), '1600000000.000000005 0 0 0 0 0 0 1\n')
        found = c3d.read(paths['c3d'])
        self.assertEqual((found.labels, found.rate, len(found.positions)),
                         (['led', 'wand:tip'], 50.0, 20))
        self.assertEqual(found.start, '1600000000.000000000')
        self.assertIn('out.c3d: frame 1 is at ' + found.start, said)
        with open(os.path.join(self.folder, 'out_bodies.csv'), newline='') as stream:
            rows = [(r['time [s]'], r['body'], r['state']) for r in csv.DictReader(stream)]
        self.assertEqual(rows, [('1600000000.000000005', 'wand', state)
                                for state in ('tracked', 'lost')])
        self.assertTrue(os.path.exists(paths['trc']))

    def test_a_table_that_fails_at_the_end_is_named_and_spoils_no_other(self):
        points = self.publish('/points', TrackedPointArray, 100)
        paths = {kind: os.path.join(self.folder, 'out.' + kind) for kind in ('csv', 'c3d')}
        process = self.start('__name:=recorder_of_weeks', '_tum:=' + self.folder,
                             '_flush_period:=0.05', *('_%s:=%s' % item for item in paths.items()))
        wait_for(lambda: points.get_num_connections() > 0, 'the recorder')
        weeks = array(0, 3)
        weeks.header.stamp.secs += 100000000
        for message in (array(0, 3), array(20000000, 3), weeks):
            points.publish(message)
        wait_for(lambda: self.lines(paths['csv'] + '.part') == 3, 'rows on the disk')
        self.assertIn('frames of C3D or TRC', self.stop(process, 1))
        self.assertEqual(self.lines(paths['csv']), 3)
        self.assertFalse(os.path.exists(paths['c3d']))

    def test_a_table_that_cannot_be_written_ends_it_and_spoils_no_other(self):
        points = self.publish('/points', TrackedPointArray, 100)
        paths = {kind: os.path.join(self.folder, 'out.' + kind) for kind in ('csv', 'c3d')}
        # A file of limited size fails as one on a full disk.
        process = self.start('__name:=recorder_on_a_full_disk', '_flush_period:=0.05',
                             *('_%s:=%s' % item for item in paths.items()),
                             before=('prlimit', '--fsize=65536'))
        wait_for(lambda: points.get_num_connections() > 0, 'the recorder')
        points.publish(array(0, 3))
        wait_for(lambda: self.lines(paths['csv'] + '.part') == 1, 'a row on the disk')
        points.publish(array(1, *range(1000)))
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 1)
        self.assertIn('cannot write ' + paths['csv'], said)
        self.assertFalse(os.path.exists(paths['csv']), 'rows are missing')
        self.assertEqual(c3d.read(paths['c3d']).labels, ['led'])

    def test_says_that_no_points_came(self):
        process = self.start('__name:=recorder_of_nothing', '_csv:=' + self.path, 'points:=/point')
        wait_for(lambda: os.path.exists(self.path + '.part'), 'the file')
        self.assertIn('no points came on /point: start the tracker', self.stop(process))

    def test_names_what_there_is_where_no_points_come(self):
        self.publish('/lab/points', TrackedPointArray, 1)
        bodies = self.publish('/bodies', TrackedBodyArray, 1)
        process = self.start('__name:=recorder_elsewhere', '_csv:=' + self.path, 'points:=/point')
        wait_for(lambda: bodies.get_num_connections() > 0, 'the recorder')
        bodies.publish(TrackedBodyArray())
        process.stdout.readline()  # its warning
        self.assertIn('no points came on /point, but 1 message of bodies: record in the namespace '
                      'of /lab/points', self.stop(process))

    def test_says_what_is_missing_or_wrong(self):
        for arguments, words in [((), 'csv or'), (('_csv:=' + self.path, '_cvs:=x'), 'unknown'),
                                 (('_csv:=' + self.folder,), 'cannot write'),
                                 (('_csv:=' + self.path, '_trc:=' + self.path), 'another one')]:
            name = '__name:=recorder_%d' % len(words)
            process = self.start(name, *arguments)
            output = process.communicate(timeout=60)[0]
            self.assertEqual(process.returncode, 1)
            self.assertIn(words, output)


if __name__ == '__main__':
    import rostest
    rospy.init_node('record_points_test')
    rostest.rosrun(PACKAGE, 'record_points', RecordPoints, sys.argv)
