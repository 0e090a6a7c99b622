# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Computes the reference for the half-fixed sphere anew.

Runs build/half-fixed-sphere on ladders of meshes, extrapolates toward a mesh
with infinitely small grid cells at the edge of the held surface, estimates the
error from how far the finest meshes are from that, and writes

  doc/data/half-fixed-sphere.csv          values and errors
  doc/data/half-fixed-sphere-outline.csv  the upper surface on the finest mesh
  doc/images/half-fixed-sphere.png        outlines, and the mesh at the edge

and the tables of this version (doc/measured). doc/half-fixed-sphere.md says what
the numbers mean.
"""
import argparse
import sys
from pathlib import Path

import numpy
from morula.execute import call, overrides
from morula.tables import markdown
from upkeep.made import made_with
from upkeep.version_data import store

ROOT = Path(__file__).resolve().parents[3]

# Degree, uniform levels, edge levels from coarse to fine: three ways to resolve
# everything but the edge, each with three sizes of the grid cells there. The
# outline is that of the last run of all.
LADDERS = [(2, 2, (2, 4, 6)), (3, 1, (2, 4, 6)), (4, 1, (1, 3, 5))]
QUANTITIES = ("apex", "total_volume", "mean_energy_density")
UNIFORM = (4, 6, 8)  # subdivisions: 49, 33, 25 um
EDGES = (-10, -5, 0, 5, 10)  # um


def mesh(degree, uniform, edge):
    """The keys of a mesh. Higher polynomials need more points to be watched."""
    return {"Degree": degree, "Uniform levels": uniform, "Edge levels": edge,
            "Edge quadrature points": 6 * degree}


class Runs:
    """Runs of the program, each in the work directory under its own name;
    those found there, of the same build, are not repeated."""

    def __init__(self, program, work):
        self.program, self.work = program, work
        work.mkdir(parents=True, exist_ok=True)

    def file(self, keys, ending=".csv"):
        """The result of a run with these keys."""
        name = "-".join(f"{key}={value}" for key, value in keys.items())
        prefix = self.work / name.replace(" ", "_")
        done = Path(f"{prefix}.done")
        built = self.program.stat().st_mtime
        if not done.exists() or done.stat().st_mtime < built:
            print(name, flush=True)
            if call([self.program, *overrides({"Output": prefix, **keys})],
                    stdout=f"{prefix}.log", stderr=None).code:
                sys.exit(f"half-fixed-sphere: failed, see {prefix}.log")
            done.touch()
        return Path(f"{prefix}{ending}")

    def table(self, **keys):
        """The summary of a run; underscores in keys stand for blanks."""
        keys = {key.replace("_", " "): value for key, value in keys.items()}
        return numpy.genfromtxt(self.file(keys), delimiter=",", names=True)

    def ladder(self, degree, uniform, edges):
        return [numpy.genfromtxt(self.file(mesh(degree, uniform, edge)),
                                 delimiter=",", names=True) for edge in edges]


def extrapolated(values):
    """The limit of three values that converge geometrically (Aitken); the last
    one if they do not, row by row."""
    first, second = values[1] - values[0], values[2] - values[1]
    with numpy.errstate(divide="ignore", invalid="ignore"):
        ratio = first / second
    limit = values[2] + second / (numpy.where(ratio > 1.5, ratio, 2) - 1)
    return numpy.where(ratio > 1.5, limit, values[2])


def reference(ladders):
    """Value and error of each quantity: the mean of the ladders' limits, and
    how far a finest mesh or a limit is from it at most."""
    result = {}
    for name in QUANTITIES:
        runs = [[run[name] for run in ladder] for ladder in ladders]
        limits = [extrapolated(values) for values in runs]
        value = numpy.mean(limits, axis=0)
        result[name] = value
        result[f"{name}_error"] = numpy.max(
            [abs(other - value)
             for other in limits + [values[-1] for values in runs]], axis=0)
    return result


def write_csv(path, columns):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        for row in zip(*columns.values()):
            file.write(",".join(f"{value:.10g}" for value in row) + "\n")


def numbers(run, i):
    return [f"{run['apex'][i]:.3f}", f"{run['total_volume'][i] / 1e6:.3f}",
            f"{run['mean_energy_density'][i]:.6f}"]


def convergence_table(ladders, i):
    """The runs of all ladders for the i-th stretch."""
    rows = []
    for (degree, uniform, edges), runs in zip(LADDERS, ladders):
        for edge, run in zip(edges, runs):
            rows.append([str(degree), str(uniform), str(edge),
                         f"{run['innermost_size'][i]:.2f}",
                         f"{run['unknowns'][i]:.0f}", *numbers(run, i),
                         f"{run['min_elastic_volume_ratio'][i]:.4f}",
                         f"{run['max_elastic_volume_ratio'][i]:.1f}"])
        limit = {name: extrapolated([run[name] for run in runs])
                 for name in QUANTITIES}
        rows.append([str(degree), str(uniform), "∞", "0", "",
                     *numbers(limit, i), "", ""])
    return markdown(["degree", "uniform levels", "edge levels",
                     "size at the edge, µm", "unknowns", "apex, µm",
                     "volume, 10⁶ µm³", "mean energy, kPa", "least $J_e$",
                     "largest $J_e$"], rows)


def reference_table(values, stretches):
    def plus_minus(name, i, scale, digits):
        return (f"{values[name][i] / scale:.{digits}f} ± "
                f"{values[name + '_error'][i] / scale:.{digits}f}")
    rows = [[f"{theta:g}", plus_minus("apex", i, 1, 2),
             plus_minus("total_volume", i, 1e6, 3),
             plus_minus("mean_energy_density", i, 1, 6)]
            for i, theta in enumerate(stretches)]
    return markdown(
        ["θ", "apex, µm", "volume, 10⁶ µm³", "mean energy, kPa"], rows)


def difference_table(label, runs, base, stretches):
    """Relative differences of the runs from the base, in per cent."""
    header = [label] + [f"{name}, θ = {theta:g}" for name in
                        ("apex", "volume", "energy")
                        for theta in (stretches[0], stretches[-1])]
    rows = []
    for text, run in runs:
        rows.append([text] + [f"{100 * (run[name][i] / base[name][i] - 1):+.2f}"
                              for name in QUANTITIES for i in (0, -1)])
    return markdown(header, rows)


def draw(outline, vtu_run, path):
    """Outlines on the left, the deformed mesh beside the edge on the right."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 5.4))
    angle = numpy.linspace(0, numpy.pi, 181)
    left.plot(250 * numpy.sin(angle), 250 * numpy.cos(angle), color="0.7",
              label="θ = 1")
    held = numpy.linspace(numpy.pi / 2, numpy.pi, 91)
    for axes in (left, right):
        axes.plot(250 * numpy.sin(held), 250 * numpy.cos(held), color="C3",
                  linewidth=3, label="held")
    for theta in numpy.unique(outline["theta"]):
        rows = outline[outline["theta"] == theta]
        left.plot(rows["r"], rows["z"], label=f"θ = {theta:g}")
    left.set(xlabel="r, µm", ylabel="z, µm", title="outline")
    left.legend(loc=(0.1, 0.12), fontsize=8)
    for line in mesh_lines(vtu_run):
        right.plot(*line, color="k", linewidth=0.5)
    right.set(xlim=(225, 275), ylim=(-25, 25), xlabel="r, µm",
              title="grid cells at the edge, θ = 1.4")
    for axes in (left, right):
        axes.set_aspect("equal")
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


def mesh_lines(vtu):
    """The sides of the deformed grid cells of a VTU file, as (r, z) of points
    on the polynomial through their nodes."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(vtu))
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData()) + vtk_to_numpy(
        grid.GetPointData().GetArray("displacement"))
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        for e in range(cell.GetNumberOfEdges()):
            # VTK's order: the two ends first, then the points between
            ids = cell.GetEdge(e).GetPointIds()
            ids = [ids.GetId(k) for k in range(ids.GetNumberOfIds())]
            nodes = points[[ids[0], *ids[2:], ids[1]], :2]
            at = numpy.linspace(0, 1, len(nodes))
            fine = numpy.linspace(0, 1, 12)
            yield [numpy.polyval(numpy.polyfit(at, x, len(at) - 1), fine)
                   for x in nodes.T]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/half-fixed-sphere",
                        type=Path, help="the executable")
    parser.add_argument("--work", type=Path,
                        default=ROOT / "output/half-fixed-sphere",
                        help="directory for the runs; what is found there is "
                        "used again")
    parser.add_argument("--doc", type=Path, default=ROOT / "doc",
                        help="where data/ and images/ are written")
    options = parser.parse_args()
    if not options.program.exists():
        sys.exit(f"half-fixed-sphere: there is no {options.program}; build it "
                 "with contrib/build, or name it with --program.")

    runs = Runs(options.program.resolve(), options.work.resolve())
    ladders = [runs.ladder(*ladder) for ladder in LADDERS]
    stretches = ladders[0][0]["theta"]
    values = reference(ladders)
    write_csv(options.doc / "data/half-fixed-sphere.csv",
              {"theta": stretches, **values})

    degree, uniform, edges = LADDERS[-1]
    outline = numpy.genfromtxt(
        runs.file(mesh(degree, uniform, edges[-1]), "-outline.csv"),
        delimiter=",", names=True)
    write_csv(options.doc / "data/half-fixed-sphere-outline.csv",
              {name: outline[name] for name in outline.dtype.names})
    picture = {**mesh(2, 1, 4), "Write VTU": "true"}
    draw(outline, runs.file(picture, "-1.4.vtu"),
         options.doc / "images/half-fixed-sphere.png")

    plain = [(f"{numpy.pi / 4 * 250 / n:.0f} µm", runs.table(
        Subdivisions=n, Edge_levels=0, Uniform_levels=0,
        Edge_quadrature_points=0)) for n in UNIFORM]
    moved = [(f"{z} µm", runs.table(Clamp_edge=z, Degree=2, Edge_levels=5,
                                    Uniform_levels=1)) for z in EDGES]
    tables = {"reference": reference_table(values, stretches),
              "ladders-1.1": convergence_table(ladders, 0),
              "ladders-1.4": convergence_table(ladders, -1),
              "sizes": difference_table("size", plain, values, stretches),
              "edges": difference_table("edge at", moved,
                                        moved[EDGES.index(0)][1], stretches)}
    print(*tables.values(), sep="\n\n")
    store("half-fixed-sphere", tables, made_with(ROOT), ROOT)
