// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/step_failed.h>
#include <morula/effects/contact/contact.h>
#include <morula/effects/contact/contact_in_step.h>
#include <morula/effects/contact/fusion.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/scene_keys.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>

namespace Morula
{
  void
  ContactParameters::check(const SceneKeys &scene, Review &) const
  {
    // Bodies need a surface that could touch, whose patches stay short enough
    // to be seen from the other side, and cells that stay in their body.
    // Without contact the faces of a cut would go on sharing splines.
    if (scene.tissue.has_cuts() && !is_of_all())
      scene.tissue.cuts.refuse(
        "nothing, as " + between.path() + " = " + between.text(),
        "The faces of a cut are apart only with Between = all: "
        "set that, or remove the cuts.");
    if (!is_on())
      return;
    if (scene.tissue.has_no_surface())
      between.refuse("none, as " + scene.tissue.points_surface.path() +
                       " = none",
                     "Bodies touch with their boundary points: set Points "
                     "surface = automatic.");
    if (bodies == "cell type" && !scene.cell_types.is_on())
      bodies.refuse("apart, as Cell types/Names is empty",
                    "Name the types of the cells, or choose apart.");
    if (scene.has_active_tissue() && !scene.tissue.refine_surface)
      scene.tissue.refine_surface.refuse(
        "true, as " + between.path() + " = " + between.text() +
          " and the tissue grows or flows",
        "Patches that grow longer than half a grid spacing let bodies pass "
        "through each other.");
    if (const auto &exchange = scene.keys<RearrangementParameters>();
        exchange.is_on())
      between.refuse("none, as " + exchange.diffusion.path() + " = " +
                       exchange.diffusion.text(),
                     "Cells that exchange places would change their body. Do "
                     "without one of the two.");
    if (fusion_time > 0. && !scene.tissue.refine_surface)
      scene.tissue.refine_surface.refuse("true, as " + fusion_time.path() +
                                           " = " + fusion_time.text(),
                                         "Bodies that fuse get a new surface.");
  }


  template <int dim>
  void
  Contact<dim>::check_bodies(const std::vector<BodyMeasures> &bodies,
                             const SceneKeys                 &scene) const
  {
    // Two sheets on each other that together are thinner than the deepest
    // overlap of a pair would press with their outer faces.
    const double least = ContactPoints<dim>::deepest_pair * scene.grid.spacing;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].cells > 0. && bodies[b].area == 0.)
        keys.between.refuse("none, as body " + std::to_string(b) +
                              " has no boundary points",
                            "Give it a surface of its own in " +
                              scene.tissue.points_surface.path() + ".");
      else if (bodies[b].opening > 0.05 * bodies[b].area)
        keys.between.refuse(
          "none, as the surface of body " + std::to_string(b) + " is open",
          "Boundary points have to go all around a body, also where it touches "
          "another one: give each its own surface, or set " +
            scene.tissue.points_surface.path() + " = automatic.");
      else if (bodies[b].cells > 0. && bodies[b].thickness() < least)
        keys.between.refuse(
          "none, as body " + std::to_string(b) + " is about " +
            as_text(bodies[b].thickness()) +
            " um thick, and contact holds bodies apart from 0.4 grid "
            "spacings on",
          "Choose " + scene.grid.spacing.path() + " below " +
            as_text(2.5 * bodies[b].thickness()) + " um.");
  }


  template <int dim>
  void
  Contact<dim>::review_bodies(const std::vector<BodyMeasures> &bodies,
                              std::vector<std::string>        &warnings) const
  {
    if (!keys.is_of_all() && bodies.size() < 2)
      warnings.push_back(
        "Warning: " + keys.between.path() +
        " = bodies does nothing, as "
        "there is only one body: cells that stand nearer to each other than " +
        as_text(widest_bond) + " of their lengths belong together (" +
        keys.bodies.path() +
        "). Leave a wider gap, or tell bodies apart by the type of their cells.");
  }


  template <int dim>
  std::string
  Contact<dim>::details_of_bodies(const std::vector<BodyMeasures> &bodies,
                                  const double                     h) const
  {
    double thinnest = std::numeric_limits<double>::infinity();
    for (const BodyMeasures &body : bodies)
      thinnest = std::min(thinnest, body.thickness());
    std::ostringstream text;
    text << "boundary points that face each other press from their first "
            "overlap on, "
         << as_text(keys.stiffness) << " E/h: bodies overlap by h/"
         << as_text(keys.stiffness) << " (" << h / keys.stiffness
         << " um) at a pressure of E; ";
    if (keys.friction > 0.)
      text << "friction " << as_text(keys.friction) << " kPa day/um";
    else
      text << "without friction";
    text << "; in a step two of them come nearer by at most " << way(h)
         << " um; the thinnest body is about " << thinnest
         << " um thick (2 V/A), the least is "
         << ContactPoints<dim>::deepest_pair * h << " um; fields "
         << (keys.fields_pass ? "pass from body to body" :
                                "end at each body's surface");
    if (fuses())
      text << "; bodies that touch for " << as_text(keys.fusion_time)
           << " day fuse";
    return text.str();
  }


  namespace
  {
    /** Boundary points that may touch. */
    template <int dim>
    class TouchingPoints : public Encounters<dim>
    {
    public:
      TouchingPoints(const ContactParameters &keys,
                     const Tissue<dim>       &tissue,
                     SplineSpace<dim>        &space,
                     const double             way)
        : keys(keys)
        , tissue(tissue)
        , points(tissue, space, way)
      {}

      bool
      any() const override
      {
        return points.any();
      }

      std::unique_ptr<InteractionInStep<dim>>
      part_of_step(const AttemptAtStep<dim> &attempt) const override
      {
        // κ and ζ/Δt of doc/theory.md (4.8k) follow from the stiffest cell and
        // the length of the attempt.
        const TimerOutput::Scope section(attempt.timer, "contact");
        const double             h = attempt.space.box().spacing();
        return std::make_unique<ContactInStep<dim>>(
          attempt,
          points,
          ContactLaw{keys.stiffness * attempt.typical_stiffness / h,
                     attempt.typical_stiffness,
                     h,
                     keys.friction / (attempt.t_next - attempt.t)});
      }

      void
      check(const DisplacementField<dim> &displacement) const override
      {
        if (has_crossed_from_afar(
              tissue, points, displacement, tissue.grid().box().spacing()))
          throw StepFailed("bodies pass through each other, so that the step "
                           "is too long for their contact");
      }

    private:
      const ContactParameters &keys;
      const Tissue<dim>       &tissue;
      const ContactPoints<dim> points;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<const Encounters<dim>>
  Contact<dim>::encounters(const Tissue<dim> &tissue,
                           SplineSpace<dim>  &space) const
  {
    return std::make_unique<TouchingPoints<dim>>(keys,
                                                 tissue,
                                                 space,
                                                 way(space.box().spacing()));
  }


  template <int dim>
  Fusion
  Contact<dim>::fusion(Tissue<dim> &tissue, const double dt) const
  {
    age_contact(tissue, dt);
    return find_fusion(tissue, keys.fusion_time);
  }


  template class Contact<2>;
  template class Contact<3>;
} // namespace Morula
