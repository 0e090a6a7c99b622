# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Numbers of the tissue's shape, by closed forms."""
import numpy as np
import pytest

SCENE = {"Time/End time": 0.1, "Time/Step": 0.1, "Tissue/Shape": "points",
         "Tissue/Points surface": "always", "Output/Formats": "none",
         "Shape/Numbers": "true"}


def first(runs, name, dim, spacing, inside, half, keys=(), types=None, ranks=1):
    """The row of t = 0 of a tissue of the places of a lattice that are inside."""
    x = np.arange(-half, half, spacing) + spacing / 2 + 0.31 * spacing
    X = np.stack(np.meshgrid(*dim * [x], indexing="ij"), -1).reshape(-1, dim)
    X = X[inside(X)]
    rows = [",".join("xyz"[:dim]) + (",type" if types else "")]
    rows += [",".join(f"{c:.9g}" for c in x) + (f",{types(x)}" if types else "") for x in X]
    points = runs.write(f"{name}.csv", "\n".join(rows) + "\n")
    run = runs.run(name, SCENE, {"Dimension": dim, "Tissue/Points file": points,
                                 "Tissue/Cell spacing": spacing,
                                 "Grid/Spacing": 3 * spacing, **dict(keys)}, ranks=ranks)
    return run.statistics.iloc[0], run


def radius(X):
    return np.linalg.norm(X, axis=1)


def test_ellipse(runs):
    a, b = 80, 50
    row, _ = first(runs, "ellipse", 2, 2,
                   lambda X: (X[:, 0] / a)**2 + (X[:, 1] / b)**2 < 1, 90)
    t = 2 * np.pi * np.arange(4000) / 4000
    P = np.hypot(a * np.sin(t), b * np.cos(t)).mean() * 2 * np.pi
    r = a * b / np.hypot(b * np.cos(t), a * np.sin(t))
    assert row["roundness"] == pytest.approx(4 * np.pi**2 * a * b / P**2, rel=0.03)
    assert row["free_area"] == pytest.approx(P, rel=0.02)
    assert row["gyration_axis_1"] == pytest.approx(a / 2, rel=0.003)
    assert row["gyration_axis_2"] == pytest.approx(b / 2, rel=0.003)
    assert row["gyration_radius"] == pytest.approx(np.hypot(a, b) / 2, rel=0.003)
    assert row["radius_spread"] == pytest.approx(r.std() / r.mean(), rel=0.02)
    power = 2 * abs((r * np.exp(2j * t)).mean())**2 / r.mean()**2
    assert (row["lobes"], row["lobe_power"]) == (2, pytest.approx(power, rel=0.04))


def test_lobes(runs):
    """r = R (1 + e cos 5 phi): the power is e^2/2; half of the contacts of stripes."""
    e = 0.15
    keys = {"Cell types/Names": "one, other"}
    row, run = first(runs, "lobes", 2, 2, lambda X: radius(X) < 60 * (
        1 + e * np.cos(5 * np.arctan2(X[:, 1], X[:, 0]))), 80, keys,
        lambda x: ["one", "other"][int(np.floor(x[0] / 2)) % 2])
    assert (row["lobes"], row["lobe_power"]) == (5, pytest.approx(e**2 / 2, rel=0.05))
    assert row["radius_spread"] == pytest.approx(e / np.sqrt(2), rel=0.03)
    assert 0.3 < row["unlike_contacts"] < 0.7
    _, other = first(runs, "lobes-3", 2, 2, lambda X: radius(X) < 60 * (
        1 + e * np.cos(5 * np.arctan2(X[:, 1], X[:, 0]))), 80, keys,
        lambda x: ["one", "other"][int(np.floor(x[0] / 2)) % 2], ranks=3)
    for name in ("roundness", "gyration_radius", "gyration_axis_2", "radius_spread", "lobes",
                 "lobe_power", "free_area", "unlike_contacts"):
        assert list(run.statistics[name])[0] == list(other.statistics[name])[0], name


def test_ellipsoid(runs):
    axes = np.array([60, 45, 30])
    row, _ = first(runs, "ellipsoid", 3, 5, lambda X: radius(X / axes) < 1, 65)
    for k, axis in enumerate(axes):
        assert row[f"gyration_axis_{k + 1}"] == pytest.approx(axis / np.sqrt(5), rel=0.01)
    S = 4 * np.pi * (np.mean([(60 * 45)**1.6075, (60 * 30)**1.6075,
                              (45 * 30)**1.6075]))**(1 / 1.6075)
    assert row["free_area"] == pytest.approx(S, rel=0.02)
    assert row["roundness"] == pytest.approx(
        np.cbrt(36 * np.pi * (4 / 3 * np.pi * np.prod(axes))**2) / S, rel=0.02)
    assert row["lobes"] == 2


def test_fourth_harmonic(runs):
    """r = R (1 + e P_4(cos theta)): the power is e^2/9, but for the centre's way."""
    def inside(X):
        c = X[:, 2] / np.maximum(radius(X), 1e-9)
        return radius(X) < 50 * (1 + 0.3 * (35 * c**4 - 30 * c**2 + 3) / 8)

    row, _ = first(runs, "fourth", 3, 4, inside, 70)
    assert (row["lobes"], row["lobe_power"]) == (4, pytest.approx(0.01, rel=0.1))


def test_absent(runs):
    run = runs.run("absent", {"Dimension": 2, "Time/End time": 0.1, "Time/Step": 0.1})
    assert not {"roundness", "lobes", "free_area"} & set(run.statistics.columns)
