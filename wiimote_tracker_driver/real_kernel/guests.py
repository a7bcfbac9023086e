"""The kinds of guests: their kernel, modules, and programs of other Debian packages."""

import os
import py_compile
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from typing import Dict, Iterable, List, Optional, Tuple

import fetch

HID_MODULES = ['hid', 'uhid', 'hid-wiimote', 'hid-generic', 'evdev']

File = Tuple[str, str]  # path in the guest, path here


@dataclass
class Guest:
    """One kind of guest."""

    kernel: str
    modules: List[str]
    packages: List[str] = field(default_factory=list)
    programs: List[str] = field(default_factory=list)  # of packages, this workspace or this machine
    scripts: List[str] = field(default_factory=list)   # of our package, in Python
    settings: List[str] = field(default_factory=list)  # files of packages
    libraries: List[str] = field(default_factory=list)  # of packages, which clients load
    clients: List[str] = field(default_factory=list)   # in the folder clients, in Python


GUESTS: Dict[str, Guest] = {
    'hid': Guest(fetch.DEFAULT_KERNEL, HID_MODULES),
    # Debian's smallest kernel has no Bluetooth.
    'bluetooth': Guest('linux-image-amd64', HID_MODULES + ['hci_vhci', 'hidp'], ['bluez'],
                       ['bluetoothctl', 'bluetoothd', 'dbus-daemon', 'list_wiimotes'], ['pair'],
                       ['etc/bluetooth/main.conf']),
    # Libraries for Wii Remotes that others wrote.
    'clients': Guest('linux-image-amd64', HID_MODULES + ['hci_vhci', 'hidp'],
                     ['bluez', 'libxwiimote2', 'libcwiid1'], ['bluetoothd', 'dbus-daemon'],
                     settings=['etc/bluetooth/main.conf'],
                     libraries=['libxwiimote.so.2', 'libcwiid.so.1'],
                     clients=['xwiimote_client', 'cwiid_client']),
}

LIBRARY_FOLDERS = ['usr/lib/x86_64-linux-gnu', 'usr/lib']
PROGRAM_FOLDERS = ['usr/bin', 'usr/sbin', 'usr/libexec/bluetooth', 'usr/lib/bluetooth']

# Prints the files of all modules that a script has imported when it has shown its help.
MODULES_OF_SCRIPT = """
import contextlib, io, runpy, sys
sys.argv = sys.argv[1:]
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    runpy.run_path(sys.argv[0], run_name='__main__')
for module in list(sys.modules.values()):
    print(getattr(module, '__file__', None) or '')
"""


def find_file(name: str, folders: Iterable[str], places: Iterable[str]) -> Optional[str]:
    """A file in one of the `places` in one of the `folders`."""
    for folder in folders:
        for place in places:
            path = os.path.join(folder, place, name)
            if os.path.isfile(path):
                return os.path.realpath(path)
    return None


def find_library(name: str, folders: Iterable[str]) -> str:
    """A shared library of the packages in `folders`. Raises fetch.Unavailable."""
    path = find_file(name, folders, LIBRARY_FOLDERS)
    if not path:
        raise fetch.Unavailable(f'there is no library {name}')
    return path


def find_program(name: str, folders: Iterable[str]) -> str:
    """A program in `folders` or on this machine. Raises fetch.Unavailable."""
    path = find_file(name, folders, [''] + PROGRAM_FOLDERS) or shutil.which(name)
    if not path:
        raise fetch.Unavailable(f'there is no program {name}')
    return path


def script_files(script: str, folder: str) -> List[File]:
    """A script as /bin/NAME, with this Python and the modules that it imports, compiled into
    `folder`."""
    own_folder = os.path.dirname(script)
    interpreter = os.path.realpath(sys.executable)
    paths = subprocess.check_output([interpreter, '-E', '-s', '-B', '-c', MODULES_OF_SCRIPT, script,
                                     '--help'], universal_newlines=True).split()
    files = [('bin/' + os.path.basename(script), script), (interpreter, interpreter)]
    for number, path in enumerate(sorted(set(paths))):
        target = path
        if path.startswith(own_folder + os.sep):
            target = os.path.join('/bin', os.path.relpath(path, own_folder))
        if path.endswith('.py'):
            # The guest would take seconds to compile them.
            compiled = os.path.join(folder, f'{os.path.basename(script)}_{number}.pyc')
            py_compile.compile(path, compiled, doraise=True,
                               invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH)
            path, target = compiled, target + 'c'
        files.append((target, path))
    return files


def files_of(guest: Guest, parts: fetch.Parts, client: str, scripts_folder: str,
             folder: str) -> List[File]:
    """The programs and scripts of a guest; `folder` is for temporary files. Raises
    fetch.Unavailable."""
    folders = [os.path.dirname(client)] + list(parts.package_folders.values())
    files = [('bin/real_kernel_client', client)]
    files += [('bin/' + name, find_program(name, folders)) for name in guest.programs]
    files += [(path, os.path.join(place, path)) for path in guest.settings for place in folders
              if os.path.isfile(os.path.join(place, path))]
    files += [('lib/' + name, find_library(name, folders)) for name in guest.libraries]
    clients_folder = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'clients')
    for script in ([os.path.join(scripts_folder, name) for name in guest.scripts] +
                   [os.path.join(clients_folder, name) for name in guest.clients]):
        files += script_files(script, folder)
    return files
