# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright (C) 2026 by the Morula authors
"""Pictures of a run: reading its points, colours, shaded spheres and surfaces.

Everything is drawn by VTK on a virtual screen, so that it needs neither a display nor a graphics
card. Lengths are in µm."""
