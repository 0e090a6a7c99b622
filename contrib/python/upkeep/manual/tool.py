# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs Doxygen on the pages and headers; see contrib/upkeep/doxygen."""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from upkeep.manual import python_reference, search
from upkeep.manual.coverage import undocumented
from upkeep.manual.header import comments_linked
from upkeep.manual.markdown import PICTURES, ROOT, Page, pages
from upkeep.version_data import shown

MATHJAX = Path("/usr/share/javascript/mathjax")  # Debian's libjs-mathjax


def settings(folder):
    """Doxygen's settings for HTML (and XML, to look into) below a folder."""
    lines = [f'@INCLUDE = "{ROOT}/doc/Doxyfile"', f'OUTPUT_DIRECTORY = "{folder}"',
             f'WARN_LOGFILE = "{folder / "warnings.txt"}"',
             "GENERATE_XML = YES", "XML_OUTPUT = xml",
             "XML_PROGRAMLISTING = NO",
             "INPUT = " + " ".join(page.relative_to(ROOT).as_posix()
                                   for page in pages()),
             f"INPUT += {python_reference.PATH} include/morula"]
    if MATHJAX.is_dir():
        lines.append("MATHJAX_RELPATH = mathjax")
    return "\n".join(lines) + "\n"


def convert(sources, output):
    """Writes what Doxygen reads below a folder, at the paths it has below the
    root. Filters of Doxygen's own would be a process a file."""
    for path in [*pages(), *ROOT.glob("include/**/*.h")]:
        name = path.relative_to(ROOT).as_posix()
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".h":
            text = comments_linked(text)
        else:
            text = Page(name, output).converted(shown(text, path.parent))
        (sources / name).parent.mkdir(parents=True, exist_ok=True)
        (sources / name).write_text(text, encoding="utf-8")
    (sources / python_reference.PATH).write_text(python_reference.page(),
                                                 encoding="utf-8")


def make(output):
    """Writes the pages into @p output, which they replace; returns what is to
    complain about. With complaints, the pages are made all the same."""
    output.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(prefix=f".{output.name}-",
                                  dir=output.parent))
    try:
        with tempfile.TemporaryDirectory() as sources:
            convert(Path(sources), output)
            result = subprocess.run(
                ["doxygen", "-"], input=settings(aside), text=True, cwd=sources,
                env={**os.environ, "LC_ALL": "C.UTF-8"},
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        log = aside / "warnings.txt"
        complaints = log.read_text().splitlines() if log.exists() else []
        if result.returncode and not complaints:
            complaints = [f"doxygen ended with exit code {result.returncode}: "
                          f"{result.stdout.strip()}"]
        if not (aside / "index.html").is_file():
            return complaints + ["doxygen wrote no index.html"]
        complaints += undocumented(aside / "xml")
        search.add_keys(aside)
        log.unlink(missing_ok=True)
        shutil.rmtree(aside / "xml")
        shutil.copytree(ROOT / "doc/images", aside / PICTURES)
        if MATHJAX.is_dir():
            (aside / "mathjax").symlink_to(MATHJAX)
        aside.chmod(0o755)
        if output.exists():
            shutil.rmtree(output)
        aside.rename(output)
    finally:
        shutil.rmtree(aside, ignore_errors=True)
    return complaints


def main():
    parser = argparse.ArgumentParser(
        prog="contrib/upkeep/doxygen",
        description="Writes all pages of the documentation, and a reference "
        "of all classes and functions, as HTML. A warning of Doxygen's, or a "
        "public class or function without a comment, gives exit code 1.")
    parser.add_argument("--output", type=Path, default=ROOT / "build/doc",
                        metavar="FOLDER", help="replaced; default: build/doc")
    options = parser.parse_args()
    output = options.output.resolve()
    if output.exists() and any(output.iterdir()) and not (
            output / "doxygen.css").is_file():
        sys.exit(f"contrib/upkeep/doxygen: {output} holds something that Doxygen did "
                 "not write; it is left alone. Give another --output.")
    complaints = make(output)
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    if complaints:
        sys.exit(f"contrib/upkeep/doxygen: {len(complaints)} complaint(s).")
    if not MATHJAX.is_dir():
        print("Formulas are drawn by MathJax from the network, as Debian's "
              "libjs-mathjax is not here.")
    print(f"{output / 'index.html'}")
