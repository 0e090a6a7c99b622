# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A scene that can be changed, explained and run."""
from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from morula import scene
from morula.places import MORULA
from morula.program import Program
from morula.refusal import Refused

from .run import Run
from .running import run_scene


def as_text(value: Any) -> str:
    """A value as a .prm file has it: True is true, 3.0 is 3, a list has commas."""
    value = value.tolist() if hasattr(value, "tolist") else value  # of NumPy
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return ", ".join(map(as_text, value))
    if isinstance(value, float) and value.is_integer() and abs(value) < 2**53:
        return str(int(value))
    return str(value)


@functools.lru_cache(maxsize=None)
def program(executable: str) -> Program:
    """The Program of an executable, which is asked for its keys once."""
    return Program(executable)


class Scene(Mapping):
    """Keys and values of a scene, by full path ("Grid/Spacing").

        scene = Scene("bud.prm")                  # a file
        scene = Scene({"Tissue/Radius": 80})      # or keys alone
        scene["Time/End time"] = 2                # changes this object

    Reading gives the value as text, the default where the scene says nothing.
    Files that keys name are searched in the working directory, then beside the
    .prm file. `name` is that of the output directory.

    Throws Refused for a file that cannot be read and for keys that do not exist.
    """

    def __init__(self, source: str | Path | Mapping[str, Any], *, name: str | None = None,
                 morula: str | Path = MORULA):
        self.program = program(str(morula))
        self.path: Path | None = None
        self._set: dict[str, str] = {}
        self._in_file: dict[str, str] = {}
        if isinstance(source, Scene):
            self.path, self._set, self._in_file = source.path, dict(source._set), source._in_file
            name = name or source.name
        elif isinstance(source, Mapping):
            self._set = {scene.clean_path(key): as_text(value) for key, value in source.items()}
        else:
            self.path = Path(source)
            if not self.path.is_file():
                raise Refused("The scene", source, "a .prm file that can be "
                              "read", "Correct its name.")
            self._in_file = {key.path: key.value for key in self.program.keys_with(self.path)
                             if key.value is not None}
        self.name = name or (self.path.stem if self.path else "scene")
        self._known = self._find_known()
        for key in self._set:
            self._require(key)

    def _written(self) -> dict[str, str]:
        return {**self._in_file, **self._set}

    def _find_known(self) -> dict[str, Any]:
        """The keys that there are, of types, fields and obstacles, too."""
        if not any(key.endswith("/Names") for key in self._written()):
            return {key.path: key for key in self.program.keys}
        with self._file() as file:
            found = self.program.keys_with(file, self._overrides())
        return {key.path: key for key in found}

    def _require(self, key: str) -> None:
        if key not in self._known:
            near = scene.difflib.get_close_matches(key, self._known, 1)
            raise Refused("The key", key, "a key that exists",
                          f"Did you mean '{near[0]}'?" if near else "")

    def __getitem__(self, key: str) -> str:
        key = scene.clean_path(key)
        self._require(key)
        return self.program.complete(self._written(), list(self._known.values()))[key]

    def __setitem__(self, key: str, value: Any) -> None:
        key = scene.clean_path(key)
        before = dict(self._set)
        self._set[key] = as_text(value)
        try:
            if key.endswith("/Names"):
                self._known = self._find_known()
            self._require(key)
        except Refused:
            self._set = before
            raise

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def about(self, key: str):
        """What is known of a key: type, unit, allowed, choices, meaning, evaluated, variables."""
        self._require(scene.clean_path(key))
        return self._known[scene.clean_path(key)]

    def with_keys(self, keys: Mapping[str, Any]) -> "Scene":
        """A copy in which these keys have these values."""
        copy = Scene(self, morula=self.program.executable)
        for key, value in keys.items():
            copy[key] = value
        return copy

    def text(self) -> str:
        """The scene as a .prm file."""
        from morula.images.writing import prm as written
        return written(self._written(), [self.name])

    def save(self, file: str | Path) -> Path:
        """Writes the scene as a .prm file."""
        Path(file).write_text(self.text(), encoding="utf-8")
        return Path(file)

    def _file(self):
        """A context with a .prm file of the scene, less what _overrides() says."""
        from .running import scene_file
        return scene_file(self)

    def _overrides(self) -> tuple[tuple[str, str], ...]:
        return tuple(self._set.items())

    def explain(self) -> dict[str, Any]:
        """What the program says of the scene before a run: --explain=json, a
        dictionary with cells, boundary points, effects, columns, size,
        warnings, keys. Throws Refused for a scene that makes no sense."""
        with self._file() as file:
            return self.program.explain(file, self._overrides())

    def run(self, directory: str | Path | None = None, *, ranks: int = 1,
            progress: bool = True, again: bool = False) -> Run:
        """Runs the scene to its end in a directory, default output/NAME.

        A run of the same scene that is there already is given back if it is finished, and goes on
        from its snapshot if not; again=True begins anew. Ctrl-C (in a notebook: interrupt) lets
        the program save its state, and raises KeyboardInterrupt: the same call then goes on.

        Throws Refused for a scene that makes no sense, or a directory with a run of another scene,
        and RuntimeError with the program's last words if the run fails."""
        return run_scene(self, Path(directory or Path("output") / self.name),
                         ranks, progress, again)

    def __repr__(self) -> str:
        changed = ", ".join(f"{key} = {value}" for key, value in self._set.items())
        return f"<Scene {self.name!r}" + (f": {changed}>" if changed else ">")

    def _repr_html_(self) -> str:
        import html
        rows = "".join(
            f"<tr><td>{html.escape(key)}</td><td>{html.escape(value)}</td>"
            f"<td>{html.escape(self._known[key].unit)}</td></tr>"
            for key, value in self._written().items() if key in self._known)
        return (f"<table><caption>Scene {html.escape(self.name)}</caption>" f"{rows}</table>")
