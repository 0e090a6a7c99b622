# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The seal of snapshot.h5, as include/morula/output/sealed_file.h describes it:
for tests that change a snapshot and want it to be believed."""
import lzma
from pathlib import Path

SIZE = 512


def crc64(data):
    """CRC-64/XZ, which stands before the index of an .xz file."""
    packed = lzma.compress(data, check=lzma.CHECK_CRC64, preset=0)
    index = 4 * (1 + int.from_bytes(packed[-8:-4], "little"))
    return int.from_bytes(packed[-20 - index:-12 - index], "little")


def seal(path):
    """Gives a file the digest of what it holds now."""
    data = Path(path).read_bytes()[SIZE:]
    text = f"Morula snapshot\nbytes {len(data)}\nCRC-64/XZ {crc64(data):016x}\n"
    Path(path).write_bytes(text.encode().ljust(SIZE, b"\n") + data)
