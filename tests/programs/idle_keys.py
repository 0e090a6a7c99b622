#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Keys that a scene sets and nothing reads: each is said, and none without
cause."""
from morula.execute import overrides
from program import ProgramTest, main

BOX = {"Dimension": 2, "Tissue/Shape": "box", "Tissue/Size": "100, 100",
       "Tissue/Cell spacing": 10, "Grid/Spacing": 40, "Time/End time": 0.2,
       "Time/Step": 0.1, "Output/Formats": "none"}
TYPES = {**BOX, "Cell types/Names": "a, b", "Cell types/b/Where": "X > 0"}
CYCLE = {**TYPES, "Proliferation/Law": "cell cycle",
         "Proliferation/Cell cycle/Duration": 0.2}
GROWS = {**TYPES, "Growth/Law": "isotropic",
         "Growth/Isotropic/Stretch": "1 + 0.1*t"}
RATE = {**TYPES, "Growth/Law": "rate", "Growth/Rate/Rate": 0.1}
MOVES = {**TYPES, "Rearrangement/Diffusion": 10}
DIES = {**BOX, "Death/When": "X > 40", "Death/Shrinking time": 0}
FIELD = {**BOX, "Fields/Names": "u", "Fields/u/Diffusion": 100,
         "Fields/u/Consumption": 1, "Fields/u/Production": 1}

IDLE = (
    ("Neighbours/Reach", 1.3, TYPES), ("Neighbours/Found by", "radius", TYPES),
    ("Neighbours/Reach", 1.3, MOVES), ("Tension/Force", "false", TYPES),
    ("Tension/Force", "false", {**TYPES, "Cell types/a/Tension/With b": 1}),
    ("Rearrangement/Fluctuation energy", 3, MOVES),
    ("Material/On transition", "forget stress", TYPES),
    ("Death/Final volume", 0.2, DIES),
    ("Growth/Rate/Predictor", "false", RATE),
    ("Solver/Largest gap", 0.1, BOX), ("Output/Snapshot interval", 5, BOX),
    ("Fields/u/Dilution", "false", FIELD),
    ("Growth/Rate/Rate", 0.3, GROWS),
    ("Cell types/b/Growth/Rate/Rate", 0.3, GROWS),
    ("Cell types/b/Material/Yield stress", 0.3, TYPES),
    ("Cell types/b/Growth/Rate/Homeostatic stress", 0.3, RATE),
    ("Cell types/b/Proliferation/Cell cycle/Axis spread", 3, CYCLE),
    ("Cell types/b/Proliferation/Cell cycle/Least anisotropy", 1.1, CYCLE),
    ("Proliferation/Cell cycle/Duration", 0.5,
     {**BOX, "Proliferation/Law": "none"}),
    ("Death/Final volume", 0.2, {**BOX, "Death/Rate": 0}))

READ = (
    ("Neighbours/Reach", 1.3, {**BOX, "Growth/Law": "rate",
                               "Growth/Rate/Rate": "0.01*neighbours"}),
    ("Rearrangement/Fluctuation energy", 3,
     {**MOVES, "Cell types/a/Tension/With b": 1}),
    ("Tension/Force", "false", {**MOVES, "Cell types/a/Tension/With b": 1,
                                "Rearrangement/Fluctuation energy": 1}),
    ("Material/On transition", "forget stress",
     {**TYPES, "Cell types/a/Transitions/To b": 1}),
    ("Growth/Rate/Predictor", "false",
     {**RATE, "Growth/Rate/Rate": "0.1*max(0, 1 - pressure)"}),
    ("Solver/Largest gap", 0.1,
     {**BOX, "Boundary conditions/Fixed where": "X < -49"}),
    ("Cell types/b/Proliferation/Cell cycle/Axis spread", 3,
     {**CYCLE, "Proliferation/Cell cycle/Division axis": "stretch"}),
    ("Fields/u/Value", 3, {**FIELD, "Fields/u/Fixed where": "X > 49"}))


class IdleKeys(ProgramTest):
    def explain(self, keys, number):
        return self.run_words(self.command(
            self.write(f"{number}.prm", ""), "--explain",
            *overrides(keys))).text

    def test_said(self):
        for number, (key, value, keys) in enumerate(IDLE):
            said = self.explain({**keys, key: value}, number)
            lines = [line for line in said.splitlines()
                     if line.startswith(f"Warning: {key} = ")]
            self.assertEqual(len(lines), 1, f"{key}: {said}")
            self.assertIn("it does nothing", lines[0])
            self.assertNotIn(f"Warning: {key}", self.explain(keys, number))

    def test_not_said_of_what_is_read(self):
        for number, (key, value, keys) in enumerate(READ):
            self.assertNotIn("it does nothing",
                             self.explain({**keys, key: value}, number), key)

    def test_all_of_an_effect_in_one_line(self):
        said = self.explain({**GROWS, "Growth/Rate/Rate": 0.3,
                             "Growth/Rate/Homeostasis": 0.1,
                             "Cell types/a/Growth/Rate/Rate": 2}, "all")
        self.assertIn("Growth/Law = isotropic; so do "
                      "Cell types/a/Growth/Rate/Rate, Growth/Rate/Homeostasis.",
                      said)

    def test_founders_that_no_type_wants(self):
        """The first type is that of all others, whatever its Where says."""
        keys = {**TYPES, "Cell types/b/Where": "X > 20"}
        word = "they are of this type all the same"
        said = self.explain({**keys, "Cell types/a/Where": "X < -20"}, "left")
        self.assertIn("it does not hold at 40 founders", said)
        self.assertIn(word, said)
        for where in ("X <= 20", "1"):
            self.assertNotIn(word, self.explain(
                {**keys, "Cell types/a/Where": where}, "all"))


if __name__ == "__main__":
    main()
