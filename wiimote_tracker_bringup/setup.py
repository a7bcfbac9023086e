from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(
    packages=['wiimote_tracker_evaluation', 'wiimote_tracker_evaluation.faults',
              'wiimote_tracker_evaluation.foreign', 'wiimote_tracker_evaluation.page',
              'wiimote_tracker_evaluation.live', 'wiimote_tracker_evaluation.motion',
              'wiimote_tracker_evaluation.ours', 'wiimote_tracker_evaluation.planning',
              'wiimote_tracker_evaluation.sections'],
    package_dir={'': 'evaluation'}))
