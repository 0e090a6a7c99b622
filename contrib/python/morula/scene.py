# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""A scene, its keys, and the overrides it is always run with."""
import difflib
from pathlib import Path

from .refusal import Refused


class Scene:
    """A .prm file that the program accepts, with overrides of the user's."""

    def __init__(self, path, program, overrides=()):
        self.path = Path(path)
        self.program = program
        if not self.path.is_file():
            raise Refused("The scene", path, "a .prm file that can be read", "Correct its name.")
        self.overrides = tuple(read_override(text) for text in overrides)
        self.explained = program.explain(self.path, self.overrides)
        self.known = program.keys_with(self.path, self.overrides)
        self.keys = {**self.explained["keys"],
                     "Output directory": dict(self.overrides).get("Output directory", "")}

    @property
    def name(self):
        return self.path.stem

    @property
    def dimension(self):
        return int(self.keys["Dimension"])

    def __getitem__(self, key):
        return self.keys[key]

    def number(self, key):
        return float(self.keys[key])

    def require_key(self, key, option):
        """Refuses a key that this scene cannot have."""
        known = [one.path for one in self.known]
        if key in known:
            return
        near = difflib.get_close_matches(key, known, 1)
        raise Refused(option, key, "a key that exists",
                      (f"Did you mean '{near[0]}'? " if near else "")
                      + f"'morula {self.path.name} --parameters' prints them all.")


def read_override(text):
    key, equals, value = text.partition("=")
    if not equals:
        raise Refused("-s", text, '"Section/Key=value"', "Put '=' between the key and its value.")
    return clean_path(key), value.strip()


def clean_path(key):
    return "/".join(name.strip() for name in key.split("/"))


def normal(value):
    """A value so written that equal values are equal: '50.0' as '50', lists number by number."""
    words = [word.strip() for word in value.split(",")]
    try:
        return ",".join(format(float(word), ".15g") for word in words)
    except ValueError:
        return " ".join(value.split())


def as_number(value):
    """The value as a number, or None."""
    try:
        return float(value)
    except ValueError:
        return None
