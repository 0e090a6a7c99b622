# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Runs cases: scenes that break plain methods (hard), and errors against
solutions that do not come from Morula (verification).

    contrib/upkeep/cases                          all, at the size of ctest
    contrib/upkeep/cases hard verification/vortex those of a kind, and this one
    contrib/upkeep/cases hard/cuts --full         at the full size
    contrib/upkeep/cases hard --full --document   writes the tables of this
                                                  version, doc/measured
    contrib/upkeep/cases verification --plot      and draws errors-h.png, ...
    contrib/upkeep/cases --build build-debug      with another build
    contrib/upkeep/cases --list                   their names

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

from tests.cases.execution import Execution
from tests.common.tables import UNMET_LIMITS

ROOT = Path(__file__).resolve().parents[2]
PAGES = {"hard": "hard-cases", "verification": "verification"}  # of the kinds
IMAGES = ROOT / "doc/images/verification"


def all_names():
    return [f"{kind}/{file.stem}" for kind in PAGES
            for file in sorted((ROOT / f"tests/{kind}/cases").glob("*.py"))]


def case_of(name):
    kind, _, stem = name.partition("/")
    return importlib.import_module(f"tests.{kind}.cases.{stem}").CASE


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="case",
                        help="hard, verification, or KIND/NAME; default: all")
    parser.add_argument("--full", action="store_true",
                        help="the full sizes, and trials that take long")
    parser.add_argument("--list", action="store_true", help="list the cases")
    parser.add_argument("--plot", action="store_true",
                        help="draw the errors of verification into the output\n"
                        "directory")
    parser.add_argument("--document", action="store_true",
                        help="write the tables of these cases into\n"
                        "doc/measured, and, of verification as a whole with\n"
                        "--full, the figures into doc/images")
    parser.add_argument("--build", type=Path, default=ROOT / "build",
                        help="build directory of the executable")
    parser.add_argument("--morula", type=Path, help="the executable")
    parser.add_argument("--mpiexec", default="mpiexec")
    parser.add_argument("--output", type=Path, default=ROOT / "output/cases",
                        help="directory for the runs")
    options = parser.parse_args()
    names = all_names()
    for word in options.cases:
        if word not in names and word not in PAGES:
            parser.error(f"no case '{word}'; there are "
                         + ", ".join([*PAGES, *names]))
    options.cases = [name for name in names if not options.cases or not
                     {name, name.split("/")[0]}.isdisjoint(options.cases)]
    options.morula = (options.morula or options.build / "morula").resolve()
    options.output = options.output.resolve()
    if not options.list and not options.morula.is_file():
        parser.error(f"{options.morula} is missing; contrib/build makes it")
    return options


def try_case(name, case, execution):
    """(what was measured, findings, what keeps it from being judged), printed."""
    runs, wrong = {}, []
    for trial in case.wanted(execution.full):
        runs[trial.name], found = execution.run(name, trial)
        wrong += found
    measured, findings = None, []
    try:
        measured = case.measure(runs)
        for finding in case.judge(measured):
            findings.append(finding)
        print("\n".join("    " + line
                        for line in case.report.lines(measured, findings)))
    except Exception:  # of any case; the others are still to be judged
        wrong.append("the case cannot be judged:\n" + traceback.format_exc())
    if not findings:
        wrong.append("the case finds nothing")
    wrong += [f"nothing is found for '{text}'"
              for text in case.unfounded(findings)]
    for finding in findings:
        verdict = "ok" if finding.holds() else "WRONG"
        print(f"    {verdict}: {finding.text}: {finding.value:.6g} "
              f"({finding.limits()})")
    print(flush=True)
    return measured, findings, wrong


def draw(measured, options, execution):
    """The figures of the verification, where they are wanted."""
    whole = [name for name in all_names() if name.startswith("verification/")]
    chosen = {name.split("/")[1]: measured[name] for name in whole
              if name in measured}
    document = options.document and options.full and len(chosen) == len(whole)
    if not chosen or not (options.plot or document):
        return
    from tests.verification import plots  # matplotlib takes a second
    folder = IMAGES if document else options.output
    files = plots.draw(chosen, folder)
    if document:
        files.append(plots.draw_vortex(execution, folder / "vortex.png"))
    print("written:", *files, sep="\n  ")


def main():
    options = arguments()
    execution = Execution(options.morula, options.mpiexec, options.output,
                          options.full)
    failures, limits, all_measured = [], [], {}
    tables = {kind: {} for kind in PAGES}
    for name in options.cases:
        case = case_of(name)
        print(f"{name}: {case.title}", flush=True)
        if options.list:
            continue
        measured, findings, wrong = try_case(name, case, execution)
        failures += [f"{name}, {text}" for text in wrong]
        limits += [f"{name}, {finding.text}: {finding.value:.6g}, not "
                   f"{finding.limits()}"
                   for finding in findings if not finding.holds()]
        if not wrong:  # the table says what is not met
            kind, _, stem = name.partition("/")
            all_measured[name] = measured
            tables[kind][stem] = case.report.markdown(measured, findings,
                                                      options.full)
    if options.list:
        return 0
    draw(all_measured, options, execution)
    if options.document:
        for kind, found in tables.items():
            if found:
                print("written:", store(PAGES[kind], found, made_with(
                    ROOT, options.morula), ROOT))
    unmet = failures + limits
    print("\n".join(["FAILED:", *unmet] if unmet else ["passed"]))
    return 1 if failures else UNMET_LIMITS if limits else 0
