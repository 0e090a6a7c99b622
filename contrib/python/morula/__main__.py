# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Starts a tool: python3 -m morula TOOL WORDS..., or morula-TOOL WORDS...

A tool is a module with a function main(), which returns the exit code. It is imported only here,
so that what it says of a missing library is said wherever that happens."""
import argparse
import importlib
import sys
from functools import partialmethod
from pathlib import Path

TOOLS = {  # those of an installation, then those that need Morula's tree, from
    # parameters on those of contrib/upkeep
    "accuracy": "morula.accuracy.tool", "cell-shapes": "morula.shapes.tool",
    "export": "morula.export.tool", "import": "morula.images.tool",
    "render": "morula.render.tool", "report": "morula.report.tool", "sweep": "morula.sweep.tool",
    "reproduce": "reproduction.tool", "parameters": "upkeep.parameters",
    "man-pages": "upkeep.man_pages", "renew": "upkeep.renew", "showcase": "upkeep.showcase.tool",
    "benchmark": "tests.benchmarks.tool"}

PACKAGES = {"vtkmodules": "python3-vtk9 (or python3-paraview)", "numpy": "python3-numpy",
            "scipy": "python3-scipy", "matplotlib": "python3-matplotlib", "PIL": "python3-pil",
            "h5py": "python3-h5py", "pandas": "python3-pandas", "jinja2": "python3-jinja2",
            "skimage": "python3-skimage", "tifffile": "python3-tifffile", "zarr": "python3-zarr"}
SYSTEM_PYTHON = "/usr/bin/python3"


def missing(error):
    """What to say of an ImportError: which of Debian's packages has the
    library. None if it is not one of them."""
    package = PACKAGES.get((error.name or "").partition(".")[0])
    if package is None:
        return None
    text = (f"{error}. Debian's package {package} has it; contrib/setup installs what is missing.")
    if not sys.executable.startswith(SYSTEM_PYTHON):
        text += (f" This is {sys.executable}, which does not see Debian's "
                 f"packages: {SYSTEM_PYTHON} does.")
    return text


def main():
    """Runs the tool that this process is named after, or its first word."""
    called = Path(sys.argv[0]).name
    name = called.removeprefix("morula-")
    if name not in TOOLS:
        del sys.argv[0]
        called = sys.argv[0] if sys.argv else ""
        name = called.removeprefix("morula-")
    if name not in TOOLS:
        return f"morula: there is no tool '{name}'; there are " + ", ".join(TOOLS)
    sys.argv[0] = name
    if TOOLS[name].startswith("morula."):
        called = f"morula {name.removeprefix('cell-')}"
    else:  # of Morula's tree alone
        folder = "contrib/upkeep" if TOOLS[name].startswith(("upkeep", "tests")) else "contrib"
        called = f"{folder}/{name}"
    # By itself argparse names the last part of a path alone.
    argparse.ArgumentParser.__init__ = partialmethod(argparse.ArgumentParser.__init__, prog=called)
    try:
        return importlib.import_module(TOOLS[name]).main()
    except ImportError as error:
        if missing(error) is None:
            raise
        return f"{name}: {missing(error)}"


if __name__ == "__main__":
    sys.exit(main())
