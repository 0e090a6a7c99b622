# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Cells as polyhedra with flat faces and dark edges."""
import numpy as np
from morula.shapes.cutting import cut
from morula.shapes.grid import lists_of_points
from morula.shapes.polyhedra import SURFACE, joined
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from .shading import cell_array, poly_data, shaded_actor

EDGE = (0.13, 0.13, 0.16)
SMOOTH = 0.8  # least cosine across an edge of the surface that is not drawn


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
    there = np.zeros(max(bodies.owner.max(), bodies.beyond.max()) + 1,
                     dtype=bool)
    there[bodies.owner] = True
    return bodies.select((bodies.beyond < 0) | ~there[bodies.beyond])


def unit_normals(faces):
    normals = faces.area_vectors()
    return normals / np.maximum(
        np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def shape_actors(bodies, colours, width):
    """The faces in their cells' colours (bytes), and their edges as lines of
    this width in pixels."""
    faces = visible(bodies)
    places, colour = faces.points[faces.corners], np.repeat(
        colours[faces.owner], faces.counts, axis=0)
    data = poly_data(places, colour)
    data.SetPolys(lists_of_points(faces.starts, np.arange(len(places))))
    normal = numpy_to_vtk(np.repeat(unit_normals(faces), faces.counts, axis=0),
                          deep=True)
    data.GetPointData().SetNormals(normal)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    # Edges lie in the faces: they are drawn as if a little nearer.
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    return [shaded_actor(mapper), edge_actor(faces, width)]


def drawn_edges(faces):
    """Pairs (n, 2) of points: the edges of faces, but for those between faces
    of one cell that make up its part of a smooth surface."""
    face = np.repeat(np.arange(len(faces.owner)), faces.counts)
    ends = np.stack([faces.corners, faces.corners[faces.following()]], axis=1)
    ends.sort(axis=1)
    order = np.lexsort([ends[:, 1], ends[:, 0], faces.owner[face]])
    ends, face = ends[order], face[order]
    same = np.flatnonzero((faces.owner[face[1:]] == faces.owner[face[:-1]])
                          & np.all(ends[1:] == ends[:-1], axis=1))
    one, other = face[same], face[same + 1]
    normals = unit_normals(faces)
    smooth = same[(faces.beyond[one] == SURFACE)
                  & (faces.beyond[other] == SURFACE)
                  & (np.einsum("ij,ij->i", normals[one], normals[other])
                     > SMOOTH)]
    drawn = np.ones(len(ends), dtype=bool)
    drawn[same] = False  # once is enough
    drawn[smooth + 1] = False
    return ends[drawn]


def edge_actor(faces, width):
    used, ends = np.unique(drawn_edges(faces), return_inverse=True)
    data = poly_data(faces.points[used],
                     np.zeros((len(used), 3), dtype=np.uint8))
    data.SetLines(cell_array(ends.reshape(-1, 2)))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*EDGE)
    look.SetLineWidth(width)
    look.LightingOff()
    return actor
