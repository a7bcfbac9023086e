from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=['wiimote_tracker_launch'], package_dir={'': 'python'}))
