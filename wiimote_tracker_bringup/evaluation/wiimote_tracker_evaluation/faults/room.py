"""A simulated room with a running tracker, whose parts can be disturbed."""

import contextlib
import os
import shutil
import signal
import tempfile
import time

import psutil

from wiimote_tracker_bringup import descriptions
from wiimote_tracker_bringup.errors import Refusal
from wiimote_tracker_bringup.files import read_yaml, write_yaml
from wiimote_tracker_bringup.processes import descendants, free_port
from wiimote_tracker_bringup.programs import find_program, package_file
from wiimote_tracker_bringup.true_rig import true_rig
from wiimote_tracker_bringup.waiting import wait_until
from wiimote_tracker_evaluation.faults import figures
from wiimote_tracker_evaluation.faults.far_computer import FarComputer
from wiimote_tracker_evaluation.faults.listener import Listener, joined
from wiimote_tracker_evaluation.faults.relay import Relay
from wiimote_tracker_evaluation.faults.rig_writer import write_rig

START = 90.0      # longest time until all LEDs are tracked, on a busy computer [s]
SETTLED = 2.0     # that the LEDs must be tracked at the start [s]
KEEP_LOG = "with --log FILE the nodes' output is kept"  # this folder goes with the room
LATENCY = 0.0094  # as in simulated_rig.launch [s]

# Each LED waves through its own part of the room; any two stay apart.
LEDS = {name: {'position': [x, y, 1.0], 'size': 3.0,
               'wave': {'middle': [x, y, 1.0], 'box': [0.5, 0.5, 0.8], 'speed': 0.4, 'path': path}}
        for name, x, y, path in (('one', 0.4, 0.4, 11), ('two', 2.1, 0.6, 12),
                                 ('three', 1.2, 2.1, 13))}
LABELS = ('a', 'b', 'c')
DARK = {f'dark_{number}': {'position': [0.3 + 0.6 * (number % 4), 0.3 + 0.6 * (number // 4),
                                        0.5 + 0.1 * (5 * number % 13)],
                           'size': 3.0, 'lit': False} for number in range(13)}


class Room:
    """A master, virtual remotes with three waving LEDs, and the whole tracker with the true rig."""

    def __init__(self, processes, cameras=4, relayed=(), far=(), one_manager=False, dark=False):
        """relayed: cameras whose images pass a relay. far: cameras whose drivers run on another
        computer. dark: 13 more LEDs, which do not shine yet. processes: starts and ends
        everything."""
        self._processes = processes
        self._one_manager = one_manager
        self._dark = DARK if dark else {}
        self.folder = tempfile.mkdtemp(prefix='wiimote_tracker_faults_')
        self.log = os.path.join(self.folder, 'nodes.log')
        paper = read_yaml(package_file('simulation/paper_rig.yaml'))
        description = dict(
            descriptions.with_leds(descriptions.with_cameras(paper, cameras), []),
            leds=dict(LEDS, **self._dark), truth_rate=50.0)
        self.cameras = list(description['cameras'])
        write_yaml(self.file('room.yaml'), description)
        write_yaml(self.file('cameras.yaml'), {'cameras': {
            name: identity for name, identity in descriptions.identities(description).items()
            if name not in relayed and name not in far}})
        write_rig(self.file('rig.yaml'), true_rig(self.file('room.yaml')))
        self._port = free_port()
        self.far = FarComputer() if far else None
        os.environ['ROS_HOSTNAME'] = self.far.here if far else 'localhost'
        os.environ['ROS_MASTER_URI'] = f"http://{os.environ['ROS_HOSTNAME']}:{self._port}"
        os.environ['ROS_HOME'] = self.folder
        self.listeners = []
        self.relays = []
        try:
            self.start_master()
            self.start_nodes()
            self.relays += [Relay(self, camera) for camera in relayed]
            for camera in far:
                self.start_driver(camera, prefix=self.far.prefix())
            self.listen()
        except BaseException:
            self.stop()
            raise

    def file(self, name):
        return os.path.join(self.folder, name)

    def rig_bytes(self):
        with open(self.file('rig.yaml'), 'rb') as file:
            return file.read()

    def start_master(self):
        self.master = self._processes.start_master(self._port, self.log, START)

    def start_nodes(self):
        self.launch = self._processes.start('roslaunch', [
            'roslaunch', package_file('evaluation/fault_room.launch'), f'folder:={self.folder}',
            'labels:=' + ','.join(LABELS),
            'one_manager:=' + str(self._one_manager).lower()], self.log)

    def listen(self):
        """Starts one more listener: those before do not hear the nodes of a new master."""
        self.listeners.append(Listener([*LEDS, *self._dark]))

    def stop(self):
        for helper in self.listeners + self.relays:
            helper.stop()
        self._processes.stop_all()
        if self.far:
            self.far.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    # --- What is measured

    def window(self, start, end):
        return joined([listener.window(start, end) for listener in self.listeners])

    def figures(self, start, end):
        return figures.figures(self.window(start, end), end - start)

    def wait_until_tracked(self):
        def is_tracked():
            newest = self.window(time.time() - SETTLED, time.time())
            return figures.is_tracked(newest, SETTLED, len(LEDS), self.cameras)
        wait_until(is_tracked, START,
                   f'the LEDs are not tracked by all cameras within {START:.0f} s; {KEEP_LOG}',
                   period=SETTLED / 2.0)

    # --- Processes

    def nodes(self):
        """Process ids by the nodes' names."""
        found = {}
        for process in sorted(descendants(), key=lambda each: each.pid):
            try:
                words, variables = process.cmdline(), process.environ()
            except psutil.Error:
                continue  # it has ended
            for word in words:
                if word.startswith('__name:='):
                    space = variables.get('ROS_NAMESPACE', '').strip('/')
                    found['/' + f'{space}/{word[len("__name:="):]}'.strip('/')] = process.pid
        return found

    def pid(self, node):
        """node: its name, or roscore, or roslaunch. @raise Refusal: it does not run."""
        if node in ('roscore', 'roslaunch'):
            return (self.master if node == 'roscore' else self.launch).pid
        try:
            return self.nodes()[node]
        except KeyError:
            raise Refusal(f'the node {node} does not run; {KEEP_LOG}')

    def kill(self, node):
        """node: as of pid()."""
        os.kill(self.pid(node), signal.SIGKILL)

    @contextlib.contextmanager
    def stopped(self, node):
        """Stops a node, as of pid(), by SIGSTOP for a while."""
        process = self.pid(node)
        os.kill(process, signal.SIGSTOP)
        try:
            yield
        finally:
            os.kill(process, signal.SIGCONT)

    def start(self, command, prefix=()):
        """Starts a program beside the nodes; it ends with the room. command: as find_program()
        wants it, and arguments. prefix: a program that starts it, and arguments."""
        return self._processes.start(
            command[0], [*prefix, find_program(command[0])] + command[1:], self.log)

    def start_driver(self, camera, *remappings, prefix=()):
        """Starts the driver of a camera that is not in cameras.yaml."""
        self.start(['wiimote_tracker_driver/driver_node', '__name:=driver', f'__ns:=/{camera}',
                    *remappings, f'_camera_name:={camera}',
                    f"_device:=virtual:{self.file('remotes')}/{camera}.sock",
                    f"_camera_info_url:=file://{self.file('cameras')}/{camera}.yaml",
                    f'_latency:={LATENCY}', '_realtime_priority:=0'], prefix)

    def end(self, process):
        """Ends a program before the room ends."""
        self._processes.stop(process)
