# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The keys that a program knows, from what `morula --parameters=json` prints."""
import json
from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """path: full, separated by '/'. type: a word of ParameterKeys::print_json: number, expression,
    file, ... allowed: a noun phrase, or empty for expressions and texts. choices: the words to
    choose from. value: what a scene sets, or None. former: paths that it had. paper: its default with Method = paper, or None where
    that is the same. evaluated, variables: of an expression."""

    path: str
    default: str
    unit: str
    allowed: str
    meaning: str
    former: tuple = ()
    paper: str = None
    type: str = "text"
    choices: tuple = ()
    components: int = 1
    evaluated: str = ""
    variables: tuple = ()
    value: str = None


def read_keys(text):
    """All keys of the output of `morula --parameters=json`, in order."""
    return [Key(key["path"], key["default"], key["unit"], key["allowed"], key["meaning"],
                tuple(key.get("formerly", ())), key.get("default by method", {}).get("paper"),
                key["type"], tuple(key.get("choices", ())), key.get("components", 1),
                key.get("evaluated", ""), tuple(key.get("variables", ())), key.get("value")) for key
            in json.loads(text)]


def defaults_with(keys, method):
    """Path -> default of the keys for a value of the key Method."""
    return {key.path: key.paper if method == "paper"
            and key.paper is not None else key.default for key in keys}
