# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Layouts of cells that fit a disc or a ball, for tissues read from a file.

A regular lattice leaves a staircase at a curved surface; these cells fill the
body exactly, each the patch of a shell, with the patch's volume.
"""
import numpy


def disc(radius, spacing):
    """Rings of equal width about the spacing, divided evenly (µm)."""
    n_rings = round(radius / spacing)
    X, volumes = [], []
    for k in range(n_rings):
        inner, outer = numpy.array([k, k + 1]) * radius / n_rings
        n = round(2 * numpy.pi * (k + 0.5))
        angle = 2 * numpy.pi * (numpy.arange(n) + 0.5 * (k % 2)) / n
        centroid = 2 / 3 * (outer**3 - inner**3) / (outer**2 - inner**2)
        X.append(centroid * numpy.column_stack([numpy.cos(angle),
                                                numpy.sin(angle)]))
        volumes.append(numpy.full(n, numpy.pi * (outer**2 - inner**2) / n))
    return numpy.concatenate(X), numpy.concatenate(volumes)


def shell(n_zones):
    """Directions and parts of the sphere: zones of equal height in latitude,
    divided evenly."""
    edges = numpy.linspace(0, numpy.pi, n_zones + 1)
    directions, parts = [], []
    for j, (begin, end) in enumerate(zip(edges[:-1], edges[1:])):
        middle = 0.5 * (begin + end)
        n = max(3, round(2 * n_zones * numpy.sin(middle)))
        angle = 2 * numpy.pi * (numpy.arange(n) + 0.5 * (j % 2)) / n
        directions.append(numpy.column_stack(
            [numpy.sin(middle) * numpy.cos(angle),
             numpy.sin(middle) * numpy.sin(angle),
             numpy.full(n, numpy.cos(middle))]))
        parts.append(numpy.full(
            n, (numpy.cos(begin) - numpy.cos(end)) / (2 * n)))
    return numpy.concatenate(directions), numpy.concatenate(parts)


def ball(radius, spacing):
    """Shells of equal thickness about the spacing, divided by shell() (µm)."""
    n_shells = round(radius / spacing)
    X, volumes = [], []
    for k in range(n_shells):
        inner, outer = numpy.array([k, k + 1]) * radius / n_shells
        directions, parts = shell(max(2, round(numpy.pi * (k + 0.5))))
        centroid = 3 / 4 * (outer**4 - inner**4) / (outer**3 - inner**3)
        X.append(centroid * directions)
        volumes.append(4 / 3 * numpy.pi * (outer**3 - inner**3) * parts)
    return numpy.concatenate(X), numpy.concatenate(volumes)
