# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The executable: what it accepts, and how it is called."""
import functools
import hashlib
import json
import os
import tempfile
from pathlib import Path

from . import execute
from .keys import defaults_with, read_keys
from .refusal import Refused


@functools.lru_cache(maxsize=None)
def _digest(file, *_):
    return hashlib.sha256(file.read_bytes()).hexdigest()


class Program:
    """build/morula, or another one."""

    def __init__(self, executable, mpiexec="mpiexec"):
        self.executable = Path(executable).resolve()
        self.mpiexec = mpiexec
        if not os.access(self.executable, os.X_OK) or self.executable.is_dir():
            raise Refused("--morula", executable, "an executable",
                          "contrib/build makes build/morula.")

    @property
    def digest(self):
        """Tells this build of the program from every other one, now: somebody
        may build it anew while runs go on."""
        about = self.executable.stat()
        return _digest(self.executable, about.st_ino, about.st_size, about.st_mtime_ns)

    @functools.cached_property
    def keys(self):
        """Every key, in order."""
        return read_keys(self._run("--parameters=json").stdout)

    @functools.cached_property
    def defaults(self):
        """Every key by its full path, with its default as text."""
        return {key.path: key.default for key in self.keys}

    def keys_with(self, scene, overrides=()):
        """The same, and those of the types, fields and obstacles that a scene names."""
        return read_keys(self._run("--parameters=json", scene, *execute.overrides(overrides),
                                   scene=scene).stdout)

    def complete(self, written, keys=None):
        """All keys of a scene that sets these: path -> value as text."""
        method = written.get("Method", self.defaults.get("Method"))
        return {**defaults_with(keys or self.keys, method), **written}

    @functools.cached_property
    def version(self):
        return self._run("--version").stdout.strip()

    def command(self, scene, overrides, ranks=1):
        """The words of a run with these (key, value) overrides."""
        return execute.command(self.executable, scene, *execute.overrides(overrides), ranks=ranks,
                               mpiexec=self.mpiexec)

    def explain(self, scene, overrides=(), server=None):
        """Has the program check a scene; raises its own message if it does
        not accept it, and returns what it says of it: --explain=json as a
        dictionary. A served.Server answers sooner."""
        with tempfile.TemporaryDirectory() as scratch:
            directory = ("Output directory", f"{scratch}/output")
            words = self.command(scene, [*overrides, directory])
            result = (server or execute).call([*words, "--explain=json"])
        if result.code != 0:
            shown = ", ".join(f"{key}={value}" for key, value in overrides)
            message = result.stderr.strip().removeprefix("morula: ")
            raise Refused(f"{scene}{' with ' * bool(shown)}{shown} is refused: {message}")
        return json.loads(result.stdout)

    def _run(self, *arguments, scene=None):
        result = execute.call([self.executable, *arguments])
        if result.code != 0:
            message = result.stderr.strip().removeprefix("morula: ")
            raise Refused(f"{scene} is refused: {message}" if scene else
                          f"{self.executable} does not work: {message}")
        return result
