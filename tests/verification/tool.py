# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Measures Morula's errors against solutions that do not come from it.

    contrib/upkeep/verify                       every case, the ladders of ctest
    contrib/upkeep/verify vortex patch          these cases
    contrib/upkeep/verify --plot                and draw errors-h.png, ...
    contrib/upkeep/verify --full --document     all rungs; writes doc/measured
    contrib/upkeep/verify --list                the cases

Prints errors and orders, and ends with exit code 3 if one is not what the case
asserts, 1 if a run failed. Runs that are there already are not repeated.
"""
import argparse
import importlib
from pathlib import Path

from upkeep.made import made_with
from upkeep.version_data import store

from tests.common.tables import UNMET_LIMITS
from tests.verification.execution import RunFailed, measure
from tests.verification.plots import draw, draw_vortex
from tests.verification.report import markdown, print_ladder

ROOT = Path(__file__).resolve().parents[2]


def arguments(names):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="case",
                        help="default: all")
    parser.add_argument("--full", action="store_true",
                        help="also the ladders and rungs that take long")
    parser.add_argument("--list", action="store_true", help="list the cases")
    parser.add_argument("--plot", action="store_true",
                        help="draw the errors into the output directory")
    parser.add_argument("--document", action="store_true",
                        help="draw them into doc/images/verification, and\n"
                        "write the tables into doc/measured; all cases,\n"
                        "with --full")
    parser.add_argument("--morula", type=Path, default=ROOT / "build/morula",
                        help="the executable")
    parser.add_argument("--output", type=Path,
                        default=ROOT / "output/verification",
                        help="directory for the runs")
    options = parser.parse_args()
    unknown = [name for name in options.cases if name not in names]
    if unknown:
        parser.error(f"no case '{unknown[0]}'; there are " + ", ".join(names))
    if options.document and (options.cases or not options.full):
        parser.error("--document goes with --full and all cases")
    options.morula, options.output = (options.morula.resolve(),
                                      options.output.resolve())
    if not options.list and not options.morula.is_file():
        parser.error(f"{options.morula} is missing; contrib/build makes it")
    return options


def measure_case(name, case, options):
    """Runs and prints the wanted ladders of a case."""
    found = []
    for ladder in case.ladders:
        if ladder.full_only and not options.full:
            continue
        found.append(measure(case, ladder, options.morula,
                             options.output / name, options.full))
        print_ladder(found[-1])
    return found


def write_document(measured, options):
    """Figures and tables for doc/verification.md."""
    images = ROOT / "doc/images/verification"
    files = draw(measured, images)
    files.append(draw_vortex(options.morula, options.output / "picture",
                             images / "vortex.png"))
    files.append(store("verification", {
        name: markdown(ladders) for name, ladders in measured.items()},
        made_with(ROOT, options.morula), ROOT))
    print("written:", *files, sep="\n  ")


def verify():
    names = sorted(file.stem for file in
                   (ROOT / "tests/verification/cases").glob("*.py"))
    options = arguments(names)
    measured = {}
    for name in options.cases or names:
        case = importlib.import_module(f"tests.verification.cases.{name}").CASE
        print(f"{name}: {case.title}; reference: {case.reference}")
        if not options.list:
            measured[name] = measure_case(name, case, options)
    if options.list:
        return 0
    if options.plot:
        print("written:", *draw(measured, options.output), sep="\n  ")
    if options.document:
        write_document(measured, options)
    failures = [f"{name}, {text}" for name, ladders in measured.items()
                for ladder in ladders for text in ladder.shortcomings()]
    print("\n".join(["FAILED:", *failures] if failures else ["passed"]))
    return UNMET_LIMITS if failures else 0


def main():
    try:
        return verify()
    except RunFailed as error:
        return f"verify: a run failed:\n{error}"
