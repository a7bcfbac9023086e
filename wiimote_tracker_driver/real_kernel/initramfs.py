"""Packs the guest's root file system: a newc cpio archive with busybox, the kernel modules in the
order of loading, and programs with their shared libraries. Needs no root, cpio or depmod."""

import lzma
import os
import re
import stat
import subprocess
import sys
from typing import BinaryIO, Iterable, List, Tuple


class Archive:
    """A newc cpio archive. It adds the folders above each file."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self._names = set()
        self._inode = 0

    def _entry(self, name, mode, content=b''):
        self._inode += 1
        encoded = name.encode() + b'\0'
        fields = (self._inode, mode, 0, 0, 1, 0, len(content), 0, 0, 0, 0, len(encoded), 0)
        header = b'070701' + b''.join(b'%08X' % field for field in fields) + encoded
        for part in (header, content):
            self._file.write(part + b'\0' * (-len(part) % 4))

    def folder(self, path: str) -> None:
        if path and path not in self._names:
            self.folder(os.path.dirname(path))
            self._names.add(path)
            self._entry(path, stat.S_IFDIR | 0o755)

    def add(self, path: str, content: bytes, mode: int = stat.S_IFREG | 0o755) -> None:
        """Adds a file unless the archive has it already."""
        path = path.lstrip('/')
        if path in self._names:
            return
        self.folder(os.path.dirname(path))
        self._names.add(path)
        self._entry(path, mode, content)

    def link(self, path: str, target: str) -> None:
        self.add(path, target.encode(), stat.S_IFLNK | 0o777)

    def close(self) -> None:
        self._entry('TRAILER!!!', 0)


def read(path: str) -> bytes:
    """The content of a file, decompressed: busybox cannot load compressed modules."""
    with open(path, 'rb') as file:
        content = file.read()
    return lzma.decompress(content) if path.endswith('.xz') else content


def modules_in_order(kernel_folder: str, wanted: Iterable[str]) -> List[Tuple[str, bytes]]:
    """Names and contents of the wanted modules and their dependencies, dependencies first. A name
    without a module file counts as built in."""
    paths = {}
    for folder, _, names in os.walk(os.path.join(kernel_folder, 'lib', 'modules')):
        for name in names:
            match = re.match(r'(.+)\.ko(\.xz)?$', name)
            if match:
                paths[match.group(1).replace('-', '_')] = os.path.join(folder, name)
    ordered = []
    visited = set()

    def visit(name):
        name = name.replace('-', '_')
        if name in visited or name not in paths:
            return
        visited.add(name)
        content = read(paths[name])
        for needed in re.findall(rb'(?:^|\0)depends=([^\0]*)\0', content):
            for other in filter(None, needed.decode().split(',')):
                visit(other)
        ordered.append((name, content))

    for name in wanted:
        visit(name)
    return ordered


def libraries_of(program: str, folders: Iterable[str]) -> List[Tuple[str, str]]:
    """Path in the guest and path here of each shared library of a program, and of the loader. The
    loader keeps its path; libraries go to /lib. They are looked for in `folders` of Debian packages
    and on this machine. Raises OSError when one is missing."""
    search = ':'.join(os.path.join(folder, 'usr/lib', multiarch)
                      for folder in folders for multiarch in ('x86_64-linux-gnu', ''))
    output = subprocess.run(['ldd', program], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True,
                            env=dict(os.environ, LD_LIBRARY_PATH=search + ':' + os.environ.get(
                                'LD_LIBRARY_PATH', ''))).stdout
    missing = re.findall(r'(\S+) => not found', output)
    if missing:
        raise OSError(f'{program} needs {", ".join(missing)}, which was not found')
    libraries = re.findall(r'=> (/\S+) \(0x', output)
    # Before version 2.34, libc itself loads this one, to look up users.
    users = [os.path.join(os.path.dirname(path), 'libnss_files.so.2') for path in libraries
             if os.path.basename(path) == 'libc.so.6']
    libraries += filter(os.path.exists, users)
    loaders = re.findall(r'^\s*(/\S+) \(0x', output, re.MULTILINE)
    return ([('lib/' + os.path.basename(path), path) for path in libraries] +
            [(path, path) for path in loaders])


def build(path: str, init: str, busybox: str, kernel_folder: str, modules: Iterable[str],
          files: Iterable[Tuple[str, str]], folders: Iterable[str] = ()) -> None:
    """Writes the archive. `files`: path in the guest and path here; the libraries of programs
    among them are added, from `folders` of Debian packages or from this machine."""
    with open(path, 'wb') as file:
        archive = Archive(file)
        for folder in ('dev', 'etc/bluetooth', 'proc', 'run/dbus', 'sys', 'tmp',
                       'var/lib/bluetooth'):
            archive.folder(folder)
        archive.add('init', read(init))
        archive.add('bin/busybox', read(busybox))
        archive.link('bin/sh', 'busybox')
        archive.link('usr/bin/env', '/bin/busybox')
        archive.link('usr/bin/python3', os.path.realpath(sys.executable))
        archive.add('etc/passwd', b'root:x:0:0::/tmp:/bin/sh\n')
        archive.add('etc/group', b'root:x:0:\n')
        archive.add('etc/dbus.conf', read(os.path.join(os.path.dirname(init), 'dbus.conf')))
        ordered = modules_in_order(kernel_folder, modules)
        for name, content in ordered:
            archive.add(f'modules/{name}.ko', content)
        archive.add('modules/order', ''.join(f'{name}\n' for name, _ in ordered).encode())
        for target, source in files:
            content = read(source)
            archive.add(target, content)
            if content.startswith(b'\x7fELF'):
                for library, path in libraries_of(source, folders):
                    archive.add(library, read(path))
        archive.close()
