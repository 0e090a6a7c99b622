# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The reference of the Python interface, a page made of its docstrings."""
import inspect

import morula
from morula.lineage import Lineage

PATH = "doc/python-reference.md"
HEAD = """# Python: reference {#doc-python-reference}

What `from morula import ...` gives; `Run.lineage` is a `Lineage`. Beside this page:
\\ref doc-python "Morula from Python".
"""
INHERITED = ("keys", "statistics", "timings", "events", "times", "type_names",
             "field_names", "types_of", "clone", "surface", "number",
             "dimension")


def members(cls):
    """Name and object of what a class offers: its own public members, and of a
    run what it inherits, too."""
    own = [name for name in vars(cls) if not name.startswith("_")]
    if cls.__name__ == "Run":
        own += [name for name in INHERITED if name not in own]
    if "__call__" in vars(cls):
        own.insert(0, "__call__")
    return [(name, inspect.getattr_static(cls, name)) for name in own]


def entry(name, thing):
    """A heading with the signature, and the docstring."""
    function = getattr(thing, "fget", None) or getattr(thing, "func", None)
    text = inspect.getdoc(function or thing)
    if not text:
        raise ValueError(f"{name} has no docstring")
    shown = name if function else f"{name}{inspect.signature(thing)}"
    return f"\n### {name}\n\n```py\n{shown}\n```\n\n{text}\n"


def page():
    """The page as Doxygen's Markdown. Throws ValueError for what is public and
    has no docstring."""
    parts = [HEAD]
    for cls in (morula.Scene, morula.Run, morula.Function, Lineage):
        parts.append(f"\n## {cls.__name__}\n\n```py\n{cls.__name__}"
                     f"{inspect.signature(cls)}\n```\n\n{inspect.getdoc(cls)}\n")
        parts += [entry(f"{cls.__name__}.{name}", thing)
                  for name, thing in members(cls)]
    parts += ["\n## map\n", entry("map", morula.map)]
    return "".join(parts)
