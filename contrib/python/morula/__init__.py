# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Reads, runs, draws and reports simulations of Morula.

    from morula import Scene, Function, map
    scene = Scene("bud.prm")
    scene["Proliferation/Cell cycle/Size checkpoint"] = 0.9
    run = scene.run()                 # output/bud; Ctrl-C saves
    run.cells(4.0)["energy_density"].mean()

`Scene` is a scene that can be changed and run, `Run` a run, `Function` a scene
as a function of some of its keys, and `map` does many runs: doc/python.md.

`execute` starts the program, for all tools and tests. `program` is the
executable, `scene` what a .prm file says, `ladder` which keys take which
values, `kept_runs` runs what is not there yet, `served` does runs in forks of
one process, and `record` keeps what a run cost; `command_line` and `style` are
what the tools have in common. Mistakes of the user raise `refusal.Refused`. The
tools: `report`, `render` (pictures, by `draw`), `shapes`, `images`, `sweep`
and `accuracy`; `__main__` starts them.
"""
from .refusal import Refused

__all__ = ["Function", "Refused", "Run", "Scene", "map"]


def __getattr__(name):  # tools start sooner without what they do not need
    import importlib
    if name in ("Function", "Run", "Scene", "map"):
        return getattr(importlib.import_module("morula.api"), name)
    raise AttributeError(f"module 'morula' has no attribute '{name}'")
