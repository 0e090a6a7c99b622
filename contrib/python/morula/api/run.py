# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A run, as people look at it."""
from __future__ import annotations

import html
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from morula import execute, run
from morula.refusal import Refused

if TYPE_CHECKING:
    import pandas

MARK = "# state: finished"


class Picture:
    """A picture as PNG; a notebook shows it. `data` are its bytes."""

    def __init__(self, data: bytes):
        self.data = data

    def _repr_png_(self) -> bytes:
        return self.data

    def save(self, file: str | Path) -> None:
        """Writes the PNG file."""
        Path(file).write_bytes(self.data)


class Run(run.Run):
    """The output directory of a run, finished or not. Tables are data frames of pandas with the
    columns of the files (doc/glossary.md); lengths in um, times in days, stresses in kPa.

    `statistics`: a row a step. `lineage`: every cell that ever lived. `events`: changes of type,
    deaths, removals. `timings`: what took how long. `errors`: error bars that
    morula accuracy has found. `keys`: all keys as used. `times`: days on
    which cells were written. `surface(i)`: the boundary points of state i.

    Throws morula.Refused if the directory is none of a run."""

    def __init__(self, directory: str | Path):
        super().__init__(directory)

    def cells(self, t: float | None = None) -> "pandas.DataFrame":
        """The cells on day t, in order of their ids; without it those of the
        last state written. Throws Refused for a day on which none was written,
        and NoStates with Output/Formats = none."""
        return super().cells(-1) if t is None else self.at("cells", t)

    @property
    def finished(self) -> bool:
        """Whether the run has come to its end."""
        with (self.directory / "parameters.prm").open(encoding="utf-8") as file:
            return any(line.startswith(MARK) for line, _ in zip(file, range(5)))

    @property
    def time(self) -> float:
        """The last day that was computed."""
        return float(self.statistics["time"].iloc[-1])

    def show(self, field: str | None = None, t: float | None = None,
             panels: int = 2, width: int = 500) -> Picture:
        """Draws the cells, coloured by a column (None: their type where there are types, else
        their volume), from outside and cut open (panels=1: from outside alone). In a notebook the
        picture is shown. Throws Refused for what morula render refuses."""
        with tempfile.TemporaryDirectory() as scratch:
            file = Path(scratch) / "cells.png"
            words = [sys.executable, "-P", "-m", "morula", "render", self.directory.resolve(),
                     "--panels", panels, "--width", width, "--output", file]
            if field is not None:
                words += ["--field", field]
            if t is not None:
                words += ["--time", t]
            import morula
            path = str(Path(morula.__file__).parents[1])
            ended = execute.call(words, env={"PYTHONPATH": path}, stderr=subprocess.PIPE)
            if ended.code:
                raise Refused("The picture", f"{field}, {panels} panels",
                              "what morula render draws", ended.stderr.strip())
            return Picture(file.read_bytes())

    def _about(self) -> dict[str, str]:
        last = self.statistics.iloc[-1]
        unit = f"µm{'²' if self.dimension == 2 else '³'}"
        return {"state": ("finished" if self.finished else "not finished")
                + f", day {last['time']:g} after {int(last['step'])} steps",
                "cells": f"{int(last['cells']):,}",
                "total volume": f"{last['total_volume']:.5g} {unit}",
                "mean energy density": f"{last['mean_energy_density']:.4g} kPa"}

    def __repr__(self) -> str:
        about = self._about()
        return (f"<Run {str(self.directory)!r}: {about['state']}, " f"{about['cells']} cells>")

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{name}</th><td>{html.escape(text)}</td></tr>"
                       for name, text in self._about().items())
        return (f"<table><caption>Run {html.escape(str(self.directory))}</caption>{rows}</table>")
