from setuptools import find_packages, setup

from catkin_pkg.python_setup import generate_distutils_setup

FOLDERS = 'body_motion', 'evaluation', 'python', 'rig_planning'
found = {name: folder for folder in FOLDERS for name in find_packages(folder)}
setup(**generate_distutils_setup(
    packages=sorted(found),
    package_dir={name: f'{folder}/{name}' for name, folder in found.items() if '.' not in name}))
