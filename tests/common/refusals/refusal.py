# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the program must say about a value, an option or a file."""
from dataclasses import dataclass, field

CYCLE = "Proliferation/Cell cycle/"
CONDITIONS = "Boundary conditions/"


@dataclass(frozen=True)
class Refusal:
    """keys: overrides of tests/programs/small-cube.prm; {files} in a value is the
    directory of files: name -> text or bytes. key, value, limit and remedy must
    be in the message."""

    name: str
    keys: dict
    key: str
    value: str
    limit: str
    remedy: str
    files: dict = field(default_factory=dict)


def wrong(name, key, value, limit, remedy, **others):
    """A single key with a bad value; others: further overrides."""
    return Refusal(name, {key: value, **others.pop("keys", {})}, key,
                   f"'{value}'", limit, remedy, **others)
