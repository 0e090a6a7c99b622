# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The messages in the program's sources, for tests of what is said of them."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Where a message ends up at the user: exit code 1 or 2, or a warning.
# The other helpers of Refusals end in one of these.
THROWS = re.compile(
    r"\b(?:InputError|StepFailed|SurfaceTorn|runtime_error|"
    r"refuse|refuse_unless|refuse_snapshot|give_up|fail|warning|"
    r"add\(warnings,)\s*\(?")

LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def sources():
    """The files of the program, without the step programs."""
    for folder, ending in (("source", "*.cc"), ("include", "*.h")):
        for file in sorted((ROOT / folder).rglob(ending)):
            if "steps" not in file.parts:
                yield file


def joined(text):
    """C++ without comments, adjacent string literals made one."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r'("(?:[^"\\\n]|\\.)*")|//[^\n]*', lambda m: m[1] or "", text)
    return re.sub(r'(?<!\\)"\s*\n\s*"', "", text)


def literals(text):
    return [found.replace('\\"', '"').replace("\\n", " ")
            for found in LITERAL.findall(text)]


def arguments(text, begin):
    """The text from an opening bracket's inside to its closing bracket."""
    depth, at = 1, begin
    while depth and at < len(text):
        if text[at] == '"':
            at = LITERAL.match(text, at).end()
            continue
        depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(text[at], 0)
        at += 1
    return text[begin:at]


def said_at_once():
    """(file, the literals) of every place where a message is made. Places
    without a sentence of their own pass on what others have said."""
    for file in sources():
        if file.name == "input_error.h":  # the frame around all of them
            continue
        text = joined(file.read_text(encoding="utf-8"))
        for match in THROWS.finditer(text):
            if not match[0].endswith(("(", ",")):
                continue
            words = literals(arguments(text, match.end()))
            if any(re.search("[a-z'] [a-z']", word) and
                   not word.startswith("Tissue/") for word in words):
                yield file.relative_to(ROOT).as_posix(), words


def all_literals():
    """Every string literal of the program."""
    return {literal for file in sources()
            for literal in literals(joined(file.read_text(encoding="utf-8")))}
