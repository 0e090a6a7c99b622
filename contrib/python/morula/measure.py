# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs one command and writes what it cost: exit code, seconds by the clock and of the
processor, and the peak resident memory of its largest process in bytes.

    python3 -I -S measure.py RECORD.json COMMAND...

A process of its own, with next to nothing in memory: Linux counts what the
parent of a new process holds as that process's peak.
"""
import json
import os
import sys
import time


def main():
    record, *command = sys.argv[1:]
    start = time.monotonic()
    child = os.fork()
    if child == 0:
        try:
            os.execvp(command[0], command)
        except OSError as error:
            os.write(2, f"{command[0]}: {error}\n".encode())
            os._exit(127)
    _, status, usage = os.wait4(child, 0)
    result = {"exit": os.waitstatus_to_exitcode(status), "process_seconds": time.monotonic()
              - start, "processor_seconds": usage.ru_utime + usage.ru_stime,
              "peak_bytes": usage.ru_maxrss * 1024}
    with open(record, "w", encoding="utf-8") as stream:
        json.dump(result, stream)


if __name__ == "__main__":
    main()
