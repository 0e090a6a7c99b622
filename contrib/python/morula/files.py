# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Files that are written aside and renamed: there is never half of one."""
import csv
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replaced(file):
    """The path of a file, with the same ending, that takes the place of `file` if all goes well."""
    file = Path(file)
    # VTK drops an underscore at the end of a name, which would be another file.
    handle, name = tempfile.mkstemp(dir=file.parent, prefix=f".{file.stem}.",
                                    suffix=f".part{file.suffix}")
    os.close(handle)
    try:
        yield Path(name)
        os.chmod(name, 0o644)
        os.replace(name, file)
    except BaseException:
        os.unlink(name)
        raise


def write(file, text):
    """Writes a text file. What cannot be UTF-8, as a name of a file may be,
    becomes question marks."""
    with replaced(file) as aside:
        aside.write_text(text, encoding="utf-8", errors="replace")


def write_csv(file, rows):
    with replaced(file) as aside, aside.open("w", encoding="utf-8", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)
