# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""What contrib/upkeep/benchmark measures: each function returns the rows of a table of
doc/performance.md, with its header first. All ratios are of runs of one call,
side by side."""
import json
import math
import re
import statistics
import subprocess

from morula.execute import Processes, call, overrides

from tests.benchmarks import scaling
from tests.common.program import ROOT

NEWTON = ("tangent", "residual", "preconditioner", "linear solver")
# What happens once, whatever the number of steps or cells.
BESIDE_STEPS = ("seeding", "output", "rows", "snapshot")
NO_STEP = ("total", "statistics", *BESIDE_STEPS)
HALF_FIXED = "prm/paper/fig-2b.prm"
PROLIFERATING = "prm/paper/fig-4b.prm"
CYCLE = "Proliferation/Cell cycle/"
# Medians of so many rounds: where other machines share the processor, a core
# can be a quarter slower than the other for a while.
ROUNDS = 5


def google_benchmark(program, blas, pattern="."):
    """name -> counters."""
    found = run_benchmark(program, blas, pattern)
    return {row["name"]: row for row in found if not row.get("error_occurred")}


def run_benchmark(program, blas, pattern, *words):
    ended = call([program, "--benchmark_format=json",
                  f"--benchmark_filter={pattern}", *words],
                 stderr=subprocess.DEVNULL, env={"MORULA_BLAS": str(blas)})
    return json.loads(ended.stdout)["benchmarks"]


def kernels(program, blas):
    found = google_benchmark(program, blas)
    peak = max(found[name]["flop_rate"] for name in ("dgemm", "dgemm again"))
    rows = [("kernel", "tangent, µs a particle", "of DGEMM's rate",
             "plain / this", "residual, µs a particle", "plain / this")]
    for name in found:
        where, what, kernel = (name + "//").split("/")[:3]
        if not what.endswith("tangent"):
            continue
        material = what[:-len("tangent")]
        tangent = found[name]
        times = [[found[f"{where}/{material}{what}/{code}"]["seconds_per_point"]
                  for code in (kernel, "plain")]
                 for what in ("tangent", "residual")]
        rate = tangent.get("flop_rate")
        rows.append((f"{material}{kernel}, {where}", f"{1e6 * times[0][0]:.2f}",
                     f"{100 * rate / peak:.0f} %" if rate else "",
                     f"{times[0][1] / times[0][0]:.1f}",
                     f"{1e6 * times[1][0]:.3f}",
                     f"{times[1][1] / times[1][0]:.1f}"))
    rows.append(("DGEMM, n = 1000", f"{peak / 1e9:.1f} GFLOP/s", "", "", "", ""))
    rows.append(("STREAM's triad",
                 f"{found['triad']['byte_rate'] / 1e9:.1f} GB/s", "", "", "",
                 ""))
    return rows


def phases(runner):
    """A step of the half-fixed sphere, 65,752 cells, h = 50 µm."""
    keys = {"Output/Formats": "csv"}
    rounds = [(runner.run("plain", HALF_FIXED,
                          {**keys, "Solver/Kernel": "plain"}),
               runner.run("automatic", HALF_FIXED, keys))
              for _ in range(ROUNDS)]
    # One assembly: tangent and residual by the plain kernel.
    units = [plain.time("tangent") / plain.calls["tangent"]
             + plain.time("residual") / plain.calls["residual"]
             for plain, _ in rounds]
    rows = [("phase", "plain kernel, s", "s", "of a plain assembly")]
    fast = rounds[0][1]
    iterations, steps = fast.total("newton_iterations"), len(fast.rows) - 1

    def line(text, names, n):
        times = [[run.time(*names) / n for run in runs]
                 for runs in zip(*rounds)]
        ratios = [time / unit for time, unit in zip(times[1], units)]
        rows.append((text, *(f"{statistics.median(part):.3f}"
                             for part in times),
                     f"{statistics.median(ratios):.2f}"))
    line("Newton iteration", NEWTON, iterations)
    for name in NEWTON:
        line(f"— {name}", (name,), iterations)
    others = [name for name in fast.sections if name not in NEWTON + NO_STEP]
    line("set-up and end of a step", others, steps)
    for name in others:
        line(f"— {name}", (name,), steps)
    return rows


def five_days(runner):
    """Fig. 4b, with the output that its scene asks for."""
    keys = {"Output/Interval": 0.1, "Output/Snapshot interval": 0.5}
    runs = {"plain kernel, direct solver": runner.run(
                "fig-4b-plain", PROLIFERATING,
                {**keys, "Solver/Kernel": "plain",
                 "Solver/Linear solver": "direct"}),
            "as it is": runner.run("fig-4b", PROLIFERATING, keys)}
    slowest = runs["plain kernel, direct solver"].time("total")
    rows = [("Fig. 4b, five days", "s", "times faster", "cells",
             "output", "division", "snapshots")]
    for name, run in runs.items():
        total = run.time("total")
        rows.append((name, f"{total:.0f}", f"{slowest / total:.1f}",
                     f"{int(run.rows[-1]['cells']):,}",
                     *(f"{100 * run.time(*sections) / total:.1f} %"
                       for sections in (("output", "rows"), ("division",),
                                        ("snapshot",)))))
    return rows


def sphere(n_cells, **keys):
    """Fig. 4b with another number of cells, at the same cells per grid cell."""
    radius = 10.0 * (3 * n_cells / (4 * math.pi))**(1 / 3)
    return {"Tissue/Radius": f"{radius:.6g}",
            "Tissue/Boundary points": round(2600 * (radius / 250)**2), **keys}


def sizes(runner, largest):
    rows = [("cells", "days", "µs a cell and step", "of the first",
             "memory, GB", "kB a cell", "kB a cell without linear system",
             "unknowns", "Newton and linear iterations a step")]
    first = None
    for n in (8000, 65000, 200000, 1000000):
        if n > largest:
            continue
        days = 1.0 if n == largest else 0.3
        run = runner.run(f"cells-{n}", PROLIFERATING,
                         sphere(n, **{"Time/Step": 0.1, "Time/End time": days}))
        time = run.time("total") - run.time(*BESIDE_STEPS)
        each = time / run.cell_steps()
        # At rest nothing is solved for: all is there but the linear system.
        rest = runner.run(f"rest-{n}", PROLIFERATING,
                          sphere(n, **{"Time/Step": 0.1, "Time/End time": 0.2,
                                       CYCLE + "G0 exit rate": 0}))
        first = first or (each, run, rest)
        steps = len(run.rows) - 1
        rows.append((f"{last_cells(run):,}", f"{days:g}", f"{1e6 * each:.1f}",
                     f"{each / first[0]:.2f}", f"{run.memory / 1e9:.2f}",
                     memory_of_cell(run, first[1]),
                     memory_of_cell(rest, first[2]),
                     f"{int(run.rows[-1]['unknowns']):,}",
                     f"{run.total('newton_iterations') / steps:.1f}, "
                     f"{run.total('linear_iterations') / steps:.0f}"))
    return rows


def last_cells(run):
    return int(run.rows[-1]["cells"])


def memory_of_cell(run, small):
    """kB of each cell that a run has more than a small one."""
    more = last_cells(run) - last_cells(small)
    return f"{(run.memory - small.memory) / more / 1e3:.2f}" if more else ""


def spacings(runner):
    """The half-fixed sphere of 65,752 cells on finer and coarser grids."""
    rows = [("h, µm", "cells a grid cell", "unknowns", "µs a cell and step",
             "tangent, µs a cell", "preconditioner and solver", "grid",
             "linear iterations of a Newton iteration", "memory, GB")]
    for h in (100, 70, 50, 35, 25):
        run = runner.run(f"spacing-{h}", HALF_FIXED, {"Grid/Spacing": h})
        time = run.time("total") - run.time(*BESIDE_STEPS)
        steps = run.cell_steps()
        rows.append((f"{h}", f"{(h / 10)**3:.0f}",
                     f"{int(run.rows[-1]['unknowns']):,}",
                     f"{1e6 * time / steps:.1f}",
                     f"{1e6 * run.time('tangent') / run.calls['tangent'] / last_cells(run):.2f}",
                     f"{1e6 * run.time('preconditioner', 'linear solver', 'sparsity pattern') / steps:.1f}",
                     f"{1e6 * run.time('grid') / steps:.2f}",
                     f"{run.total('linear_iterations') / run.total('newton_iterations'):.0f}",
                     f"{run.memory / 1e9:.2f}"))
    return rows


def rank_counts(runner):
    return scaling.counts(runner, PROLIFERATING, sphere)


def model(runner):
    found = scaling.counts(runner, PROLIFERATING, sphere)
    return scaling.model(runner, PROLIFERATING, sphere, float(found[-1][2]))


def concurrent(program, blas, name, counter):
    """Time for the same work of one process, and of two at once."""
    alone = google_benchmark(program, blas, f"^{name}$")[name][counter]
    rates = Processes().each(
        lambda _: run_benchmark(program, blas, f"^{name}$",
                                "--benchmark_min_time=3")[0][counter],
        range(2), 2)
    return 1 / alone, 1 / sum(rates)


def step_seconds(run):
    return run.time("total") - run.time(*BESIDE_STEPS)


def ranks(runner, program, blas):
    """Each ratio of the shortest times, and that of each round. On a shared
    processor only the shortest times are not also somebody else's."""
    keys = {"Time/Step": 0.1, "Time/End time": 0.5}
    total, half = "Morula, 2·10⁵ cells, five steps", (
        "10⁵ cells on one rank over 2·10⁵ on two, time")
    times = {}
    for _ in range(ROUNDS):
        one, two = (runner.run(f"ranks-{n}", PROLIFERATING,
                               sphere(200000, **keys), n) for n in (1, 2))
        smaller = runner.run("ranks-half", PROLIFERATING,
                             sphere(100000, **keys))
        found = {"DGEMM, two processes at once":
                     concurrent(program, blas, "dgemm", "flop_rate"),
                 "STREAM's triad, likewise":
                     concurrent(program, blas, "triad", "byte_rate"),
                 total: (step_seconds(one), step_seconds(two))}
        for name in NEWTON + ("commit", "grid", "division"):
            found[f"— {name}"] = one.time(name), two.time(name)
        found[half] = step_seconds(smaller), step_seconds(two)
        for name, pair in found.items():
            times.setdefault(name, []).append(pair)
    rows = [("", f"two over one, shortest of {ROUNDS}", "median of rounds",
             "range")]
    for name, pairs in times.items():
        ratios = [alone / both for alone, both in pairs]
        shortest = [min(part) for part in zip(*pairs)]
        rows.append((name, f"{shortest[0] / shortest[1]:.2f}",
                     f"{statistics.median(ratios):.2f}",
                     f"{min(ratios):.2f} to {max(ratios):.2f}"))
    rows.append(("cells at the end", " and ".join(
        f"{int(run.rows[-1]['cells']):,}" for run in (one, two)), "", ""))
    return rows


EVEN = {"Growth/Law": "isotropic", "Growth/Isotropic/Stretch": "1 + 0.05 * t"}
RATE = {"Growth/Law": "rate", "Growth/Rate/Rate": "0.15"}
DIVIDING = {"Proliferation/Law": "cell cycle"}
CYCLE = "Proliferation/Cell cycle/"
EFFECTS = [
    ("nothing but the tissue", {}),
    ("a held half", {"Boundary conditions/Fixed where": "Z <= 0"}),
    ("a body force", {"Body force/Force density": "0; 0; 1e-6"}),
    ("pressure on the surface", {"Boundary conditions/Pressure where": "1",
                                 "Boundary conditions/Pressure": "0.01"}),
    ("surface tension", {"Boundary conditions/Surface tension": "0.1"}),
    ("a mould", {"Obstacles/Names": "mould", "Obstacles/mould/Shape": "sphere",
                 "Obstacles/mould/Side": "inside",
                 "Obstacles/mould/Radius": "250"}),
    ("even growth", EVEN),
    ("— ln J_e projected", {**EVEN, "Material/Volumetric strain": "projected"}),
    ("— the surface is coarsened", {**EVEN, "Tissue/Refine surface": "true",
                                    "Tissue/Coarsen surface": "true"}),
    ("— volumes pooled", {**EVEN, "Material/Volumetric strain": "pooled",
                          "Material/Energy per": "grown volume"}),
    ("— stress relaxes", {**EVEN, "Material/Relaxation time": 0.5}),
    ("— cells contract", {**EVEN, "Contraction/Stretch": "1 - 0.01*t",
                          "Contraction/Direction": "0; 0; 1"}),
    ("— a steady field", {**EVEN, "Fields/Names": "oxygen",
                          "Fields/oxygen/Diffusion": "1e8",
                          "Fields/oxygen/Consumption": "4e4",
                          "Fields/oxygen/Fixed where": "1",
                          "Fields/oxygen/Value": "160"}),
    ("growth by rates", RATE),
    ("— across the surface normal", {
        **RATE, "Growth/Rate/Direction": "surface normal",
        "Growth/Rate/Share along": "0"}),
    ("— of the pressure", {**RATE,
                           "Growth/Rate/Rate": "0.15*ramp(pressure, 1, 0)"}),
    ("growth and division", DIVIDING),
    ("— held until grown", {**DIVIDING, CYCLE + "Size checkpoint": "0.9"}),
    ("— and death", {**DIVIDING, "Death/Rate": "0.2",
                     "Material/Energy per": "grown volume"}),
    ("— death, and a steady field", {
        **DIVIDING, "Death/Rate": "0.2 + 0.1*(oxygen < 40)",
        "Material/Energy per": "grown volume", "Fields/Names": "oxygen",
        "Fields/oxygen/Diffusion": "1e8", "Fields/oxygen/Consumption": "4e4",
        "Fields/oxygen/Fixed where": "1", "Fields/oxygen/Value": "160"}),
    ("— along the stretch", {**DIVIDING, CYCLE + "Division axis": "stretch"}),
    ("— along the surface normal", {
        **DIVIDING, CYCLE + "Division axis": "surface normal"}),
    ("— two types, one becomes the other", {
        **DIVIDING, "Cell types/Names": "stem, leaf",
        "Cell types/stem/Transitions/To leaf": "0.2"}),
    ("— five keys of the cell's state", {
        **DIVIDING, CYCLE + "G0 exit rate": "0.375*ramp(pressure, 1, 0)",
        CYCLE + "Duration": "normal(1, 0.05)",
        CYCLE + "Size checkpoint": "0.1*(generation > 3)",
        "Material/Young's modulus": "1 + 0.1*generation",
        "Growth/Law": "isotropic",
        "Growth/Isotropic/Stretch": "1 + 0.001*t"}),
]


def effects(runner):
    rows = [("scene", "µs a cell and step", "Newton iterations a step",
             "B a cell more than the first", "sections of the timing table")]
    first = None
    for name, keys in EFFECTS:
        run = runner.run("effect", HALF_FIXED,
                         {"Growth/Law": "none", "Boundary conditions/Fixed where": "",
                          "Time/End time": 1, "Time/Step": 0.1, **keys})
        cells = int(run.rows[-1]["cells"])
        time = run.time("total") - run.time(*BESIDE_STEPS)
        first = first or run.memory
        names = [section for section in run.sections
                 if section not in NEWTON + NO_STEP + ("commit", "grid",
                                                       "points",
                                                       "sparsity pattern")]
        rows.append((name, f"{1e6 * time / run.cell_steps():.1f}",
                     f"{run.total('newton_iterations') / 10:.1f}",
                     f"{max(0, run.memory - first) / cells:.0f}",
                     ", ".join(names)))
    return rows


# What --explain is calibrated with: 2-D and 3-D, with division and without,
# both solvers, coarse and fine grids.
DISC = {"Tissue/Radius": 1500, "Time/End time": 1,
        "Proliferation/Cell cycle/Duration": 1,
        "Proliferation/Cell cycle/Size checkpoint": 0}
ESTIMATED = [
    ("3-D, growth", "prm/paper/fig-2b.prm", {"Time/End time": 2}),
    ("— fine grid", "prm/paper/fig-2b.prm",
     {"Time/End time": 2, "Grid/Spacing": 25}),
    ("— direct solver", "prm/paper/fig-2b.prm",
     {"Time/End time": 2, "Grid/Spacing": 33,
      "Solver/Linear solver": "direct"}),
    ("— ln J_e projected", "prm/paper/fig-2b.prm",
     {"Time/End time": 2, "Material/Volumetric strain": "projected"}),
    ("— small cells", "prm/verification/slip-half-3d.prm", {}),
    ("3-D, division", "prm/paper/fig-4b.prm",
     {"Time/End time": 0.5, "Time/Step": 0.1,
      "Proliferation/Cell cycle/Size checkpoint": 0}),
    ("2-D, body force", "prm/verification/vortex-2d.prm", {}),
    ("2-D, growth", "prm/hard/growing-ring.prm", {"Time/End time": 0.2}),
    ("2-D, division", "tests/scenes/proliferating-disc.prm", DISC),
    ("— direct solver", "tests/scenes/proliferating-disc.prm",
     {**DISC, "Solver/Linear solver": "direct"}),
    # judged by the fit, not fitted
    ("not fitted: Fig. 3b", "prm/paper/fig-3b.prm", {"Time/End time": 2}),
    ("not fitted: free block", "prm/hard/free-block.prm",
     {"Time/End time": 0.5}),
    ("not fitted: patch, 3-D", "prm/verification/patch-3d.prm", {}),
    ("not fitted: film, 2-D", "prm/hard/wrinkling-film.prm",
     {"Time/End time": 0.2}),
    ("not fitted: few cells, 3-D", "prm/hard/division.prm", {}),
]


def explained(runner, scene, keys):
    """(memory in GB, seconds) that --explain expects."""
    text = call([runner.morula, ROOT / scene, "--explain", *overrides(keys)],
                cwd=ROOT).stdout
    memory = re.search(r"memory: about (\S+) GB", text)
    time = re.search(r"time: about .* \((\S+) s\)", text)
    return float(memory[1]), float(time[1])


def estimates(runner):
    """Memory and time that --explain expects against those of the run."""
    rows = [("scene", "cells", "unknowns", "steps", "memory, GB",
             "--explain, GB", "time, s", "--explain, s")]
    for name, scene, keys in ESTIMATED:
        keys = {"Output/Formats": "none", **keys}
        memory, time = explained(runner, scene, keys)
        run = runner.run("estimate", scene, keys)
        rows.append((name, f"{int(run.rows[-1]['cells']):,}",
                     f"{int(run.rows[-1]['unknowns']):,}",
                     f"{len(run.rows) - 1}", f"{run.memory / 1e9:.2f}",
                     f"{memory:.2f}", f"{run.time('total'):.1f}",
                     f"{time:.1f}"))
    return rows
