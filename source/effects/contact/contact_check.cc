// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/contact/contact_parameters.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/rest_of_scene.h>

#include <sstream>

namespace Morula
{
  void
  ContactParameters::check_with(const RestOfScene &scene) const
  {
    // Bodies need a surface that could touch, whose patches stay short enough
    // to be seen from the other side, and cells that stay in their body.
    // Without contact the faces of a cut would go on sharing splines.
    if (!scene.cuts.value().empty() && !is_of_all())
      scene.cuts.refuse("nothing, as " + between.path() + " = " +
                          between.text(),
                        "The faces of a cut are apart only with Between = all: "
                        "set that, or remove the cuts.");
    if (!is_on())
      return;
    if (scene.no_surface != nullptr)
      between.refuse("none, as " + scene.no_surface->path() + " = none",
                     "Bodies touch with their boundary points: set Points "
                     "surface = automatic.");
    if (bodies == "cell type" && scene.types.empty())
      bodies.refuse("apart, as Cell types/Names is empty",
                    "Name the types of the cells, or choose apart.");
    if (scene.is_active && !scene.refine_surface)
      scene.refine_surface.refuse(
        "true, as " + between.path() + " = " + between.text() +
          " and the tissue grows or flows",
        "Patches that grow longer than half a grid spacing let bodies pass "
        "through each other.");
    if (const auto &exchange = scene.catalogue.keys<RearrangementParameters>();
        exchange.is_on())
      between.refuse("none, as " + exchange.diffusion.path() + " = " +
                       exchange.diffusion.text(),
                     "Cells that exchange places would change their body. Do "
                     "without one of the two.");
    if (fusion_time > 0. && !scene.refine_surface)
      scene.refine_surface.refuse("true, as " + fusion_time.path() + " = " +
                                    fusion_time.text(),
                                  "Bodies that fuse get a new surface.");
  }


  std::string
  ContactParameters::details_of_bodies(const double h,
                                       const double thinnest) const
  {
    std::ostringstream text;
    text << "boundary points that face each other press from their first "
            "overlap on, "
         << as_text(stiffness) << " E/h: bodies overlap by h/"
         << as_text(stiffness) << " (" << h / stiffness
         << " um) at a pressure of E; without friction; in a step two of them "
            "come nearer by at most "
         << (is_of_all() ? 2. * h : h) << " um; the thinnest body is about "
         << thinnest << " um thick (2 V/A), the least is " << 0.4 * h
         << " um; fields "
         << (fields_pass ? "pass from body to body" :
                           "end at each body's surface");
    return text.str();
  }
} // namespace Morula
