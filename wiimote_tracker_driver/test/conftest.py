"""Lets the tests use what is in the folder of the scripts."""

import importlib.machinery
import importlib.util
import os
import sys

SCRIPTS = os.path.join(os.path.dirname(os.path.realpath(__file__)), '../scripts')
sys.dont_write_bytecode = True
sys.path.insert(0, SCRIPTS)


def load(name):
    """A program, whose name has no ending, as a module."""
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(SCRIPTS, name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module
