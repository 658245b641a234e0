"""Every family of functions, so that all of them are in the registry: the modules of this folder and those below it.

A process that is sent a program needs the few that the program calls, and does not import this module.
"""

from importlib import import_module
from pkgutil import walk_packages

import xlmc.excel.functions
from xlmc.excel.functions.registry import REGISTRY, function_named

__all__ = ["REGISTRY", "function_named"]

for _module in walk_packages(xlmc.excel.functions.__path__, "xlmc.excel.functions."):
    import_module(_module.name)
