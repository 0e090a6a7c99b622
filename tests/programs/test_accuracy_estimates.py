# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""The estimates of contrib/accuracy against made-up values whose limit, order,
noise and fronts are known: no run of the program.
"""
import math
import unittest
from pathlib import Path

import numpy
from morula import expressions
from morula.accuracy import offsets
from morula.accuracy.estimate import center_of, estimate
from morula.accuracy.front import Wanted, cheapest, pareto, read_wanted
from morula.accuracy.limits import (DEFAULT_KINDS, limit_of, observed_order,
                                    size_of)
from morula.accuracy.measures import read_measure
from morula.accuracy.request import output_interval
from morula.ladder import Plan, read_ladder, read_seeds
from morula.prm import parse
from morula.refusal import Refused
from morula.scene import normal

ROOT = Path(__file__).resolve().parents[2]
SPACE = {"Dimension": "3"}  # keys of a scene


class MadeUpScene:
    """Keys without a program behind them."""

    dimension = 3
    keys = {"Grid/Spacing": "50", "Tissue/Cell spacing": "10",
            "Time/Step": "1", "Grid/Occupation parameter": "0.85",
            "Solver/Newton tolerance": "1e-6", "Tissue/Size": "1, 2, 3"}

    def __getitem__(self, key):
        return self.keys[key]

    def require_key(self, key, option):
        assert key in self.keys, (key, option)


def plan_of(*ladders, full_grid=False):
    scene = MadeUpScene()
    return Plan(scene, [read_ladder(text, scene) for text in ladders],
                full_grid)


def estimate_of(plan, function, seeds=(0.0,), reference=None):
    """With the values function(number of each key) + what the seed adds."""
    center = center_of(plan, DEFAULT_KINDS)
    values = {point: numpy.array(
        [function(*map(float, point), seed) for seed in seeds])
        for point in plan.points}
    return estimate(plan, center, DEFAULT_KINDS, read_measure("zmax", SPACE),
                    1.0, values, reference)


def one(value):
    return numpy.array([value])


class Offsets(unittest.TestCase):
    def test_they_fill_the_grid_cell(self):
        """Of 2^k offsets each direction has the multiples of 1/2^k once, the
        first being the scene's own; more of them add to fewer."""
        for dimension in (2, 3):
            found = offsets.fractions(16, dimension)
            self.assertEqual(found[0], (0.0,) * dimension)
            for axis in range(dimension):
                self.assertEqual(sorted(point[axis] for point in found),
                                 [i / 16 for i in range(16)])
            for number in (2, 3, 7, 16):
                self.assertEqual(offsets.fractions(number, dimension),
                                 found[:number])

    def test_they_are_parts_of_the_spacing(self):
        keys = {"Grid/Offset": "1, 2.5", "Grid/Spacing": "40"}
        self.assertEqual(offsets.moved_offset(keys, (0.5, 0.25)), "21,12.5")
        self.assertEqual(offsets.moved_offset(keys, (0.5, 0.25, 0.75)),
                         "21,12.5,30")

    def test_samples(self):
        found = offsets.samples([1, 2], 2, 3)
        self.assertEqual([(s.seed, s.moved) for s in found],
                         [(1, (0.0,) * 3), (2, (0.0,) * 3),
                          (1, (0.5,) * 3), (2, (0.5,) * 3)])
        keys = {"Grid/Offset": "0, 0, 0", "Grid/Spacing": "50"}
        self.assertEqual(found[0].overrides(keys), [("Random seed", "1")])
        self.assertEqual(found[3].overrides(keys),
                         [("Grid/Offset", "25,25,25"), ("Random seed", "2")])
        self.assertEqual(offsets.samples(None, None, 3),
                         [offsets.Sample(None, None)])


class Limits(unittest.TestCase):
    def test_order_and_limit_are_found(self):
        for order in (0.6, 1.0, 2.0, 3.5):
            sizes = (100.0, 33.0, 50.0, 75.0)
            values = [one(7.0 + 1e-4 * size**order) for size in sizes]
            limit = limit_of(sizes, values, "zero")
            self.assertAlmostEqual(limit.order, order, places=5)
            self.assertAlmostEqual(float(limit.apply(values)[0]), 7.0,
                                   places=6)
            self.assertAlmostEqual(limit.uncertainty, 1e-4 * 33.0**order,
                                   places=6)

    def test_no_order_is_made_up(self):
        """Values that turn round, that hardly converge, that jump: the finest
        one, with the spread as its uncertainty."""
        for values in ((1.0, 3.0, 2.0), (1.0, 2.0, 2.2), (1.0, 1.0001, 9.0)):
            limit = limit_of((1.0, 2.0, 4.0), [one(v) for v in values],
                             "zero")
            self.assertEqual(limit.note, "not asymptotic", values)
            self.assertEqual(limit.weights, {0: 1.0})
            self.assertAlmostEqual(limit.uncertainty,
                                   max(values) - min(values))

    def test_power_law_through_values_that_scatter(self):
        """7 + 0.01 s with a disturbance that spoils the three finest."""
        sizes = (100.0, 75.0, 50.0, 33.0, 25.0)
        values = [one(7 + 0.01 * size + error) for size, error in
                  zip(sizes, (0.01, -0.02, 0.015, 0.03, -0.02))]
        self.assertFalse(0.5 <= observed_order(
            sizes[:1:-1], [float(v[0]) for v in values[:1:-1]]) <= 4.5)
        limit = limit_of(sizes, values, "zero")
        self.assertTrue(limit.note.startswith("fit of order"), limit.note)
        self.assertLess(abs(float(limit.apply(values)[0]) - 7.0),
                        limit.uncertainty)
        self.assertLess(limit.uncertainty, 0.5)
        self.assertAlmostEqual(sum(limit.weights.values()), 1.0)

    def test_two_values(self):
        limit = limit_of((50.0, 100.0), [one(2.0), one(3.0)], "zero")
        self.assertEqual((limit.note, limit.uncertainty), ("two values", 1.0))

    def test_tolerances_are_not_extrapolated(self):
        values = [one(1.0 + size) for size in (1e-2, 1e-4, 1e-6)]
        limit = limit_of((1e-2, 1e-4, 1e-6), values, "tolerance")
        self.assertEqual(limit.weights, {2: 1.0})
        self.assertAlmostEqual(limit.uncertainty, 1e-4 - 1e-6)

    def test_differences_within_the_noise(self):
        """Seeds that disagree about the sign of a difference."""
        generator = numpy.random.default_rng(1)
        values = [1.0 + 0.1 * generator.standard_normal(8) for _ in range(3)]
        self.assertEqual(limit_of((1.0, 2.0, 4.0), values, "zero").note,
                         "noise")

    def test_sizes(self):
        self.assertEqual(size_of("50", "zero", 3), 50)
        self.assertEqual(size_of("400", "large", 3), 0.05)
        self.assertEqual(size_of("400", "large", 2), 0.0025)
        for value, kind in (("0", "tolerance"), ("iterative", "zero"),
                            ("1", "none")):
            self.assertIsNone(size_of(value, kind, 3))

    def test_order_of_values_that_turn_round(self):
        self.assertTrue(math.isnan(observed_order((1, 2, 4), (1, 3, 2))))


class Estimates(unittest.TestCase):
    def test_errors_that_add_up(self):
        """Q = 5 + h^2 + 3 dt: the star finds 5 though no run is near it, and
        what either ladder has in it."""
        plan = plan_of("Grid/Spacing=100,75,50", "Time/Step=4,2,1")
        self.assertEqual(len(plan.points), 5)
        found = estimate_of(plan, lambda h, dt, _: 5 + 1e-4 * h**2 + 3 * dt)
        self.assertAlmostEqual(found.right, 5.0, places=6)
        self.assertAlmostEqual(found.errors[plan.own], 0.25 + 3, places=6)
        self.assertAlmostEqual(found.parts[0].change, -0.25, places=6)
        self.assertAlmostEqual(found.parts[1].change, -3.0, places=6)
        self.assertAlmostEqual(found.uncertainty, 3.25, places=6)

    def test_grid_goes_from_its_finest_corner(self):
        plan = plan_of("Grid/Spacing=100,75,25", "Time/Step=4,2,0.5",
                       full_grid=True)
        self.assertEqual(len(plan.points), 9)
        self.assertEqual(center_of(plan, DEFAULT_KINDS), ("25", "0.5"))
        found = estimate_of(plan, lambda h, dt, _: 5 + 1e-4 * h**2 + 3 * dt)
        self.assertAlmostEqual(found.right, 5.0, places=6)

    def test_a_key_counts_once(self):
        """The same grid spacing alone and with the cells': one of the two."""
        plan = plan_of("Grid/Spacing=100,75,50",
                       "Grid/Spacing,Tissue/Cell spacing=100:20,75:15,50:10")
        found = estimate_of(plan, lambda h, _, __: 5 + 1e-4 * h**2)
        self.assertEqual([part.used for part in found.parts], [True, False])
        self.assertAlmostEqual(found.right, 5.0, places=6)

    def test_finest_run_is_no_right_value(self):
        """Two rungs, or three without an order: the finest run's value, whose
        own error nobody knows; one order, or a file, tells more."""
        for ladder, law, finest in (
                ("Grid/Spacing=100,50", lambda h, _: 5 + h, "50"),
                ("Grid/Spacing=100,75,50", lambda h, _: {75: 9}.get(h, h),
                 "50")):
            found = estimate_of(plan_of(ladder), law)
            self.assertEqual(found.compared_with, (finest,))
            self.assertEqual(found.source, "finest run")
        plan = plan_of("Grid/Spacing=100,75,50")
        found = estimate_of(plan, lambda h, _: 5 + 1e-4 * h**2)
        self.assertIsNone(found.compared_with)
        self.assertEqual(found.source, "ladders")
        self.assertIsNone(estimate_of(plan, lambda h, _: 5).compared_with)
        found = estimate_of(plan_of("Grid/Occupation parameter=0.5,0.85,1"),
                            lambda C, _: 5 + C)
        self.assertEqual(found.compared_with, ("0.85",))
        self.assertEqual(found.source, "scene's run")

        class Reference:
            @staticmethod
            def value(_measure, _time):
                return 55.0, 0.0

        found = estimate_of(plan_of("Grid/Spacing=100,50"),
                            lambda h, _: 5 + h, (0.0,), Reference)
        self.assertEqual(found.errors[("50",)], 0)
        self.assertIsNone(found.compared_with)
        self.assertEqual(found.source, "reference file")

    def test_setting_without_a_limit(self):
        plan = plan_of("Grid/Occupation parameter=0.5,0.85,1")
        found = estimate_of(plan, lambda C, _: 5 + C)
        self.assertAlmostEqual(found.uncertainty, 0.5)
        self.assertEqual(found.errors[plan.own], 0)

    def test_noise(self):
        """What seeds add to all runs alike is scatter of the values, not noise
        of the differences."""
        plan = plan_of("Grid/Spacing=100,75,50")
        seeds = (-1.0, 0.0, 1.0)
        found = estimate_of(plan, lambda h, s: 5 + 1e-4 * h**2 + s, seeds)
        self.assertAlmostEqual(found.scatter[plan.own], 1.0)
        self.assertAlmostEqual(found.noise[plan.own], 0.0, places=9)
        self.assertAlmostEqual(found.right, 5.0, places=6)

        class Reference:
            @staticmethod
            def value(_measure, _time):
                return 5.0, 0.1

        found = estimate_of(plan, lambda h, s: 5 + 1e-4 * h**2 + s, seeds,
                            Reference)
        self.assertAlmostEqual(found.noise[plan.own], 2 / math.sqrt(3))
        self.assertAlmostEqual(found.bound(plan.own),
                               0.25 + 0.1 + 2 / math.sqrt(3))


class Fronts(unittest.TestCase):
    def test_front(self):
        costs = (1, 2, 3, 4, 5, 2)
        errors = (9, 5, 6, 1, 1, 4)
        self.assertEqual(pareto(costs, errors), [0, 5, 3])

    def test_cheapest(self):
        self.assertEqual(cheapest((3, 1, 2), (1, 9, 2), 2.5), 2)
        self.assertIsNone(cheapest((3, 1, 2), (1, 9, 2), 0.5))

    def test_measures_that_a_scene_has(self):
        """Numbers of cells by type and values of fields, by their names."""
        keys = {**SPACE, "Cell types/Names": "stem, leaf",
                "Fields/Names": "oxygen"}
        for word in ("cells_stem", "cells_leaf", "oxygen_mean"):
            self.assertEqual(read_measure(word, keys).column, word)
            with self.assertRaisesRegex(Refused, word):
                read_measure(word, SPACE)
        with self.assertRaisesRegex(Refused, "Did you mean 'cells_leaf'"):
            read_measure("cells_leave", keys)

    def test_wanted(self):
        measures = [read_measure(word, SPACE)
                    for word in ("zmax", "total_volume")]
        found = read_wanted("zmax=0.5um, 1%", measures)
        self.assertEqual(found[measures[1]], Wanted("1%", 1.0, "%"))
        self.assertEqual(found[measures[1]].absolute(-300.0), 3.0)
        found = read_wanted("0.5um", measures)
        self.assertEqual(set(found), {measures[0]})


class Words(unittest.TestCase):
    def test_ladders(self):
        scene = MadeUpScene()
        self.assertEqual(read_ladder("Tissue/Size=1,1,1|2,2,2", scene).rungs,
                         (("1,1,1",), ("2,2,2",)))
        plan = plan_of("Tissue/Size=1,2,3.0|2,2,2")
        self.assertEqual(len(plan.points), 2)
        self.assertEqual(normal(" 1e1, 2.50"), "10,2.5")

    def test_names(self):
        """The same keys under two names; only what changes is in a label; a
        scene beside the path is on the line, but not on the path."""
        plan = plan_of("coarse: Grid/Spacing,Time/Step=100:2,75:2",
                       "fine: Grid/Spacing,Time/Step=75:0.5,25:0.5")
        self.assertEqual([ladder.name for ladder in plan.ladders],
                         ["coarse", "fine"])
        coarse = plan.ladders[0]
        self.assertEqual([plan.rung_label(coarse, point) for point in
                          plan.path(coarse, plan.own)], ["100", "75"])
        self.assertIn(plan.own, plan.line(coarse, plan.own))

    def test_seeds(self):
        self.assertEqual(read_seeds("1..3, 7"), [1, 2, 3, 7])

    def test_outputs_meet_all_times(self):
        for times, interval in (([2.0], "0"), ([0.5, 2.0], "0.5"),
                                ([0.3, 0.5, 1.0], "0.1")):
            self.assertEqual(output_interval(times), interval)

    def test_expressions(self):
        self.assertAlmostEqual(expressions.evaluate(
            "10*(theta - 1)", {"theta": 1.2}, "-"), 2.0)

    def test_parameter_files(self):
        keys = parse("set A = 1 # one\nsubsection B\n  subsection C\n"
                     "  set D = 2, \\\n 3\n  end\n  set E =\nend\nset A = 4\n")
        self.assertEqual(keys, {"A": "4", "B/C/D": "2,  3", "B/E": ""})

