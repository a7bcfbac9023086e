"""Programs whose names have no ending, as modules."""

import importlib.machinery
import importlib.util
import os

PACKAGE = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..')


def load(path):
    """The module of a program. path: from the folder of this package."""
    loader = importlib.machinery.SourceFileLoader(os.path.basename(path),
                                                  os.path.join(PACKAGE, path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module
