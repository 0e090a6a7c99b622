# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The program asks for large pages in its large arrays: half the time of a large
tissue is spent on small ones."""
import subprocess
import time
from pathlib import Path

import pytest
from morula.execute import environment, overrides

from tests.common.program import TESTS

SUPPORT = Path("/sys/kernel/mm/transparent_hugepage/enabled")
PATIENCE = 300  # s


def asked_for(process):
    """kB of memory for which the process has asked for large pages."""
    total = size = 0
    for line in Path(f"/proc/{process}/smaps").read_text().splitlines():
        name, _, value = line.partition(":")
        if name == "Size":
            size = int(value.split()[0])
        elif name == "VmFlags" and "hg" in value.split():
            total += size
    return total


@pytest.mark.skipif(not SUPPORT.is_file(), reason="this system has no large pages")
def test_columns_of_cells(runs):
    """65,752 cells have 10 MB at least."""
    if b"__asan_init" in runs.options.morula.read_bytes():
        pytest.skip("AddressSanitizer has its own operator new")
    words = runs.command(TESTS.parent / "prm/paper/fig-4b.prm", *overrides(
        {"Output directory": runs.work / "output"}))
    with subprocess.Popen(words, env=environment(), stdout=subprocess.DEVNULL) as process:
        try:
            until, found = time.monotonic() + PATIENCE, 0
            while found < 10000 and time.monotonic() < until:
                assert process.poll() is None
                found = asked_for(process.pid)
                time.sleep(0.02)
        finally:
            process.kill()
    assert found >= 10000
