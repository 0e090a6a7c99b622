# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What a tool says when a library for Python is missing. Some are loaded only
when they are needed, so that this is said wherever it happens."""
import sys

PACKAGES = {"vtkmodules": "python3-vtk9 (or python3-paraview)",
            "numpy": "python3-numpy", "scipy": "python3-scipy",
            "matplotlib": "python3-matplotlib", "PIL": "python3-pil",
            "h5py": "python3-h5py", "pandas": "python3-pandas"}
SYSTEM_PYTHON = "/usr/bin/python3"


def explain_missing(tool):
    """From now on, a missing library ends the tool with a sentence that names
    Debian's package, and exit code 1; all other errors are as before."""
    before = sys.excepthook

    def hook(kind, error, trace):
        sentence = missing(error) if issubclass(kind, ImportError) else None
        if sentence is None:
            before(kind, error, trace)
        else:
            print(f"{tool}: {sentence}", file=sys.stderr)

    sys.excepthook = hook


def missing(error):
    """The sentence, or None if the module is none of another package."""
    package = PACKAGES.get((error.name or "").partition(".")[0])
    if package is None:
        return None
    text = (f"{error}. Debian's package {package} has it; contrib/setup "
            "installs what is missing.")
    if not sys.executable.startswith(SYSTEM_PYTHON):
        text += (f" This is {sys.executable}, which does not see Debian's "
                 f"packages: {SYSTEM_PYTHON} does.")
    return text
