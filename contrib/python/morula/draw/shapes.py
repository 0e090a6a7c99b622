# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells as polyhedra with flat faces and dark edges."""
import numpy as np
from morula.shapes.cutting import cut
from morula.shapes.grid import lists_of_points
from morula.shapes.polyhedra import SURFACE, joined
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from .shading import poly_data, shaded_actor

EDGE = (0.13, 0.13, 0.16)
SMOOTH = 37  # degrees between faces across an edge that is not drawn


def cut_through(bodies, origin, normal):
    """What is behind a plane: whole cells, and those that it goes through cut
    in two, so that the plane shows a section through the tissue."""
    height = (bodies.points - origin) @ normal
    corners = height[bodies.corners]
    owners = bodies.owner.max() + 1
    low, high = np.full(owners, np.inf), np.full(owners, -np.inf)
    owner = np.repeat(bodies.owner, bodies.counts)
    np.minimum.at(low, owner, corners)
    np.maximum.at(high, owner, corners)
    behind, through = high <= 0, (low < 0) & (high > 0)
    halves = cut(bodies.select(through[bodies.owner]),
                 np.tile(origin, (owners, 1)), np.tile(normal, (owners, 1)),
                 np.full(owners, SURFACE))
    return joined([bodies.select(behind[bodies.owner]), halves])


def visible(bodies):
    """The faces that have no other of these cells in front of them."""
    there = np.zeros(max(bodies.owner.max(), bodies.beyond.max()) + 1, dtype=bool)
    there[bodies.owner] = True
    return bodies.select((bodies.beyond < 0) | ~there[bodies.beyond])


def shape_actors(bodies, colours, width):
    """The faces in their cells' colours (bytes), and their edges as lines of
    this width in pixels, but for those of smooth surfaces."""
    faces = visible(bodies)
    number = len(faces.points)
    # Each cell has corners of its own: edges are those of its faces.
    used, corners = np.unique(np.repeat(faces.owner, faces.counts) * number + faces.corners,
                              return_inverse=True)
    data = poly_data(faces.points[used % number], colours[used // number])
    data.SetPolys(lists_of_points(faces.starts, corners))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    # Edges lie in the faces: they are drawn as if a little nearer.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = shaded_actor(mapper)
    actor.GetProperty().SetInterpolationToFlat()
    return [actor, edge_actor(data, width)]


def edge_actor(data, width):
    edges = vtkFeatureEdges()
    edges.SetInputData(data)
    edges.SetFeatureAngle(SMOOTH)
    edges.ColoringOff()
    edges.NonManifoldEdgesOff()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*EDGE)
    look.SetLineWidth(width)
    look.LightingOff()
    return actor
