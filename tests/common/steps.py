# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What the step programs print."""


def number(word):
    """NaN for '-', text as it is."""
    try:
        return float("nan" if word == "-" else word)
    except ValueError:
        return word


def tables(text):
    """The tables of deal.II's TableHandler::org_mode_table in a text, each a
    dictionary: column -> list of numbers. A column of rates has the name of the one
    before it with ' rate', the second column of a name has a ' 2' behind it."""
    found, lines = [], []
    for line in [*text.splitlines(), ""]:
        if line.startswith("|"):
            lines.append([word.strip() for word in line.split("|")[1:-1]])
        elif lines:
            names = []
            for name in lines[0]:
                name = names[-1] + " rate" if "...red.rate" in name else name
                names.append(f"{name} 2" if name in names else name)
            columns = zip(*lines[1:])
            found.append({name: [number(word) for word in column]
                          for name, column in zip(names, columns)})
            lines = []
    return found
