# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A scene as a function of some keys, for inference and sensitivity."""
from __future__ import annotations

import functools
import inspect
import math
import warnings
import weakref
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from morula import scene as scenes
from morula.kept_runs import Job, KeptRuns, job_name, with_snapshots
from morula.ladder import MAX_RUNS
from morula.measures import read_measure
from morula.refusal import Refused
from morula.served import Server

from .run import Run
from .scene import Scene, as_text

if TYPE_CHECKING:
    import pandas


class Function:
    """What a scene gives as a function of some of its keys.

        f = Function(scene, {"rate": "Proliferation/Cell cycle/G0 exit rate"},
                     lambda run: run.statistics["cells"].iloc[-1])
        f(rate=0.5), f(0.5), f([0.5]), f({"rate": 0.5})

    parameters: names and the paths of keys, or paths alone; a tuple of paths
    changes several keys together. Or a function of the parameters, by its
    arguments' names, that returns a dictionary of keys: for units, logarithms,
    and expressions of several parameters. measure(run) returns a number or an array, or is
    the name of a measure of morula accuracy, "zmax" or "cells:p90(volume)", or a list of them.
    Runs are kept in `directory`: the same point is not run twice, by nobody, and
    what was interrupted goes on. A run that fails, or that the program refuses,
    gives nan of the shape of the others; a measure that throws is not caught.

    The random numbers of a cell depend on the seed and its lineage alone, so two
    points with the same seed are compared with common random numbers."""

    def __init__(self, scene: Scene,
                 parameters: Mapping[str, Any] | Sequence[str]
                 | Callable[..., Mapping[str, Any]],
                 measure: Callable[[Run], Any] | str | Sequence[str], *,
                 directory: str | Path | None = None, ranks: int = 1):
        self.scene = scene
        self._keys = parameters if callable(parameters) else None
        if self._keys:
            parameters = list(inspect.signature(self._keys).parameters)
        self.parameters = dict(parameters) if isinstance(
            parameters, Mapping) else {path: path for path in parameters}
        self.measure = _measured(measure, scene)
        self.directory = Path(directory or Path("output") / f"{scene.name}-runs")
        self.ranks = ranks
        self._shape: tuple[int, ...] = ()
        self._servers: list[Server] = []
        weakref.finalize(self, _close, self._servers)
        for target in () if self._keys else self.parameters.values():
            for path in [target] if isinstance(target, str) else target:
                scene.about(path)

    def __call__(self, *values: Any, **named: Any) -> Any:
        """The measure at a point: numbers in the order of the parameters, one
        sequence or mapping of them, or by name."""
        return self.map([self._point(values, named)])[0]

    def map(self, points: Iterable[Any], *, jobs: int = 1, progress: bool = False) -> np.ndarray:
        """The measures at several points, so many runs at the same time, in their order."""
        all_points = [self._point((point,), {}) for point in points]
        if len(all_points) > MAX_RUNS:
            raise Refused("The number of points", len(all_points), f"at most {MAX_RUNS} at once")
        records = self._records(all_points, jobs, progress)
        found = [self.measure(Run(record.output)) if record.finished else None
                 for record in records]
        for point, record in zip(all_points, records):
            if not record.finished:
                warnings.warn(f"nan at {point}: the run {record.summary()}", stacklevel=2)
        shapes = [np.shape(value) for value in found if value is not None]
        if shapes:
            self._shape = shapes[0]
        missing = np.full(self._shape, math.nan)
        return np.array([missing if value is None else value for value in found])

    def run(self, *values: Any, **named: Any) -> Run:
        """The run at a point. Throws RuntimeError if it failed."""
        record, = self._records([self._point(values, named)], 1, False)
        if not record.finished:
            raise RuntimeError(f"The run {record.summary()}")
        return Run(record.output)

    def _point(self, values: tuple, named: Mapping) -> dict[str, Any]:
        if len(values) == 1 and isinstance(values[0], Mapping):
            values, named = (), {**values[0], **named}
        elif len(values) == 1 and np.ndim(values[0]) == 1:
            values = tuple(values[0])
        point = {**dict(zip(self.parameters, values)), **named}
        if (set(point) != set(self.parameters) or len(values) > len(self.parameters)):
            raise Refused("The point", point or values, "a value for each of "
                          + ", ".join(self.parameters))
        return {name: point[name] for name in self.parameters}

    def keys_at(self, point: Mapping[str, Any]) -> dict[str, str]:
        """The keys that a point changes, with their values as text."""
        keys: dict[str, Any] = dict(self._keys(**point)) if self._keys else {}
        for name, value in () if self._keys else point.items():
            target = self.parameters[name]
            keys.update(dict.fromkeys([target] if isinstance(target, str) else target, value))
        return {scenes.clean_path(key): as_text(value) for key, value in keys.items()}

    def _records(self, points, jobs, progress):
        """Records of the kept runs at points."""
        if not points:
            return []
        while self.ranks == 1 and len(self._servers) < min(jobs, len(points)):
            self._servers.append(Server(self.scene.program.executable))
        kept = KeptRuns(self._inner, self.directory / "runs", self.ranks, jobs, resume=True,
                        say=print if progress else lambda _: None, servers=self._servers)
        wanted = [_job(self._inner, self.keys_at(point)) for point in points]
        unique = {job.name: job for job in wanted}
        found = dict(zip(unique, kept.run(list(unique.values()))))
        return [found[job.name] for job in wanted]

    @functools.cached_property
    def _inner(self) -> scenes.Scene:
        """The scene as the tools have it, which the program has accepted."""
        self.directory.mkdir(parents=True, exist_ok=True)
        scene = self.scene
        file = scene.path or scene.save(self.directory / f"{scene.name}.prm")
        overrides = scene._overrides() if scene.path else ()
        return scenes.Scene(file, scene.program, [f"{key}={value}" for key, value in overrides])


def _measured(what, scene):
    """A function of a run, from one or from names of measures."""
    if callable(what):
        return what
    keys = scene.program.complete(scene._written(), list(scene._known.values()))
    if isinstance(what, str):
        return read_measure(what, keys, "The measure").evaluate
    measures = [read_measure(name, keys, "The measure") for name in what]
    return lambda run: np.array([measure.evaluate(run) for measure in measures])


def _close(servers: list[Server]) -> None:
    for server in servers:
        server.close()


def _job(inner, keys):
    special = list(keys.items())
    overrides = (*inner.overrides, *special, *with_snapshots({**inner.keys, **keys}))
    return Job(job_name(special, overrides), overrides, ("cells", "surface", "snapshot"))


def map(scene: Scene, samples: "pandas.DataFrame | Iterable[Mapping]",
        measure: Callable[[Run], Mapping[str, Any] | Any] | str | Sequence[str], *,
        directory: str | Path | None = None, jobs: int = 1, ranks: int = 1,
        progress: bool = True) -> "pandas.DataFrame":
    """Runs a scene at samples, a data frame whose columns are paths of keys, and returns it with
    what was measured besides: measure(run) gives a dictionary of columns, or one number, the
    column `measure`; names of measures give columns of these names. Rows whose run fails have
    nan. Runs are kept as those of Function are."""
    import pandas
    table = pandas.DataFrame(samples).reset_index(drop=True)
    texts = [] if callable(measure) else [measure] if isinstance(measure, str) else measure
    of_run = _measured(texts or measure, scene)
    names: list[str] = []

    def numbers(run):
        found = dict(zip(texts, of_run(run))) if texts else of_run(run)
        found = dict(found) if isinstance(found, Mapping) else {"measure": found}
        names[:] = names or list(found)
        return [found[name] for name in names]

    function = Function(scene, list(table), numbers, directory=directory, ranks=ranks)
    values = function.map(table.to_dict("records"), jobs=jobs, progress=progress)
    measured = values if names else np.empty((len(table), 0))
    return table.join(pandas.DataFrame(measured, columns=names))
