# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures the tables and figures of doc/ anew, without anybody there: builds,
and calls the tools, which write the data of this version, doc/measured/VERSION,
turn the pages' links to them, and draw pictures. Done for a version, not for a change. A page that fails does not
keep the others from being measured, and a table with figures beyond their
limits says so itself; output/renew/report.txt says at the end what became of
each, output/renew/PAGE.log what its tools said.

    contrib/upkeep/renew                      all pages: some hours
    contrib/upkeep/renew verification steps   these
    contrib/upkeep/renew --short              a few small runs through the tools of
                                       each, in minutes, in a copy of the tree
                                       below output/renew: nothing changes
    contrib/upkeep/renew --list               the pages and their commands
    contrib/upkeep/renew --show hard-cases    prints the tables of the last version
    contrib/upkeep/renew --limits             writes into the pages, without any run,
                                       the limits that the cases assert
"""
import argparse
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path

from morula.command_line import like_ctrl_c
from morula.execute import call

from tests.common.tables import UNMET_LIMITS

from . import limits
from .made import made_with
from .measured import PAGES
from .version_data import markdown, newest

ROOT = Path(__file__).resolve().parents[3]

# What a scratch copy of the tree holds: all that the tools read or write. The
# build directory is the tree's own.
COPIED = ("CMakeLists.txt", "contrib", "doc", "include", "prm", "source", "tests")


class Renewal:
    """Pages of a tree, with the commands `full` or `short` of each. Short runs
    do not belong into the pages: they are done in a copy of the tree."""

    def __init__(self, root, pages, short=False, say=print):
        self.root, self.pages, self.short, self.say = root, pages, short, say
        self.output = root / "output/renew"
        self.tree = self.output / "tree" if short else root
        self.report = []

    def run(self, names):
        """Renews these pages; 1 if one of them failed."""
        self.output.mkdir(parents=True, exist_ok=True)
        if self.short:
            self._copy_tree()
        made = made_with(self.root)
        self.say(made)
        failed = []
        for name in names:
            start = time.monotonic()
            outcome = self._page(name)
            minutes = (time.monotonic() - start) / 60
            self.report.append(f"{name}: {outcome}, {minutes:.1f} min")
            self.say(self.report[-1])
            if outcome.startswith("FAILED"):
                failed.append(name)
        text = "\n".join([made, *self.report]) + "\n"
        (self.output / "report.txt").write_text(text, encoding="utf-8")
        self.say(f"renew: {len(names) - len(failed)} of {len(names)} pages; "
                 f"{self.output / 'report.txt'}"
                 + (f"; FAILED: {', '.join(failed)}" if failed else ""))
        return 1 if failed else 0

    def commands(self, name):
        return self.pages[name].short if self.short else self.pages[name].full

    def _page(self, name):
        """Renews a page; what became of it, in words."""
        page = self.pages[name]
        if self.short and not page.short:
            return "has no short runs"
        log, unmet = self.output / f"{name}.log", ""
        with log.open("w", encoding="utf-8") as stream:
            for words in self.commands(name):
                self.say(f"{name}: {shlex.join(words)}")
                code = call([self.tree / words[0], *words[1:]],
                            cwd=self.tree, stdout=stream, stderr=stream).code
                if code == UNMET_LIMITS:
                    unmet = f", limits are not met: see {log}"
                elif code:
                    return (f"FAILED, {words[0]} ended with exit code {code}: "
                            f"see {log}")
        return ("renewed" if not self.short else "its tools work") + unmet

    def _copy_tree(self):
        shutil.rmtree(self.tree, ignore_errors=True)
        copy_tree(self.root, self.tree)
        (self.tree / "build").symlink_to(self.root / "build")


def copy_tree(root, target):
    """Copies what the tools read or write."""
    target.mkdir(parents=True)
    for name in COPIED:
        if (root / name).is_dir():
            shutil.copytree(root / name, target / name, symlinks=True)
        elif (root / name).is_file():
            shutil.copy(root / name, target / name)


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("pages", nargs="*", metavar="PAGE",
                        help="default: all; " + ", ".join(PAGES))
    parser.add_argument("--short", action="store_true",
                        help="try the tools with small runs; needs a build")
    parser.add_argument("--list", action="store_true",
                        help="print the pages and their commands")
    parser.add_argument("--show", action="store_true",
                        help="print the tables of the last version")
    parser.add_argument("--limits", action="store_true",
                        help="only write the limits that are asserted")
    options = parser.parse_args()
    unknown = [name for name in options.pages if name not in PAGES]
    if unknown:
        parser.error(f"there is no page '{unknown[0]}'; there are "
                     + ", ".join(PAGES))
    if options.short and not (ROOT / "build/morula").is_file():
        parser.error("build/morula is missing; contrib/build all makes it")
    return options


def listing(options):
    for name, page in PAGES.items():
        if not options.pages or name in options.pages:
            print(f"doc/{page.file} ({name})")
            for words in page.short if options.short else page.full:
                print("    " + shlex.join(words))


def show(options):
    for name in options.pages or PAGES:
        for table, data in newest(name).items():
            print(f"# {name}: {table}\n\n{markdown(data)}\n")


def renew_pages(options):
    """Exit code 0; 1 if a page could not be renewed; 130 if it was stopped."""
    names = options.pages or [name for name in PAGES if
                              PAGES[name].short or not options.short]
    try:
        with like_ctrl_c():
            if not options.short:
                subprocess.run([ROOT / "contrib/build", "all"], check=True)
            return Renewal(ROOT, PAGES, options.short,
                           lambda text: print(text, flush=True)).run(names)
    except subprocess.CalledProcessError as error:
        print(f"renew: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("renew: stopped; runs that are finished are used again where the "
              "tool does so.", file=sys.stderr)
        return 130


def main():
    options = arguments()
    if options.list or options.show:
        return listing(options) if options.list else show(options)
    if options.limits:
        print("written:", *limits.write_all(ROOT), sep="\n  ")
        return 0
    return renew_pages(options)
