"""Packs the guest's root file system: a newc cpio archive with busybox, kernel modules in the order
in which they have to be loaded, and programs with their shared libraries. Needs no root, no cpio
and no depmod."""

import lzma
import os
import re
import stat
import subprocess


class Archive(object):
    """A newc cpio archive that makes the folders above what is put into it."""

    def __init__(self, file):
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

    def folder(self, path):
        if path and path not in self._names:
            self.folder(os.path.dirname(path))
            self._names.add(path)
            self._entry(path, stat.S_IFDIR | 0o755)

    def add(self, path, content, mode=stat.S_IFREG | 0o755):
        """Adds a file; one that is there already is left as it is."""
        path = path.lstrip('/')
        if path in self._names:
            return
        self.folder(os.path.dirname(path))
        self._names.add(path)
        self._entry(path, mode, content)

    def link(self, path, target):
        self.add(path, target.encode(), stat.S_IFLNK | 0o777)

    def close(self):
        self._entry('TRAILER!!!', 0)


def read(path):
    with open(path, 'rb') as file:
        content = file.read()
    # busybox cannot load compressed modules.
    return lzma.decompress(content) if path.endswith('.xz') else content


def modules_in_order(kernel_folder, wanted):
    """Names and contents of the wanted modules and those they need, needed ones first. What is no
    module of this kernel is taken to be built in."""
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


def libraries_of(program):
    """Where in the guest, and where here, is each shared library that a program needs, and the
    loader: the latter at its own path, the others in /lib, since a program may find its libraries
    here by variables that the guest does not have. Raises OSError when one is missing."""
    output = subprocess.run(['ldd', program], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            universal_newlines=True).stdout
    missing = re.findall(r'(\S+) => not found', output)
    if missing:
        raise OSError('%s needs %s, which was not found' % (program, ', '.join(missing)))
    libraries = re.findall(r'=> (/\S+) \(0x', output)
    loaders = re.findall(r'^\s*(/\S+) \(0x', output, re.MULTILINE)
    return ([('lib/' + os.path.basename(path), path) for path in libraries] +
            [(path, path) for path in loaders])


def build(path, init, busybox, kernel_folder, modules, programs):
    """Writes the archive. `programs` are put into /bin of the guest."""
    with open(path, 'wb') as file:
        archive = Archive(file)
        for folder in ('dev', 'proc', 'run', 'sys', 'tmp'):
            archive.folder(folder)
        archive.add('init', read(init))
        archive.add('bin/busybox', read(busybox))
        archive.link('bin/sh', 'busybox')
        ordered = modules_in_order(kernel_folder, modules)
        for name, content in ordered:
            archive.add('modules/%s.ko' % name, content)
        archive.add('modules/order', ''.join('%s\n' % name for name, _ in ordered).encode())
        for program in programs:
            archive.add('bin/' + os.path.basename(program), read(program))
            for target, path in libraries_of(program):
                archive.add(target, read(path))
        archive.close()
