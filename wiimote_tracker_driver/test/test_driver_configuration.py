#!/usr/bin/env python3
"""The driver's messages when it cannot run or has no remote, and that it stops at once."""
import os
import signal
import subprocess
import tempfile
import threading
import unittest

import rospkg
import rospy
import yaml

COMMAND = ["rosrun", "wiimote_tracker_driver", "driver_node"]
DEADLINE = 30.0
NONSENSE = """image_width: 1024
image_height: 768
camera_name: lens
camera_matrix: {rows: 3, cols: 3, data: [.nan, 0, 512, 0, 1331, 384, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}
projection_matrix: {rows: 3, cols: 4, data: [1330, 0, 512, 0, 0, 1331, 384, 0, 0, 0, 1, 0]}
"""


def run(*arguments, **environment):
    """Runs the driver to its end. Returns its exit code and output."""
    done = subprocess.run(COMMAND + list(arguments), env=dict(os.environ, **environment),
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=DEADLINE)
    return done.returncode, done.stdout.decode()


class DriverConfiguration(unittest.TestCase):
    def assert_refused(self, part, *arguments):
        code, text = run(*arguments)
        self.assertEqual(1, code, text)
        self.assertIn("FATAL", text)
        self.assertIn(part, text)

    def test_malformed_device(self):
        self.assert_refused("/driver_a/device: device 'hidraw0' must be", "__name:=driver_a",
                            "_device:=hidraw0")

    def test_bad_values(self):
        self.assert_refused("/driver_b/latency is -1", "__name:=driver_b", "_latency:=-1")
        self.assert_refused("/driver_c/ir_sensitivity is 'high', but must be one of: wii_1",
                            "__name:=driver_c", "_ir_sensitivity:=high")
        self.assert_refused("/driver_d/camera_name is 'a b'", "__name:=driver_d",
                            "_camera_name:=a b")
        self.assert_refused("/driver_e/camera_info_url is 'nowhere'", "__name:=driver_e",
                            "_camera_info_url:=nowhere")

    def test_a_folder_as_calibration(self):
        with tempfile.TemporaryDirectory(suffix=".yaml") as folder:
            url = f"file://{folder}"
            self.assert_refused(f"/driver_r/camera_info_url: the calibration {url} cannot",
                                "__name:=driver_r", f"_camera_info_url:={url}")

    def test_invalid_sensitivity_blocks(self):
        self.assert_refused("/driver_i/ir_sensitivity_block1 and _block2: ", "__name:=driver_i",
                            "_ir_sensitivity:=custom", "_ir_sensitivity_block1:=07 00")

    def test_bad_modes_and_ranges(self):
        self.assert_refused("/driver_j/ir_mode is 'fast', but must be one of: basic, extended, "
                            "full", "__name:=driver_j", "_ir_mode:=fast")
        self.assert_refused("/driver_k/leds is 16", "__name:=driver_k", "_leds:=16")
        self.assert_refused("/driver_l/realtime_priority is 100", "__name:=driver_l",
                            "_realtime_priority:=100")

    def test_recordings(self):
        self.assert_refused("/driver_m/device: /nowhere/at_all.wiirec: cannot read the recording",
                            "__name:=driver_m", "_device:=replay:/nowhere/at_all.wiirec")
        self.assert_refused("it was looked for in " + os.getcwd() + "; give an absolute path",
                            "__name:=driver_q", "_device:=replay:at_all.wiirec")
        self.assert_refused("/driver_n/record: ", "__name:=driver_n",
                            "_record:=/nowhere/at_all.wiirec")
        self.assert_refused("/driver_p/replay_rate must be 0", "__name:=driver_p",
                            "_replay_rate:=0.01")
        self.assert_refused("/driver_o/record is set", "__name:=driver_o",
                            "_record:=a.wiirec", "_device:=replay:/nowhere/at_all.wiirec")

    def test_misspelt_parameter(self):
        self.assert_refused("unknown parameter /driver_f/latencies", "__name:=driver_f",
                            "_latencies:=0")

    def test_no_master(self):
        code, text = run("_device:=hidraw0", ROS_MASTER_URI="http://localhost:1")
        self.assertEqual(1, code)
        self.assertIn("start roscore", text)

    def test_documented_defaults_are_accepted(self):
        path = rospkg.RosPack().get_path("wiimote_tracker_driver")
        with open(os.path.join(path, "config", "driver.yaml")) as file:
            rospy.set_param("/driver_g", yaml.safe_load(file))
        # Only the misspelt key is wrong.
        self.assert_refused("unknown parameter /driver_g/other:", "__name:=driver_g", "_other:=1")

    def test_waits_for_its_remote_and_stops_at_once(self):
        home = tempfile.TemporaryDirectory()  # without a calibration of the camera
        self.addCleanup(home.cleanup)
        text = self.wait_and_stop(home.name, "__name:=driver_h")
        self.assertIn("namespace /", text)
        self.assertNotIn("Camera calibration file", text, "a camera's first start is no fault")

    def test_an_empty_calibration_is_named_once(self):
        home = tempfile.TemporaryDirectory()
        self.addCleanup(home.cleanup)
        path = os.path.join(home.name, "lens.yaml")
        open(path, "w").close()
        text = self.wait_and_stop(home.name, "__name:=driver_r", "_camera_info_url:=file://" + path)
        self.assertIn(path + " is empty, so the driver does not know the lens", text)
        self.assertEqual(1, text.count("lens.yaml"), text)

    def test_a_calibration_that_holds_nonsense_is_named_once(self):
        home = tempfile.TemporaryDirectory()
        self.addCleanup(home.cleanup)
        path = os.path.join(home.name, "lens.yaml")
        for content, words in ((NONSENSE, "focal length"), ("no calibration", "none can be read")):
            with open(path, "w") as file:
                file.write(content)
            text = self.wait_and_stop(home.name, "__name:=driver_n",
                                      "_camera_info_url:=file://" + path)
            self.assertIn(path + " is unusable: ", text)
            self.assertIn(words, text)
            self.assertEqual(1, text.count("is unusable"), text)

    def wait_and_stop(self, home, *arguments):
        """What a driver prints that waits for its remote and is interrupted."""
        process = subprocess.Popen(
            COMMAND + ["_device:=00:00:00:00:00:01", *arguments],
            env=dict(os.environ, ROS_HOME=home),
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        watchdog = threading.Timer(DEADLINE, process.kill)
        watchdog.start()
        sentence = "no Wii Remote with address 00:00:00:00:00:01 is connected"
        text = ""
        try:
            while sentence not in text:
                line = process.stdout.readline().decode()
                self.assertTrue(line, "the driver ended or hung: " + text)
                text += line
            self.assertIsNone(process.poll(), "the driver must keep trying")
            process.send_signal(signal.SIGINT)
            text += process.communicate()[0].decode()
        finally:
            watchdog.cancel()
            process.kill()
            process.wait()
        self.assertEqual(0, process.returncode, text)
        return text


if __name__ == "__main__":
    import rostest
    rospy.init_node("test_driver_configuration")
    rostest.rosrun("wiimote_tracker_driver", "driver_configuration", DriverConfiguration)
