# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Markdown pages as Doxygen 1.9 reads them.

The pages are written as GitHub shows them. Doxygen knows neither $...$ nor
```math, and neither GitHub's names of headings nor equal file names in two
folders; links to files that are no pages would lead nowhere.
"""
import os
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]

# The page of all keys: a row of its tables is a key.
KEYS = "doc/parameters.md"
KEY_ROW = re.compile(r"^\| `([^`]+)` ", re.M)

# Where a page of Doxygen's finds the pictures of doc/images.
PICTURES = "images"


def page_name(path):
    """The name of a page, from its path below the root."""
    if path == "README.md":
        return "mainpage"
    return re.sub(r"[^A-Za-z0-9]+", "-", path.removesuffix(".md"))


def slug(heading):
    """GitHub's name of a heading."""
    text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")


def anchor(page, name):
    """Doxygen's name of an anchor: unlike GitHub's, one for all pages."""
    return f"{page}-" + re.sub(r"[^A-Za-z0-9_-]", "_", name)


def key(path):
    """Doxygen's name of a key's row in doc/parameters.md."""
    return anchor(page_name(KEYS), "key-" + slug(path.replace("/", "-")))


def equation(page, number):
    """Doxygen's name of a numbered equation."""
    return anchor(page, "equation-" + number.replace(".", "-"))


class Page:
    """One page; @p path below the root, @p output where the HTML will be."""

    def __init__(self, path, output):
        self.path = path
        self.name = page_name(path)
        self.output = output
        self.level = 1
        self.slugs = {}

    def target(self, link):
        """What a link leads to in the HTML."""
        if re.match(r"[a-z]+:", link):
            return link
        file, _, name = link.partition("#")
        path = self.path if not file else os.path.normpath(
            os.path.join(os.path.dirname(self.path), file))
        if path.endswith(".md") and is_page(path):
            page = page_name(path)
            if name:
                return "#" + anchor(page, name)
            return "index.html" if page == "mainpage" else f"#{page}"
        return os.path.relpath(ROOT / path, self.output)

    def picture(self, match):
        text, link = match.groups()
        path = Path(os.path.normpath(os.path.join(
            ROOT, os.path.dirname(self.path), link)))
        where = f"{PICTURES}/{path.relative_to(ROOT / 'doc/images')}"
        text = text.replace('"', "&quot;")
        return f'<img src="{where}" alt="{text}" style="max-width:100%"/>'

    def link(self, match):
        text, link = match.groups()
        target = self.target(link)
        if target.startswith("#"):
            return f"[{text}]({target})"
        return f'<a href="{target}">{text}</a>'

    def prose(self, text):
        """A stretch of text without code: formulas, pictures, links."""
        parts = re.split(r"(\$[^$]+\$)", text)
        for i, part in enumerate(parts):
            if i % 2:
                parts[i] = rf"\f{part[:-1]}\f$"
                continue
            part = re.sub(r'<a (?:id|name)="([^"]+)">\s*</a>',
                          lambda m: rf"\anchor {anchor(self.name, m[1])} ",
                          part)
            parts[i] = part
        text = "".join(parts)
        text = re.sub(r"!\[([^]]*)\]\(([^)\s]+)\)", self.picture, text)
        return re.sub(r"\[([^]]*)\]\(([^)\s]+)\)", self.link, text)

    def heading(self, marks, words):
        """A heading with its name; Doxygen has no level below a missing one,
        and equal headings are numbered, as GitHub does."""
        plain = words.replace("`", "")
        if marks == "#":
            return f"# {words} {{#{self.name}}}"
        self.level = min(len(marks), self.level + 1)
        name = slug(plain)
        n = self.slugs[name] = self.slugs.get(name, -1) + 1
        name = anchor(self.name, f"{name}-{n}" if n else name)
        return f"{'#' * self.level} {words} {{#{name}}}"

    def text(self, lines):
        """A run of lines outside fenced blocks."""
        whole = "\n".join(lines)
        # Code spans, which may go over a line's end, stay as they are: but
        # links may hold some, so those are set apart first.
        spans = []

        def keep(match):
            spans.append(" ".join(match[0].split("\n")))
            return f"\0{len(spans) - 1}\0"

        whole = re.sub(r"(?<!`)(`+)(?!`)(?:.(?!\n\n))+?(?<!`)\1(?!`)", keep,
                       whole, flags=re.S)
        whole = self.prose(whole)
        lines = whole.split("\n")
        for i, line in enumerate(lines):
            heading = re.match(r"(#+) (.*)$", line)
            if heading:
                words = re.sub("\0(\\d+)\0", lambda m: spans[int(m[1])],
                               heading[2])
                lines[i] = self.heading(heading[1], words)
        return re.sub("\0(\\d+)\0", lambda m: spans[int(m[1])],
                      "\n".join(lines))

    def converted(self, source):
        """The whole page."""
        if self.path == KEYS:
            source = KEY_ROW.sub(
                lambda m: rf"| \anchor {key(m[1])} `{m[1]}` ", source)
        out, lines, fence = [], [], None
        for line in source.split("\n"):
            mark = re.match(r"\s*(```+)(\S*)\s*$", line)
            if fence is None and mark:
                out.append(self.text(lines))
                lines = []
                fence = mark[2]
                out.append(r"\f[" if fence == "math" else line)
            elif fence is not None and mark and not mark[2]:
                out.append(r"\f]" if fence == "math" else line)
                fence = None
            elif fence is not None:
                out.append(line)
            else:
                lines.append(line)
        out.append(self.text(lines))
        return re.sub(
            r"^\\f\[\n(?=(?:(?!\\f\]).)*?\\tag\{([^}]*)\})",
            lambda m: rf"\anchor {equation(self.name, m[1])} " + m[0],
            "\n".join(out), flags=re.M | re.S)


# No pages of the manual: notes are dated and frozen, and changes are for those
# who know an older version.
OTHERS = ("doc/notes/20", "doc/changes/")

OTHER_PAGES = ("README.md", "CONTRIBUTING.md", "tests/README.md")


def is_page(path):
    """Whether Doxygen makes a page of this file: those of doc/Doxyfile."""
    return (ROOT / path).is_file() and (
        path.startswith("doc/") and not path.startswith(OTHERS)
        or path in OTHER_PAGES)


def pages():
    """The files of all pages: in the order in which doc/README.md names them, and
    steps in theirs; then those that it does not name."""
    named = [ROOT / "README.md", ROOT / "doc/README.md"]
    for line in named[1].read_text(encoding="utf-8").splitlines():
        for link in re.findall(r"\]\(([^)#]+)", line):
            file = Path(os.path.normpath(ROOT / "doc" / link))
            named.append(file)
            if file.parent.name == "steps":
                named += sorted(file.parent.glob("*.md"))
    every = [file for file in (*named, *sorted(ROOT.glob("doc/**/*.md")),
                               *(ROOT / name for name in OTHER_PAGES))
             if file.suffix == ".md"
             and is_page(file.relative_to(ROOT).as_posix())]
    return list(dict.fromkeys(every))
