"""What roslaunch reads in a launch file."""

import os

import roslaunch.config
import roslaunch.xmlloader

LAUNCH = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../launch')


def configuration(name, *arguments):
    """Of a file in the folder launch. roscore's own file is left out: to load it, roslaunch runs
    programs."""
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(os.path.join(LAUNCH, name), config, argv=list(arguments),
                                         verbose=False)
    config.assign_machines()
    return config


def load(name, *arguments):
    """Nodes by name, and parameters."""
    config = configuration(name, *arguments)
    return ({node.name: node for node in config.nodes},
            {name: parameter.value for name, parameter in config.params.items()})
