# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Keys in the search of the HTML pages. Doxygen's own index has classes, functions
and titles of pages, and finds what begins as the words that are typed."""
import html
import re

from upkeep.manual.markdown import KEY_ROW, KEYS, ROOT, key, page_name


def identifier(text):
    """Text as Doxygen's search.js compares it: convertToId() there."""
    return re.sub(r"[^a-z0-9\u0080-\uffff]", lambda m: f"_{ord(m[0]):02x}",
                  text.lower())


def escaped(text):
    """Text as the index shows it."""
    return html.escape(text, quote=False).replace("'", "&apos;")


def keys():
    """Paths of all keys that the page has."""
    return KEY_ROW.findall((ROOT / KEYS).read_text(encoding="utf-8"))


def beginnings(path):
    """What finds a key: its path, and its name from each word on."""
    words = path.rpartition("/")[2].split()
    return {path, *(" ".join(words[i:]) for i in range(len(words)))}


def add_keys(folder):
    """Adds every key to the index of all that can be found, below the folder of
    the pages: search/all_N.js has what begins with the N-th of the letters."""
    search = folder / "search"
    letters = re.search(r'0: "([^"]*)"', (search / "searchdata.js").read_text(
        encoding="utf-8"))[1]
    added = {}
    for number, path in enumerate(keys()):
        link = f"['../{page_name(KEYS)}.html#{key(path)}',1,'']"
        for text in beginnings(path):
            added.setdefault(text[0].lower(), []).append(
                f"  ['{identifier(text)}_key{number}',"
                f"['{escaped(path)}',{link}]]")
    for letter, lines in added.items():
        file = search / f"all_{letters.index(letter):x}.js"
        head, *old, end = file.read_text(encoding="utf-8").splitlines()
        first, old = (old[0], old[1:])
        rows = sorted([*(line.removesuffix(",") for line in old), *lines])
        file.write_text("\n".join([head, first, ",\n".join(rows), end]) + "\n",
                        encoding="utf-8")
