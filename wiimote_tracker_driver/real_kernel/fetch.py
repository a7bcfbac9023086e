"""Downloads Debian's kernel, QEMU and busybox with apt-get and unpacks them into a cache folder.
Installs nothing and needs no root. Can also be run by itself.
"""

import argparse
import contextlib
import fcntl
import glob
import os
import re
import shutil
import subprocess
import sys
from typing import Dict, Iterable, Iterator, List, Optional

# The smallest kernel of Debian that has uhid, hidraw and hid-wiimote.
DEFAULT_KERNEL = 'linux-image-cloud-amd64'

QEMU_PACKAGES = ['qemu-system-x86', 'qemu-system-common', 'qemu-system-data', 'seabios']
LIBRARY_FOLDER = 'usr/lib/x86_64-linux-gnu'


class Unavailable(Exception):
    """The packages are not available on this machine; the text says why."""


class Parts:
    """Paths of the parts of a guest."""

    def __init__(self, folder: str, kernel_package: str, packages: Iterable[str] = ()):
        self.package_folders = {package: os.path.join(folder, package) for package in packages}
        self.tools = os.path.join(folder, 'tools')
        self.kernel_folder = os.path.join(folder, kernel_package)
        self.busybox = os.path.join(self.tools, 'bin', 'busybox')
        self.qemu = os.path.join(self.tools, 'usr', 'bin', 'qemu-system-x86_64')

    @property
    def kernel(self) -> str:
        return glob.glob(os.path.join(self.kernel_folder, 'boot', 'vmlinuz-*'))[0]

    def qemu_command(self) -> List[str]:
        """The start of QEMU's command line."""
        share = os.path.join(self.tools, 'usr', 'share')
        return [self.qemu, '-L', os.path.join(share, 'qemu'), '-L', os.path.join(share, 'seabios')]

    def qemu_environment(self) -> Dict[str, str]:
        libraries = [os.path.join(self.tools, LIBRARY_FOLDER),
                     os.path.join(self.tools, 'lib/x86_64-linux-gnu')]
        return dict(os.environ, LD_LIBRARY_PATH=':'.join(libraries),
                    QEMU_MODULE_DIR=os.path.join(self.tools, LIBRARY_FOLDER, 'qemu'))


def cache_folder() -> str:
    """$WIIMOTE_TRACKER_REAL_KERNEL, or a folder in the user's cache."""
    folder = os.environ.get('WIIMOTE_TRACKER_REAL_KERNEL')
    if not folder:
        cache = os.environ.get('XDG_CACHE_HOME') or os.path.expanduser('~/.cache')
        folder = os.path.join(cache, 'wiimote_tracker', 'real_kernel')
    return os.path.abspath(folder)


class Apt:
    """The packages of this machine's sources. `options` may select other package lists."""

    def __init__(self, options: Iterable[str] = ()):
        self._options = list(options)

    def _run(self, program: str, arguments: List[str], folder: Optional[str] = None) -> str:
        command = [program] + self._options + arguments
        done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              stdin=subprocess.DEVNULL, universal_newlines=True,
                              env=dict(os.environ, LC_ALL='C'))
        if done.returncode != 0:
            lines = [line for line in done.stderr.splitlines() if line.startswith('E:')]
            reason = lines[0] if lines else done.stderr.strip()[-200:]
            raise Unavailable(f'{program} {arguments[0]}: {reason}')
        return done.stdout

    def update(self) -> None:
        self._run('apt-get', ['update'])

    def kernel_behind(self, package: str) -> str:
        """The kernel package that a "latest kernel" package depends on."""
        depends = self._run('apt-cache', ['depends', package])
        images = re.findall(r'Depends: (linux-image-\d\S*)', depends)
        return images[0] if images else package

    def missing_for(self, package: str) -> List[str]:
        """The packages that installing `package` would install, itself included."""
        plan = self._run('apt-get', ['install', '-s', '--no-install-recommends', package])
        return re.findall(r'^Inst (\S+)', plan, re.MULTILINE)

    def download(self, packages: List[str], folder: str) -> List[str]:
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        # apt warns that its own user, _apt, cannot write here; that does no harm.
        self._run('apt-get', ['-o', 'Acquire::Retries=3', '-o', 'Acquire::http::Timeout=30',
                              'download'] + packages, folder)
        return glob.glob(os.path.join(folder, '*.deb'))


def own_lists(folder: str) -> List[str]:
    """Options for package lists in `folder`, for machines whose lists are missing or out of
    date."""
    lists = os.path.join(folder, 'lists')
    os.makedirs(os.path.join(lists, 'partial'), exist_ok=True)
    os.makedirs(os.path.join(folder, 'archives', 'partial'), exist_ok=True)
    return ['-o', 'Dir::State::lists=' + lists, '-o', 'Dir::Cache=' + folder]


def unpack(archives: Iterable[str], folder: str) -> None:
    """Unpacks Debian packages; an interruption leaves no partial folder."""
    partial = folder + '.partial'
    shutil.rmtree(partial, ignore_errors=True)
    for archive in archives:
        subprocess.check_call(['dpkg-deb', '-x', archive, partial])
    # Debian 13's packages have everything below usr, where installed systems have these links.
    for name in ('bin', 'lib'):
        if not os.path.isdir(os.path.join(partial, name)):
            os.symlink(os.path.join('usr', name), os.path.join(partial, name))
    shutil.rmtree(folder, ignore_errors=True)
    os.rename(partial, folder)


def fetch_missing(parts: Parts, folder: str, kernel_package: str, apt: Apt) -> None:
    downloads = os.path.join(folder, 'downloads')
    if not os.path.isdir(parts.tools):
        packages = set(QEMU_PACKAGES + ['busybox-static'] + apt.missing_for('qemu-system-x86'))
        unpack(apt.download(sorted(packages), downloads), parts.tools)
    if not os.path.isdir(parts.kernel_folder):
        kernel = apt.kernel_behind(kernel_package)
        unpack(apt.download([kernel], downloads), parts.kernel_folder)
    for package, package_folder in parts.package_folders.items():
        if not os.path.isdir(package_folder):
            needed = set([package] + apt.missing_for(package))
            unpack(apt.download(sorted(needed), downloads), package_folder)
    shutil.rmtree(downloads, ignore_errors=True)


def has_uhid(parts: Parts) -> bool:
    """Whether the kernel can have virtual remotes; Debian 11's smallest cannot."""
    for config in glob.glob(os.path.join(parts.kernel_folder, 'boot', 'config-*')):
        with open(config, encoding='utf-8') as file:
            return 'CONFIG_UHID=' in file.read()
    return False


def works(parts: Parts) -> bool:
    """Whether QEMU starts: it also uses libraries of the machine, which may have changed."""
    try:
        return subprocess.call([parts.qemu, '--version'], env=parts.qemu_environment(),
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0
    except OSError:
        return False


@contextlib.contextmanager
def locked(folder: str) -> Iterator[None]:
    """Locks the cache folder against other processes."""
    with open(os.path.join(folder, 'lock'), 'w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def fetch(kernel_package: str = DEFAULT_KERNEL, packages: Iterable[str] = ()) -> Parts:
    """Downloads what the cache does not have; each of `packages`, for the guest, has a folder of
    its own, with what it needs that this machine lacks. Raises Unavailable."""
    for program in ('apt-get', 'dpkg', 'dpkg-deb'):
        if not shutil.which(program):
            raise Unavailable(f'{program} is missing: the kernel comes from Debian')
    architecture = subprocess.check_output(['dpkg', '--print-architecture'],
                                           universal_newlines=True).strip()
    if architecture != 'amd64':
        raise Unavailable(f'this is a {architecture} machine, the guest is amd64')
    folder = cache_folder()
    parts = Parts(folder, kernel_package, packages)
    try:
        os.makedirs(folder, exist_ok=True)
        with locked(folder):
            if os.path.isdir(parts.tools) and not works(parts):
                shutil.rmtree(parts.tools)
            try:
                fetch_missing(parts, folder, kernel_package, Apt())
            except Unavailable as first:
                try:
                    apt = Apt(own_lists(os.path.join(folder, 'apt')))
                    apt.update()
                    fetch_missing(parts, folder, kernel_package, apt)
                except Unavailable as second:
                    raise Unavailable(f'{first}; and with updated package lists: {second}')
    except (OSError, subprocess.CalledProcessError) as error:
        raise Unavailable(f'{error} (cache folder {folder})')
    if not works(parts):
        raise Unavailable(f'QEMU does not start: {parts.qemu}')
    if not has_uhid(parts):
        raise Unavailable(f'the kernel of {kernel_package} has no uhid')
    return parts


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('kernel', nargs='?', default=DEFAULT_KERNEL, metavar='KERNEL_PACKAGE',
                        help='default: %(default)s')
    try:
        print(fetch(parser.parse_args().kernel).kernel)
    except Unavailable as problem:
        sys.exit(str(problem))
