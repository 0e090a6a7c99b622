# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs the hard cases: scenes that break plain methods.

    contrib/upkeep/hard-cases                     every case, at the size of ctest
    contrib/upkeep/hard-cases cuts                these cases
    contrib/upkeep/hard-cases --document          writes the tables of this version,
                                           doc/measured
    contrib/upkeep/hard-cases cuts --full         the full size of a case
    contrib/upkeep/hard-cases --build build-debug with another build
    contrib/upkeep/hard-cases --list              the cases

Prints figures and findings. The exit code is 3 if only limits are not met that a
case asserts of its figures, 1 if anything else is not as it asserts. Runs that
are there already are not repeated.
"""
import argparse
import importlib
import traceback
from pathlib import Path

from upkeep.made import made_with
from upkeep.version_data import store

from tests.common.tables import UNMET_LIMITS
from tests.hard.execution import Execution
from tests.hard.report import markdown, print_case

ROOT = Path(__file__).resolve().parents[2]


def arguments(names):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="case",
                        help="default: all")
    parser.add_argument("--full", action="store_true",
                        help="the full sizes, and trials that take long")
    parser.add_argument("--list", action="store_true", help="list the cases")
    parser.add_argument("--document", action="store_true",
                        help="write the tables of these cases into\n"
                        "doc/measured")
    parser.add_argument("--build", type=Path, default=ROOT / "build",
                        help="build directory of the executable")
    parser.add_argument("--morula", type=Path, help="the executable")
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--output", type=Path, default=ROOT / "output/hard",
                        help="directory for the runs")
    options = parser.parse_args()
    unknown = [name for name in options.cases if name not in names]
    if unknown:
        parser.error(f"no case '{unknown[0]}'; there are " + ", ".join(names))
    options.morula = (options.morula or options.build / "morula").resolve()
    options.output = options.output.resolve()
    if not options.list and not options.morula.is_file():
        parser.error(f"{options.morula} is missing; contrib/build makes it")
    return options


def try_case(name, case, execution):
    """(runs, findings, what keeps them from being judged) of a case, printed."""
    runs, wrong = {}, []
    for trial in case.wanted(execution.full):
        runs[trial.name], found = execution.run(name, trial)
        wrong += found
    findings = []
    try:
        for finding in case.judge(runs):
            findings.append(finding)
    except Exception:  # of any case; the others are still to be judged
        wrong.append("the case cannot be judged:\n" + traceback.format_exc())
    if not findings:
        wrong.append("the case finds nothing")
    wrong += [f"nothing is found for '{text}'"
              for text in case.unfounded(findings)]
    print_case(runs, findings)
    return runs, findings, wrong


def main():
    names = sorted(file.stem for file in
                   (ROOT / "tests/hard/cases").glob("*.py"))
    options = arguments(names)
    execution = Execution(options.morula, options.mpiexec, options.output,
                          options.full)
    failures, limits, tables = [], [], {}
    for name in options.cases or names:
        case = importlib.import_module(f"tests.hard.cases.{name}").CASE
        print(f"{name}: {case.title}", flush=True)
        if options.list:
            continue
        runs, findings, wrong = try_case(name, case, execution)
        failures += [f"{name}, {text}" for text in wrong]
        limits += [f"{name}, {finding.text}: {finding.value:.6g}, not "
                   f"{finding.limits()}"
                   for finding in findings if not finding.holds()]
        if not wrong:  # the table says what is not met
            tables[name] = markdown(runs, findings, options.full)
    if options.list:
        return 0
    unmet = failures + limits
    print("\n".join(["FAILED:", *unmet] if unmet else ["passed"]))
    if options.document:
        print("written:", store("hard-cases", tables,
                                made_with(ROOT, options.morula), ROOT))
    return 1 if failures else UNMET_LIMITS if limits else 0
