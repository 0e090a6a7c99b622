# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measured tables are data of a version: doc/measured/VERSION/PAGE.json.

One file a page, written by the tools that measure (contrib/upkeep/renew calls them)
and never by hand:

  {"page": "doc/hard-cases.md", "version": "0.1.0",
   "tables": {"cuts": {"made": "2026-11-27: commit ...", "parts": [...]}}}

A part of a table is {"text": lines of Markdown}, {"code": lines} or
{"header": words, "rows": lists of words}. Pages link to a table by a line of
its own, [Measured: cuts](measured/0.1.0/hard-cases.json), where the manual
(contrib/upkeep/doxygen) shows it. Until a table has been measured with a new
version, its page shows that of the version before; storing it turns the link.
"""
import json
import os
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]

LINK = re.compile(r"^\[Measured: ([^]]+)\]\(([^)]+\.json)\)$", re.M)


def version(root=ROOT):
    """The version of a tree: that of its project()."""
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^project\(Morula VERSION (\S+)", text, re.M)[1]


def data_file(page, root=ROOT):
    """The data of a page, of the version that the tree is."""
    return root / f"doc/measured/{version(root)}/{page}.json"


def newest(page, root=ROOT):
    """The tables of a page (name -> table), each of the last version that has
    it."""
    found = {}
    for file in sorted(root.glob(f"doc/measured/*/{page}.json"), key=lambda file:
                       [int(part) for part in file.parent.name.split(".")]):
        found.update(read(file)["tables"])
    return found


def read(file):
    return json.loads(file.read_text(encoding="utf-8"))


def store(page, tables, made, root=ROOT):
    """Writes tables (name -> Markdown) of a page, whose other tables stay;
    `made`: with what they were measured. Returns the file."""
    file = data_file(page, root)
    data = read(file) if file.is_file() else {
        "page": f"doc/{page if page != 'steps' else 'steps/README'}.md",
        "version": version(root), "tables": {}}
    for name, text in tables.items():
        data["tables"][name] = {"made": made, "parts": parts(text)}
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(written(data), encoding="utf-8")
    turn_links(root / data["page"], file, tables)
    return file


def turn_links(page, file, tables):
    """The page's links to these tables, and to all data of the page, name this
    file. Tables of a README are those of all pages beside it."""
    some = page.parent.glob("*.md") if page.name == "README.md" else [page]
    links = re.compile(rf"\[([^]]+)\]\([^)]+/{re.escape(file.name)}\)")

    def turned(match):
        title = match[1].removeprefix("Measured: ")
        stays = title != match[1] and title not in tables
        return (match[0] if stays else
                f"[{match[1]}]({os.path.relpath(file, page.parent)})")

    for page in filter(Path.is_file, some):
        before = page.read_text(encoding="utf-8")
        text = links.sub(turned, before)
        if text != before:
            page.write_text(text, encoding="utf-8")


def parts(markdown):
    """A table in Markdown, with the text around it, as data."""
    found = []
    for kind, lines in runs(markdown.strip().splitlines()):
        if kind == "code":
            found.append({"code": lines})
        elif kind == "table":
            header, _, *rows = map(words, lines)
            found.append({"header": header, "rows": rows})
        elif any(lines):
            found.append({"text": "\n".join(lines).strip().splitlines()})
    return found


def runs(lines):
    """(kind, lines) of the stretches of code, tables and text, in order."""
    found, fenced = [], False
    for line in lines:
        if line == "```":
            fenced = not fenced
            if fenced:
                found.append(("code", []))
            continue
        kind = ("code" if fenced else "table" if line.startswith("|")
                else "text")
        if not found or found[-1][0] != kind:
            found.append((kind, []))
        found[-1][1].append(line)
    return found


def words(line):
    """The cells of a line of a table in Markdown."""
    return [word.strip().replace("\\|", "|")
            for word in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def written(data):
    """As JSON with a row a line, so that differences can be read."""
    text = json.dumps(data, ensure_ascii=False, indent=1)
    word = r'"(?:[^"\\]|\\.)*"'
    return re.sub(rf'(?<!"text": )(?<!"code": )\[\s+({word}(?:,\s+{word})*)\s+\]',
                  lambda match: "[" + re.sub(r",\n\s+", ", ", match[1]) + "]",
                  text) + "\n"


def markdown(table):
    """A table of the data as Markdown again."""
    blocks = []
    for part in table["parts"]:
        if "code" in part:
            blocks.append(["```", *part["code"], "```"])
        elif "text" in part:
            blocks.append(part["text"])
        else:
            lines = [part["header"], ["---"] * len(part["header"]),
                     *part["rows"]]
            blocks.append(["| " + " | ".join(
                word.replace("|", "\\|") for word in line) + " |"
                for line in lines])
    blocks.append([f"*{table['made']}*"])
    return "\n\n".join("\n".join(block) for block in blocks)


def shown(text, folder):
    """A page with its tables in the place of the links to them; folder: where
    the page stands."""
    return LINK.sub(lambda match: markdown(
        read(folder / match[2])["tables"][match[1]]), text)
