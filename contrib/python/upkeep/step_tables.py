# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Tables that the step programs print."""


def tables(text):
    """The tables of deal.II's TableHandler::org_mode_table in a text, each a
    dictionary: column -> list of numbers (NaN for '-', text as it is). A column
    of rates has the name of the one before it with ' rate', the second column of
    a name has a ' 2' behind it."""
    found, lines = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            lines.append([word.strip() for word in line.split("|")[1:-1]])
        elif lines:
            names = [name if "...red.rate" not in name
                     else lines[0][i - 1] + " rate"
                     for i, name in enumerate(lines[0])]
            names = [f"{name} 2" if name in names[:i] else name
                     for i, name in enumerate(names)]
            found.append({name: [number(line[i]) for line in lines[1:]]
                          for i, name in enumerate(names)})
            lines = []
    return found


def number(word):
    if word == "-":
        return float("nan")
    try:
        return float(word)
    except ValueError:
        return word
