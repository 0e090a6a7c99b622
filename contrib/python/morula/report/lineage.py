# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Clones: their sizes, and the whole lineage for the tree in the page."""
import numpy as np
from morula.refusal import Refused

from .curves import RC, SERIES, label_plainly, plt, svg
from .markup import definitions, figure, joined, number
from .packing import block, packed


def summary(run):
    lineage, sizes = run.lineage, run.lineage.clone_sizes
    largest = int(sizes.argmax())
    return definitions([
        ("founders", number(lineage.founders), "founders"),
        ("cells that ever lived", number(len(lineage)), "ever-lived"),
        ("divisions", number((len(lineage) - lineage.founders) // 2),
         "divisions"),
        ("cells living at the end", number(len(lineage.living)), "living"),
        *died(lineage),
        ("founders that never divided", number((sizes == 1).sum()),
         "undivided"),
        ("mean cells of a clone", number(sizes.mean()), "mean-clone"),
        ("largest clone", f"{number(sizes[largest])} cells, of founder "
         f"{largest}", "largest-clone"),
        ("latest generation", number(lineage.generation.max()),
         "latest-generation")])


def died(lineage):
    """Only where some did."""
    n = int(np.isfinite(lineage.death_time).sum())
    gone = int((lineage.clone_sizes == 0).sum())
    return [("cells that died", number(n), "died"),
            ("clones that died out", number(gone), "died-out")] if n else []


def histograms(run):
    lineage = run.lineage
    if not len(lineage.living):
        return joined([])
    generations = np.bincount(lineage.generation[lineage.living])
    sizes = np.bincount(lineage.clone_sizes)
    return joined([
        bars(np.arange(len(sizes)), sizes, "Clones by their living cells",
             "living cells of a clone", "clones",
             first=int(np.isinf(lineage.death_time).all())),
        bars(np.arange(len(generations)), generations,
             "Living cells by generation", "generation", "cells")])


def bars(numbers, counts, title, across, up, first=0):
    """Bars of whole numbers, joined into at most forty."""
    numbers, counts = numbers[first:], counts[first:]
    width = max(1, int(np.ceil(len(numbers) / 40)))
    starts = np.arange(0, len(numbers), width)
    heights = np.add.reduceat(counts, starts)
    with plt.rc_context({**RC, "svg.hashsalt": title}):
        canvas, axes = plt.subplots(figsize=(4.6, 2.7), layout="constrained")
        axes.bar(numbers[starts] + 0.5 * (width - 1), heights, 0.85 * width,
                 color=SERIES[0])
        label_plainly(axes)
        if heights.max() > 100 * max(1, heights[heights > 0].min()):
            axes.set_yscale("log")
        axes.grid(False, axis="x")
        axes.xaxis.get_major_locator().set_params(integer=True)
        axes.set_xlabel(across)
        axes.set_ylabel(up)
        picture = svg(canvas, title)
    shown = ", ".join(f"{n}: {c:,}" for n, c in zip(numbers, counts) if c)
    if len(shown) > 400:
        shown = shown[:400].rsplit(",", 1)[0] + ", …"
    return figure(title, picture, f"{shown}.")


def blocks(run):
    """The lineage as mothers and times of the divisions, in their order: the
    daughters of division k have the ids founders + 2k and the next one."""
    lineage = run.lineage
    mothers = lineage.parent[lineage.founders::2]
    times = lineage.birth_time[lineage.founders::2]
    if not (np.array_equal(mothers, lineage.parent[lineage.founders + 1::2])
            and len(lineage) == lineage.founders + 2 * len(mothers)):
        raise ValueError("lineage.csv: daughters do not stand in pairs")
    found = [block("lineage-packed", packed(mothers.astype(np.uint32),
                                            times.astype(np.float32)))]
    if np.isfinite(lineage.death_time).any():
        found.append(deaths_block(run))
    return found if lineage.type is None else [*found, types_block(run)]


def deaths_block(run):
    """Whose deaths, and when; then who was removed, one after the other."""
    deaths, removals = (run.events[
        (run.events["event"] == event)
        & (run.events["id"] < len(run.lineage))]
        for event in ("death", "removal"))
    return block("deaths-packed", packed(
        deaths["id"].to_numpy(np.uint32), deaths["time"].to_numpy(np.float32),
        removals["id"].to_numpy(np.uint32)))


def types_block(run):
    """All changes of type, those of a cell one after the other: whose, when,
    to which type; then the type with which each cell was born."""
    born, names = run.lineage.type, run.type_names
    if len(names) > 256 or not ((0 <= born) & (born < len(names))).all():
        raise Refused("lineage.csv", "its types", "numbers of the at most 256 "
                      "types that parameters.prm names")
    changes = run.events[(run.events["id"] < len(born))
                         & (run.events["event"] == "transition")].sort_values(
                             "id", kind="stable")
    to = changes["to"].map({name: i for i, name in enumerate(names)})
    return block("types-packed", packed(
        changes["id"].to_numpy(np.uint32), changes["time"].to_numpy(
            np.float32), to.to_numpy(np.uint8), born.astype(np.uint8)))


def about(run):
    lineage = run.lineage
    return {"founders": lineage.founders,
            "divisions": (len(lineage) - lineage.founders) // 2,
            "largest": int(lineage.clone_sizes.argmax()),
            "deaths": int(np.isfinite(lineage.death_time).sum()),
            "types": None if lineage.type is None else run.type_names,
            "end": float(run.statistics["time"].iloc[-1])}
