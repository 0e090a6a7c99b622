# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Shaded pictures: what is in them, who looks at it, and the pixels."""
from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLight,
                                         vtkPolyDataMapper, vtkRenderer,
                                         vtkRenderWindow,
                                         vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import (vtkOpaquePass,
                                            vtkOpenGLSphereMapper,
                                            vtkRenderStepsPass, vtkSSAOPass)


@dataclass(frozen=True)
class View:
    """A parallel camera; lengths in µm, unit vectors of the picture's axes."""

    center: np.ndarray
    direction: np.ndarray  # to the viewer, longer than the tissue
    up: np.ndarray
    right: np.ndarray
    half_width: float
    half_height: float

    def pixels(self, width):
        """(width, height) of a picture of even height that it fills."""
        return width, 2 * round(width / 2 * self.half_height /
                                self.half_width)


def view_of(positions, radius=0.0, azimuth=-60.0, elevation=14.0, flat=False):
    """The view, from these angles in degrees, that holds all the positions
    with so much (µm) around each; flat tissue is seen from above."""
    azimuth, elevation = np.radians([azimuth, elevation])
    if flat:
        direction, up = np.array([0., 0, 1]), np.array([0., 1, 0])
    else:
        direction = np.array([np.cos(elevation) * np.cos(azimuth),
                              np.cos(elevation) * np.sin(azimuth),
                              np.sin(elevation)])
        up = np.array([0., 0, 1])
    right = np.cross(up, direction)
    right /= np.linalg.norm(right)
    over = np.cross(direction, right)
    across, along = positions @ right, positions @ over
    margin = 1.06
    half_width = margin * (np.ptp(across) / 2 + radius)
    half_height = margin * (np.ptp(along) / 2 + radius)
    low, high = positions.min(axis=0), positions.max(axis=0)
    center = (low + high) / 2
    center += right * ((across.min() + across.max()) / 2 - center @ right)
    center += over * ((along.min() + along.max()) / 2 - center @ over)
    distance = 2 * np.linalg.norm(high - low) + 1
    return View(center, distance * direction, up, right, half_width,
                half_height)


def cut_plane(positions, azimuth=-60.0, turn=30.0):
    """A point (µm) and the unit normal of the vertical plane through the
    tissue's middle that faces a viewer at this azimuth, but for a turn to the
    side (degrees)."""
    angle = np.radians(azimuth + turn)
    normal = np.array([np.cos(angle), np.sin(angle), 0])
    depth = positions @ normal
    return normal * (depth.min() + depth.max()) / 2, normal


def behind_cut(positions, azimuth=-60.0, turn=30.0):
    """Which points stay when the tissue is cut open by this plane."""
    origin, normal = cut_plane(positions, azimuth, turn)
    return positions @ normal <= origin @ normal


def poly_data(positions, colours):
    """Points with a colour (bytes) each."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    colour = numpy_to_vtk(np.ascontiguousarray(colours), deep=True)
    colour.SetName("colour")
    data.GetPointData().SetScalars(colour)
    return data


def cell_array(corners):
    """VTK's list of the cells (n, k) of k points each."""
    cells = vtkCellArray()
    n, k = corners.shape
    cells.SetData(
        numpy_to_vtk(k * np.arange(n + 1, dtype=np.int64), deep=True),
        numpy_to_vtk(corners.astype(np.int64).ravel(), deep=True))
    return cells


def shaded_actor(mapper):
    mapper.SetScalarModeToUsePointData()
    mapper.SetColorModeToDirectScalars()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetAmbient(0.3)
    look.SetDiffuse(0.85)
    look.SetSpecular(0.08)
    look.SetSpecularPower(20)
    return actor


def sphere_actor(positions, radii, colours):
    """Spheres, drawn as ray-traced dots: exact, and cheap in number."""
    data = poly_data(positions, colours)
    data.SetVerts(cell_array(np.arange(len(radii))[:, None]))
    # The mapper reads the radii as single precision, whatever they are.
    radius = numpy_to_vtk(radii.astype(np.float32), deep=True)
    radius.SetName("radius")
    data.GetPointData().AddArray(radius)
    mapper = vtkOpenGLSphereMapper()
    mapper.SetInputData(data)
    mapper.SetScaleArray("radius")
    return shaded_actor(mapper)


def surface_actor(positions, triangles, colours, crease=180.0):
    """A triangulated surface, shaded smoothly but for edges at which it turns
    by more than `crease` degrees."""
    data = poly_data(positions, colours)
    data.SetPolys(cell_array(triangles))
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetSplitting(crease < 180)
    normals.SetFeatureAngle(crease)
    normals.ConsistencyOff()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    return shaded_actor(mapper)


def add_lights(renderer):
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    for position, intensity in (((-0.6, 1.0, 1.2), 1.0),
                                ((1.2, 0.2, 0.8), 0.35),
                                ((0.0, -1.0, 0.6), 0.2)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*position)
        light.SetIntensity(intensity)
        renderer.AddLight(light)


def aim_camera(renderer, view):
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*view.center)
    camera.SetPosition(*(view.center + view.direction))
    camera.SetViewUp(*view.up)
    camera.SetParallelScale(view.half_height)
    renderer.ResetCameraClippingRange()


def add_occlusion(renderer, radius):
    """Ambient occlusion: gaps narrower than the radius (µm) become dark."""
    steps = vtkRenderStepsPass()
    occlusion = vtkSSAOPass()
    occlusion.SetRadius(radius)
    occlusion.SetBias(0.02 * radius)
    occlusion.SetKernelSize(96)
    occlusion.BlurOn()
    occlusion.SetDelegatePass(vtkOpaquePass())
    steps.SetOpaquePass(occlusion)
    renderer.SetPass(steps)


def render(actors, view, pixels, occlusion_radius=0.0):
    """The picture (height, width, 3) of colours from 0 to 1."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for actor in actors:
        renderer.AddActor(actor)
    add_lights(renderer)
    aim_camera(renderer, view)
    if occlusion_radius > 0:
        add_occlusion(renderer, occlusion_radius)

    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(*(2 * n for n in pixels))
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
    image = image.reshape(2 * pixels[1], 2 * pixels[0], -1)[::-1, :, :3]
    # Two by two to one: smooth edges.
    return image.reshape(pixels[1], 2, pixels[0], 2, 3).mean(axis=(1, 3)) / 255
