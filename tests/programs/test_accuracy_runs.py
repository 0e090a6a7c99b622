# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""contrib/accuracy on runs of the program: error bars and ladders whose truth is known,
offsets of the grid, seeds, runs that fail, an executable that changes."""
import csv
import math
import os
import shutil
import statistics

import matplotlib.image
import pytest
from morula import columns
from morula.execute import overrides
from morula.report import numbers
from morula.run import Run
from scipy.special import iv
from tests.common.program import SCENES, TESTS

from tests.verification.radial import GrowingBall, Layer

ROOT = TESTS.parent
DISC = TESTS / "programs/disc.prm"

# A disc that grows most at its rim, with nothing random.
GRADED_DISC = """
set Dimension = 2
subsection Time
  set End time = 1
  set Step = 1
end
subsection Tissue
  set Radius = 250
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 50
  set Offset = 3, 5
end
subsection Material
  set Energy per        = initial volume
  set Volumetric strain = pointwise
end
subsection Growth
  set Law = isotropic
  subsection Isotropic
    set Stretch = 1 + 0.4*t*(X^2+Y^2)/250^2
  end
end
subsection Solver
  set Newton tolerance = 1e-9
end
"""
LADDER = ["--vary", "Grid/Spacing,Tissue/Cell spacing=100:20,70:14,50:10,35:7",
          "--measure", "surface:mean(radius),total_volume"]


@pytest.fixture(scope="module")
def accuracy(runs):
    """The tool, which writes into a directory of `found`; what it says."""
    def call(scene, *words, code=0):
        if "--morula" not in words:
            words = (*words, "--morula", runs.options.morula)
        done = runs.call([ROOT / "contrib/accuracy", scene, "--output",
                          runs.work / "found", "--mpiexec", runs.options.mpiexec,
                          *words], code)
        return done.stdout + done.stderr
    return call


def newest(runs, name):
    """The file of this name that the last command has written."""
    return max((runs.work / "found").glob(f"*/{name}"), key=os.path.getmtime)


@pytest.fixture
def table(runs):
    """Reads such a file as dictionaries of text."""
    return lambda name="table.csv": list(csv.DictReader(newest(runs, name).open(encoding="utf-8")))


def assert_drawn(runs, name, least=0.03):
    """The figure is there, and something is on it."""
    picture = matplotlib.image.imread(newest(runs, name))
    assert picture[:, :, :3].std() > least
    newest(runs, name).unlink()


GRADED = Layer(0, 250, lambda R: 1 + 0.4 * R**2 / 250**2, lambda R: 0.8 * R / 250**2)


def exact_radius(*layers):
    constants = (0.4 / 1.4 / 0.2, 0.5 / 1.4)  # E = 1 kPa, nu = 0.4
    ball = GrowingBall(layers or [GRADED], constants, 2, False)
    return float(250 * ball.stretches([250.0])[1][0])


# A disc whose cells use up oxygen in proportion to what there is, with
# phi = R sqrt(k/D) = 2: its mean is 2 I1(phi)/(phi I0(phi)) of that outside.
OXYGEN = """
set Dimension = 2
subsection Time
  set End time = 0.1
  set Step = 0.1
end
subsection Tissue
  set Radius = 100
  set Cell spacing = 10
end
subsection Grid
  set Spacing = 40
end
subsection Fields
  set Names = oxygen
  subsection oxygen
    set Diffusion = 1e8
    set Consumption = 4e4
    set Initial = 160
    set Fixed where = 1
    set Value = 160
  end
end
"""
KNOWN = {  # scene, measure, exact value
    "graded": (GRADED_DISC, "total_volume", lambda: math.pi * exact_radius()**2),
    "oxygen": (OXYGEN, "oxygen_mean", lambda: 160 * iv(1, 2) / iv(0, 2)),
    "core": (GRADED_DISC.replace("(X^2+Y^2)/250^2", "(X^2+Y^2 < 125^2)"), "surface:mean(radius)",
             lambda: exact_radius(Layer(0, 125, lambda R: 1.4 + 0 * R, lambda R: 0.0),
                                  Layer(125, 250, lambda R: 1 + 0 * R, lambda R: 0.0)))}


@pytest.mark.parametrize("name", KNOWN)
def test_error_bar_of_a_known_answer(runs, accuracy, name):
    """The true error is below the bar, and above a sixth of it."""
    text, measure, exact = KNOWN[name]
    directory = runs.work / f"own-{name}"
    said = accuracy(runs.write(f"{name}.prm", text), "--measure", measure, "-s",
                    f"Output directory={directory}")
    assert f"{measure} = " in said and "half of it would cost" in said
    row = Run(directory).errors.loc[measure]
    assert row.error / 6 < abs(row.value - exact()) < row.error


def test_error_bar_by_chance(runs, accuracy):
    """At most 16 further runs of a random tissue; the scene's own run is done once, and a
    second command adds to what the first one has kept."""
    words = [DISC, *overrides({"Output directory": runs.work / "own", "Time/End time": 0.5,
                               "Time/Step": 0.125})]
    accuracy(*words, "--measure", "cells")
    before = (runs.work / "own/statistics.csv").read_bytes()
    said = accuracy(*words, "--measure", "xmax,surface:std(radius)")
    assert (runs.work / "own/statistics.csv").read_bytes() == before
    plan = accuracy(*words, "--measure", "cells", "--plan").split()
    assert len(plan) <= 16 and said.count("from before") >= len(plan)
    assert said.count("half of it would cost") == 2 and "cells: not varied" in said
    run = Run(runs.work / "own")
    assert list(run.errors.index) == ["cells", "xmax", "surface:std(radius)"]
    assert run.errors.chance["xmax"] > 0 and run.errors.position["xmax"] > 0
    assert run.errors.value["xmax"] == run.statistics["xmax"].iloc[-1]
    assert [name for name, _ in numbers.errors(run)] == list(run.errors.index)
    (runs.work / "own/statistics.csv").write_bytes(before + b"\n")  # of another run
    assert run.errors.empty
    assert "run of other values" in accuracy(*words, "--measure", "xmax", "-s", "Grid/Spacing=50",
                                       code=1)


def test_truth(runs, accuracy, table):
    """Where the exact solution is known, the limit of the ladders agrees with it
    within the uncertainty that is stated; a file of right values gives errors. The
    same runs are not done twice."""
    scene = runs.write("graded.prm", GRADED_DISC)
    assert "from before" not in accuracy(scene, *LADDER)
    assert_drawn(runs, "accuracy.png")
    radius = exact_radius()
    right = {"um": radius, "um^2": math.pi * radius**2}
    for row in table():
        stated = float(row["right_value_uncertainty"])
        assert abs(float(row["right_value"]) - right[row["unit"]]) < stated
        # and no excuse: the radius to 0.2 um, the volume to 3 %
        assert stated < (0.2 if row["unit"] == "um" else 0.03 * right["um^2"])
        assert float(row["memory_mb"]) > 30 and float(row["processor_seconds"]) > 0
    reference = runs.write("exact.csv", "surface:mean(radius),total_volume\n"
                           f"{radius},{right['um^2']}\n")
    said = accuracy(scene, *LADDER, "--reference", reference)
    assert said.count("from before") == 4
    for row in table():
        assert float(row["error"]) == pytest.approx(
            float(row["value"]) - float(row["right_value"]), abs=1e-4)
        assert float(row["right_value"]) == pytest.approx(right[row["unit"]], 1e-9)
        assert float(row["right_value_uncertainty"]) == 0


def test_seeds(runs, accuracy, table):
    """Means over seeds, and cells' files."""
    accuracy(DISC, "--vary", "Grid/Spacing=80,40", "-s", "Time/Step=0.25", "--seeds", "1..2",
             "--measure", "cells,cells:p90(energy_density)")
    rows = table()
    assert len(rows) == 2 * 2
    assert all(float(row["seed_scatter"]) > 0 for row in rows)
    row, = (row for row in rows if (row["measure"], row["Grid/Spacing"]) == ("cells", "40"))
    found = map(Run, (runs.work / "found/runs").glob("Random-seed=*/output"))
    ends = [run.statistics["cells"].iloc[-1] for run in found if run.keys["Time/Step"] == "0.25"]
    assert len(ends) == 2
    assert float(row["value"]) == pytest.approx(sum(ends) / 2)
    assert_drawn(runs, "accuracy.png")


def test_offsets(runs, accuracy, table):
    """Every run stands where it says, and the table is made of them."""
    scene = runs.write("moved.prm", GRADED_DISC)
    words = ["--measure", "ymax,mean_energy_density", "--offsets"]
    accuracy(scene, *words, "3")
    rows = table("offsets.csv")
    assert {(row["moved_x"], row["moved_y"]) for row in rows} == {
        ("0", "0"), ("0.5", "0.5"), ("0.75", "0.25")}
    run = runs.run("by-hand", scene, {"Grid/Offset": "40.5,17.5"})
    for row in rows:
        if row["moved_x"] == "0.75":
            assert float(row["value"]) == pytest.approx(
                run.statistics[row["measure"]].iloc[-1], 1e-8)
    text = newest(runs, "table.md").read_text(encoding="utf-8")
    values = [float(row["value"]) for row in rows if row["measure"] == "ymax"]
    assert f"| ymax | 3 | {statistics.mean(values):.6g} µm | {min(values):.6g} µm | " in text
    assert max(values) / min(values) > 1 + 1e-6  # there is something to see


@pytest.mark.release
def test_more_offsets(runs, accuracy, table):
    """A larger number has the runs of the smaller one."""
    scene = runs.write("moved.prm", GRADED_DISC)
    words = ["--measure", "ymax,mean_energy_density", "--offsets"]
    accuracy(scene, *words, "3")
    assert accuracy(scene, *words, "4", "--vary", "Grid/Spacing=50,60").count(
        "from before") == 3
    assert len(table("offsets.csv")) == 2 * 2 * 4
    assert len(table()) == 2 * 2


def test_runs_that_fail(runs, accuracy, table):
    """Without extension and with grid lines that barely cut the tissue no step
    converges; without the run that all ladders share, only a file knows the truth."""
    scene = SCENES / "without-extension-fails.prm"
    words = [scene, "--vary", "Grid/Extension=false,true", "--measure", "zmax"]
    assert "left out, it failed with exit code 2" in accuracy(
        *words, "-s", "Grid/Extension=true")
    assert "| failed |" in newest(runs, "table.md").read_text(encoding="utf-8")
    assert len(table()) == 1
    accuracy(*words, code=2)
    accuracy(*words, "--reference", runs.write("reference.csv", "zmax\n250\n"))
    assert len(table()) == 1


@pytest.mark.release
def test_executable_that_changes(runs, accuracy):
    """Runs of two builds must not be compared: those of the old one are done anew,
    and a build in mid-run ends the command."""
    copy = runs.work / "morula"
    words = [DISC, "--morula", copy, "--vary", "Grid/Spacing=80,40", "--measure",
             "xmax", "-s", "Time/End time=0.25"]
    shutil.copy(runs.options.morula, copy)
    accuracy(*words)
    assert accuracy(*words).count("from before") == 2
    with copy.open("ab") as stream:
        stream.write(b"another build")
    assert "from before" not in accuracy(*words)
    copy.write_text("#!/bin/sh\ncase $* in *--parameters*|*--explain*) ;;\n"
                    f"*) echo '# new' >> {copy} ;; esac\n"
                    f"exec {runs.options.morula} \"$@\"\n")
    assert "nobody replaces" in accuracy(*words, code=1)


def test_names_of_columns(runs):
    """The names that measures may have are those that Morula writes."""
    # Only cells of some type have one.
    run = runs.run("columns", DISC, {"Output/Formats": "csv",
                                     "Cell types/Names": "only"})
    # Only scenes whose rates look at the state have an error of this kind.
    assert {*run.statistics, "step_error"} == {
        *columns.STATISTICS, *columns.EFFORT, "cells_only"}
    for kind, known in columns.POINTS.items():
        assert set(known) - {"radius"} <= set(getattr(run, kind)(0))


@pytest.mark.release
def test_two_ranks(accuracy, table):
    """Keys that change together on two ranks; the solver makes no difference."""
    accuracy(SCENES.parent / "programs/small-cube.prm", "--ranks", "2", "--vary",
             "Grid/Spacing,Tissue/Cell spacing=60:20,40:12", "--vary",
             "Solver/Linear solver=iterative,direct", "--measure", "zmax")
    heights = {row["Grid/Spacing"]: float(row["value"]) for row in table()}
    solved = [float(row["value"]) for row in table() if row["Grid/Spacing"] == "35"]
    assert len(solved) >= 2 and solved == pytest.approx([solved[0]] * len(solved), 1e-5)
    assert abs(heights["60"] - heights["35"]) > 1e-3
