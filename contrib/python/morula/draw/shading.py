# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Shaded pictures of surfaces and polyhedra, by VTK."""
import numpy as np
from morula.shapes.grid import lists_of_points
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import (vtkActor, vtkLight, vtkPolyDataMapper, vtkRenderer,
                                         vtkRenderWindow, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingOpenGL2 import (vtkOpaquePass, vtkRenderStepsPass, vtkSSAOPass)

# Direction (right, up, to the viewer) and strength.
LIGHTS = (((-0.6, 1.0, 1.2), 1.0), ((1.2, 0.2, 0.8), 0.35), ((0.0, -1.0, 0.6), 0.2))


def poly_data(positions, colours=None):
    """Points, with a colour (bytes) each if there are some."""
    points = vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(positions), deep=True))
    data = vtkPolyData()
    data.SetPoints(points)
    if colours is not None:
        colour = numpy_to_vtk(np.ascontiguousarray(colours), deep=True)
        colour.SetName("colour")
        data.GetPointData().SetScalars(colour)
    return data


def cell_array(corners):
    """VTK's list of the cells (n, k) of k points each."""
    n, k = corners.shape
    return lists_of_points(k * np.arange(n + 1), corners.ravel())


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


def surface_actor(positions, triangles, colours):
    """A triangulated surface, shaded smoothly."""
    data = poly_data(positions, colours)
    data.SetPolys(cell_array(triangles))
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SplittingOff()
    normals.ConsistencyOff()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    return shaded_actor(mapper)


def add_lights(renderer):
    renderer.RemoveAllLights()
    renderer.AutomaticLightCreationOff()
    for position, intensity in LIGHTS:
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
    # VTK's own range would cut off spheres, which it takes for points.
    distance = np.linalg.norm(view.direction)
    camera.SetClippingRange(0.01 * distance, 2 * distance)


def add_occlusion(renderer, radius):
    """Ambient occlusion: gaps narrower than the radius (µm) become dark."""
    steps = vtkRenderStepsPass()
    occlusion = vtkSSAOPass()
    occlusion.SetRadius(radius)
    occlusion.SetBias(0.02 * radius)
    occlusion.SetKernelSize(32)
    occlusion.BlurOn()
    occlusion.SetDelegatePass(vtkOpaquePass())
    steps.SetOpaquePass(occlusion)
    renderer.SetPass(steps)


def drawn(actors, view, pixels, occlusion_radius=0.0):
    """The picture (height, width, 3), bytes, as it is on the screen."""
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
    window.SetSize(*pixels)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
    return image.reshape(pixels[1], pixels[0], -1)[::-1, :, :3]


def unlit(actor):
    """An actor in its plain colours."""
    look = actor.GetProperty()
    look.LightingOff()
    look.SetAmbient(0)
    look.SetDiffuse(1)
    return actor


def render(actors, view, pixels, occlusion_radius=0.0):
    """The picture (height, width, 3) of colours from 0 to 1."""
    fine = drawn(actors, view, [2 * n for n in pixels])
    # Two by two to one: smooth edges.
    image = fine.reshape(pixels[1], 2, pixels[0], 2, 3).mean(axis=(1, 3)) / 255
    if occlusion_radius > 0:  # by how much it darkens white: smooth enough without
        for actor in actors:
            actor.GetMapper().ScalarVisibilityOff()
            unlit(actor).GetProperty().SetColor(1, 1, 1)
        image *= drawn(actors, view, pixels, occlusion_radius) / 255
    return image
