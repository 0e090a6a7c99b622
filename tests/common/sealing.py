# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The seal of snapshot.h5, as include/morula/output/sealed_file.h describes it:
for tests that change a snapshot and want it to be believed."""
from pathlib import Path

SIZE = 512
POLYNOMIAL = 0xC96C5795D7870F42  # of CRC-64/XZ, its lowest power first


def table_of_bytes():
    """The remainder of each byte."""
    table = []
    for remainder in range(256):
        for _ in range(8):
            remainder = (remainder >> 1) ^ (POLYNOMIAL * (remainder & 1))
        table.append(remainder)
    return table


TABLE = table_of_bytes()


def crc64(data):
    value = 2**64 - 1
    for byte in data:
        value = TABLE[(value ^ byte) & 255] ^ (value >> 8)
    return value ^ (2**64 - 1)


def seal(path):
    """Gives a file the digest of what it holds now."""
    data = Path(path).read_bytes()[SIZE:]
    text = (f"Morula snapshot\nbytes {len(data)}\n"
            f"CRC-64/XZ {crc64(data):016x}\n")
    Path(path).write_bytes(text.encode().ljust(SIZE, b"\n") + data)
