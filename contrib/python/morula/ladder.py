# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Which keys take which values: ladders, the points they make, the seeds."""
import itertools
import re
from dataclasses import dataclass

from .refusal import Refused
from .scene import clean_path, normal
from .tables import read_table

FORM = ('at least two values, "Section/Key=value,value,..."; values with commas '
        '"Section/Key=value|value|..."; keys that change together '
        '"Section/Key,Section/Key=value:value,value:value,..."')
MAX_RUNS = 1000


@dataclass(frozen=True)
class Ladder:
    """Keys that change together, and the rungs: a value for each key."""

    keys: tuple
    rungs: tuple
    name: str

    def label(self, rung):
        """A rung in few words: the values that are not the same on all."""
        words = [value for value, column in zip(rung, zip(*self.rungs))
                 if len(set(map(normal, column))) > 1]
        return ":".join(words)


def read_ladder(text, scene, not_varied=(), allowed=""):
    """A --vary option; for the last two see refuse_keys."""
    left, equals, right = text.partition("=")
    name, colon, names_of_keys = left.rpartition(":")
    left = names_of_keys if colon else left
    keys = tuple(clean_path(key) for key in left.split(","))
    if not equals or not all(keys):
        raise Refused("--vary", text, FORM)
    _require_once("--vary", keys, scene)
    words = [w.strip() for w in right.split("|" if "|" in right else ",")]
    rungs = tuple(tuple(v.strip() for v in word.split(":", len(keys) - 1)) for word in words)
    wrong = [word for word, rung in zip(words, rungs) if len(rung) != len(keys) or not all(rung)]
    if len(rungs) < 2 or wrong:
        raise Refused("--vary", text, FORM, f"Not so: '{wrong[0]}'." if wrong
                      else "-s sets a single value.")
    refuse_keys("--vary", keys, not_varied, allowed)
    return Ladder(keys, rungs, name.strip() or " and ".join(keys))


def _require_once(option, keys, scene):
    """Refuses keys that the scene has not, or that are given twice."""
    for key in keys:
        scene.require_key(key, option)
    if len(set(keys)) < len(keys):
        raise Refused(option, ", ".join(keys), "each key once")


def refuse_keys(option, keys, not_varied, allowed):
    """Refuses keys that must not be varied ({key: why}), and those of output."""
    for key in keys:
        if key in not_varied or key.startswith("Output/"):
            raise Refused(option, key, allowed, not_varied.get(key, "-s sets it for all runs."))


def read_seeds(text):
    """'1..8' or '1-8', '1,2,5' or both together; None without the option."""
    if text is None:
        return None
    seeds = []
    for word in text.split(","):
        match = re.fullmatch(r"\s*(\d+)\s*(?:(?:\.\.|-)\s*(\d+)\s*)?", word)
        if not match:
            raise Refused("--seeds", text, "a range '1..8' or '1-8' or a list '1,2,5' "
                          "of integers >= 0")
        first, last = int(match[1]), int(match[2] or match[1])
        if not first <= last < first + MAX_RUNS:
            raise Refused("--seeds", text, f"a range from low to high of at most {MAX_RUNS} seeds")
        seeds += range(first, last + 1)
    if len(set(seeds)) < len(seeds):
        raise Refused("--seeds", text, "each seed once")
    return seeds


def check_seeds(plan, seeds, text, n_samples=None):
    """Refuses too many runs, and seeds that change nothing; `text` is the
    option as written, `n_samples` the runs of a point if not one a seed."""
    n_runs = len(plan.points) * (n_samples or len(seeds or [1]))
    if n_runs > MAX_RUNS:
        raise Refused("--vary", f"{n_runs} runs", f"at most {MAX_RUNS} runs")
    if seeds and len(seeds) > 1 and not plan.random:
        raise Refused("--seeds", text, "one seed for a scene in which nothing "
                      "is random", "Its Proliferation/Law is none.")


def check_method(plan):
    """Refuses Method beside a key that it stands for: a value that is not
    varied would be the scene's own for one and the method's for the other."""
    both = [key.path for key in plan.scene.known if key.paper is not None and key.path in plan.keys]
    if "Method" in plan.keys and both:
        raise Refused("--vary", f"Method and {both[0]}", "one of them",
                      "Method sets that key: vary Method alone, or the "
                      "keys that it sets.")


class Plan:
    """All points to run, and the lines of points along single ladders.

    A point is one value for every key that any ladder varies. 'Star': each ladder is varied alone,
    the other keys keep the scene's own values, and the scene's own point belongs to every line.
    'Grid': every combination."""

    def __init__(self, scene, ladders, full_grid=False):
        self.scene, self.ladders, self.full_grid = scene, ladders, full_grid
        self.keys = list(dict.fromkeys(k for lad in ladders for k in lad.keys))
        if full_grid and len(self.keys) < sum(len(x.keys) for x in ladders):
            raise Refused("--grid", " ".join(self.keys), "each key in one ladder only")
        self.own = tuple(scene[key] for key in self.keys)
        self._exact = {}
        if full_grid:
            rungs = itertools.product(*(ladder.rungs for ladder in ladders))
            points = [self._point(*zip(ladders, choice)) for choice in rungs]
        else:
            points = [self._point()] + [self._point((ladder, rung)) for ladder in ladders for rung
                                        in ladder.rungs]
        self.points = list(dict.fromkeys(points))

    def _point(self, *choices):
        """The scene's own point with some ladders on some rungs. Equal points
        are one object, however their values are written."""
        values = dict(zip(self.keys, self.own))
        for ladder, rung in choices:
            values.update(zip(ladder.keys, rung))
        point = tuple(values.values())
        return self._exact.setdefault(tuple(map(normal, point)), point)

    def known(self, point):
        """The point of the plan that equals this one, or None."""
        return self._exact.get(tuple(map(normal, point)))

    def value(self, point, key):
        return point[self.keys.index(key)]

    def values(self, key):
        """All values of a key, varied or not."""
        if key not in self.keys:
            return {self.scene[key]}
        return {self.value(point, key) for point in self.points}

    @property
    def random(self):
        """Whether the seed matters to any point."""
        return self.values("Proliferation/Law") != {"none"}

    def line(self, ladder, center):
        """The points along a ladder in its order, all other keys as at the
        center; in a star the center joins where it is not on a rung."""
        points = []
        for rung in ladder.rungs:
            values = dict(zip(self.keys, center))
            values.update(zip(ladder.keys, rung))
            exact = self.known(tuple(values.values()))
            if exact is not None:
                points.append(exact)
        return points if center in points else [*points, center]

    def path(self, ladder, center):
        """The line without a center that is not on it: keys that change
        together need not meet the center at all."""
        line = self.line(ladder, center)
        own = [normal(self.value(center, key)) for key in ladder.keys]
        there = [list(map(normal, rung)) for rung in ladder.rungs]
        if len(ladder.keys) == 1 or own in there:
            return line
        return [point for point in line if point != center]

    def rung_label(self, ladder, point):
        return ladder.label([self.value(point, key) for key in ladder.keys])

    def overrides(self, point):
        """(key, value) where the point differs from the scene."""
        return tuple((key, value) for key, value, own in zip(self.keys, point, self.own)
                     if normal(value) != normal(own))

    def label(self, point):
        """What is special about a point."""
        return ", ".join(f"{key} = {value}" for key, value
                         in self.overrides(point)) or "the scene itself"


class SamplesPlan(Plan):
    """Points that a table gives, one a row, instead of ladders."""

    def __init__(self, scene, keys, points):
        super().__init__(scene, [], full_grid=True)
        self.keys = list(keys)
        self.own = tuple(scene[key] for key in keys)
        self._exact = {}
        self.points = list(dict.fromkeys(
            self._exact.setdefault(tuple(map(normal, point)), point) for point in points))


def read_samples(file, scene):
    """--samples: the keys, and a tuple of values a row."""
    table = read_table("--samples", file)
    keys = tuple(map(clean_path, table))
    if (table == "").any(axis=None):
        raise Refused("--samples", file, f"{len(keys)} values in each line")
    _require_once("--samples", keys, scene)
    points = list(table.itertuples(index=False, name=None))
    return keys, points
