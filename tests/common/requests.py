# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Command lines of tools, judged in the process of the test."""
import contextlib
import functools

import pytest
from morula.program import Program
from morula.scene import Scene


@contextlib.contextmanager
def asked(request, parser, morula):
    """A function of words that returns the Request of a tool's module `request`, or
    throws Refused; the program is asked about each scene once."""
    known = functools.cache(Scene)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(request, "Program", functools.cache(Program))
        patch.setattr(request, "Scene", lambda path, program, keys: known(
            path, program, tuple(keys)))
        yield lambda *words: request.Request(parser().parse_args(
            ["--morula", str(morula), *map(str, words)]))
