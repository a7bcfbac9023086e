"""Which reports of ThreadSanitizer count: those about code of the tracker."""

import thread_reports

LOCK = '    #0 pthread_mutex_lock ../src/libsanitizer/tsan.cpp:13 (libtsan.so.2+0x5)\n'
STANDARD = '    #1 std::mutex::lock() /usr/include/c++/12/bits/std_mutex.h:100 (node+0x2)\n'
OURS = '    #2 run /clone/wiimote_tracker_driver/src/ros/driver.cpp:7 (node+0x3)\n'
ROS = '    #1 ros::Connection::read() <null> (libroscpp.so.4d+0xa)\n'
DELETE = ('    #0 operator delete(void*) ../src/libsanitizer/tsan.cpp:15 (libtsan.so.2+0x6)\n'
          '    #1 boost::detail::sp_counted_base::destroy() /usr/include/boost/a.hpp:99 '
          '(node+0x4)\n')


def report(*stacks):
    origin = '  Thread T1 (tid=1, running) created by main thread at:\n' + LOCK + OURS
    return ('==================\nWARNING: ThreadSanitizer: data race (pid=1)\n'
            + '\n'.join('  Write of size 8 by thread T1:\n' + stack for stack in stacks)
            + '\n' + origin + '\nSUMMARY: ThreadSanitizer\n==================\n')


def counted(tmp_path, *stacks):
    path = tmp_path / 'report.1'
    path.write_text(report(*stacks))
    return thread_reports.main([str(path)])


def test_an_access_in_our_code_counts(tmp_path):
    assert counted(tmp_path, OURS, ROS) == 1


def test_every_report_of_every_file_is_read(tmp_path, capsys):
    paths = [tmp_path / 'report.1', tmp_path / 'report.2']
    paths[0].write_text(report(ROS, ROS))
    paths[1].write_text(report(ROS, ROS) + report(OURS, ROS))
    assert thread_reports.main([str(path) for path in paths]) == 1
    assert capsys.readouterr().out.splitlines()[-1] == '3 reports, 1 about the tracker'


def test_a_lock_that_our_code_takes_counts(tmp_path):
    assert counted(tmp_path, LOCK + ROS, LOCK + STANDARD + OURS) == 1


def test_what_ros_does_for_our_code_does_not_count(tmp_path):
    assert counted(tmp_path, LOCK + ROS + OURS, LOCK + ROS) == 0


def test_the_end_of_a_message_does_not_count(tmp_path):
    assert counted(tmp_path, DELETE, OURS) == 0
