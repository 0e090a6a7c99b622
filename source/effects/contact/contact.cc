// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/near_tree.h>
#include <morula/base/step_failed.h>
#include <morula/effects/contact/contact_pairs.h>
#include <morula/effects/scene_keys.h>
#include <morula/particles/fusion.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.templates.h>

#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Section "Contact": bodies that meet. */
    struct ContactParameters : public EffectKeys
    {
      ContactParameters()
      {
        for (AnyKey *const key : list())
          if (key != &between)
            key->needs({between.path()});
        fields_pass.needs({"Fields/Names"});
      }

      Key<std::string> between{
        {this, "Contact/Between"},
        "none",
        "What may touch, press on each other, slide without friction and part "
        "again. none: tissue that comes within a grid spacing or two of other "
        "tissue sticks to it. bodies: different bodies have contact where "
        "their surfaces meet. all: so have folds and arms of one body.",
        {"none|bodies|all"}};

      Key<std::string> bodies{
        {this, "Contact/Bodies"},
        "apart",
        "What is a body. apart: cells that lie together at t = 0; gaps "
        "between bodies are at least as wide as 0.8 cells. cell type: all "
        "cells of a type at t = 0, by Cell types/Names; they may touch from "
        "the start. Daughters belong to their mother's body, and cells that "
        "change their type stay in theirs.",
        {"apart|cell type"}};

      Key<double> stiffness{
        {this, "Contact/Stiffness"},
        100.,
        "Pressure of two bodies that overlap, by the depth; > 0. They "
        "overlap by the pressure over this. Units: E/h.",
        {},
        positive("E/h",
                 "100 is a good choice: less lets bodies overlap, far more "
                 "takes more iterations.")};

      Key<double> friction{
        {this, "Contact/Friction"},
        0.,
        "Viscous friction of surfaces that touch: stress along the surface "
        "over the velocity at which they slide; >= 0. Units: kPa day/um.",
        {},
        {[](const double zeta) { return zeta >= 0.; },
         "a number >= 0, in kPa day/um",
         "0 is no friction."}};

      Key<double> fusion_time{
        {this, "Contact/Fusion time"},
        0.,
        "Time of touch after which two bodies become one, and with "
        "Between = all two strands of a body: they get splines and a "
        "surface in common and never part again; 0: they do not fuse. "
        "Needs Refine surface. Units: day.",
        {},
        not_negative("day", "0 lets bodies stay apart.")};

      Key<bool> fields_pass{
        {this, "Contact/Fields pass"},
        true,
        "Whether fields pass from body to body where these touch, or "
        "are within a grid spacing of it; faces that touch are no surface "
        "for them then. With false they end at each body's own surface."};

      /** Whether bodies have contact with each other. */
      bool
      is_on() const override
      {
        return between != "none";
      }

      /** Whether a body can touch itself, too. */
      bool
      is_of_all() const
      {
        return between == "all";
      }

      /** Bodies touch by their surfaces. */
      EffectFacts
      facts() const override
      {
        EffectFacts facts;
        facts.needs_surface = true;
        return facts;
      }

      void
      check(const SceneKeys &scene, Review &) const override
      {
        // Bodies need a surface that could touch, whose patches stay short
        // enough to be seen from the other side, and cells that stay in their
        // body. Without contact the faces of a cut would go on sharing splines.
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
        if (const EffectKeys &exchange =
              find_choice(scene.catalogue.step_effects, "rearrangement")
                ->keys();
            exchange.is_on())
          between.refuse(
            "none, as " + exchange.facts().switch_key->path() + " = " +
              exchange.facts().switch_key->text(),
            "Cells that exchange places would change their body. Do "
            "without one of the two.");
        if (fusion_time > 0. && !scene.tissue.refine_surface)
          scene.tissue.refine_surface.refuse(
            "true, as " + fusion_time.path() + " = " + fusion_time.text(),
            "Bodies that fuse get a new surface.");
      }
    };


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
        const double             h  = attempt.space.box().spacing();
        const double             dt = attempt.t_next - attempt.t;
        if (keys.friction > 0. && !(dt > 0.))
          throw StepFailed("friction takes time");
        return contact_in_step(
          attempt,
          points,
          ContactLaw{keys.stiffness * attempt.typical_stiffness / h,
                     attempt.typical_stiffness,
                     h,
                     keys.friction > 0. ? keys.friction / dt : 0.},
          keeps_drag);
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
      mutable bool             keeps_drag = false;
    };


    /** Points that are deeper in each other than this, in units of h, are those
     *  of a sheet's two faces. */
    constexpr double behind_another = 0.1;

    /** Bodies in couples of this rank, the lower number first. */
    using Couples = std::vector<std::pair<unsigned int, unsigned int>>;

    /** What each body becomes part of, by the couples of all ranks.
     *  Collective. */
    std::map<unsigned int, unsigned int>
    joined(Couples couples, const MPI_Comm comm)
    {
      // All ranks learn all couples and join them alike: the lower number wins,
      // and couples are followed to their end, as three may meet at once.
      std::sort(couples.begin(), couples.end());
      couples.erase(std::unique(couples.begin(), couples.end()), couples.end());
      std::map<unsigned int, unsigned int> into;
      const auto                           root = [&](unsigned int body) {
        while (into.count(body) > 0)
          body = into.at(body);
        return body;
      };
      for (const Couples &list : Utilities::MPI::all_gather(comm, couples))
        for (const auto &[one, other] : list)
          {
            const unsigned int a = root(one), b = root(other);
            if (a != b)
              into[std::max(a, b)] = std::min(a, b);
          }
      for (auto &[body, target] : into)
        target = root(target);
      return into;
    }


    /** Adds @p dt (day) to the time for which boundary points have been touched
     *  without a break; those that nothing touches begin anew. */
    template <int dim>
    void
    age_contact(Tissue<dim> &tissue, const double dt)
    {
      const auto &columns = tissue.boundary_points().columns();
      for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
        {
          const BoundaryView<dim, double> point = tissue.boundary_point(p);
          point.set(columns.contact_age,
                    point.get(columns.contact_pressure) > 0. ?
                      point.get(columns.contact_age) + dt :
                      0.);
        }
    }


    /**
     * What is to fuse: boundary points that have been touched for @p time
     * (day), and face such points. Of bodies that fuse all go into the one with
     * the lowest number. Collective.
     */
    template <int dim>
    Fusion
    find_fusion(const Tissue<dim> &tissue, const double time)
    {
      // Points that have been touched long enough look for such points in front
      // of them within half a grid spacing, also on other ranks.
      const BoundaryPoints<dim> &store = tissue.boundary_points();
      std::vector<Point<dim>>    queries;
      std::vector<unsigned int>  old;
      for (unsigned int p = 0; p < store.size(); ++p)
        if (store[p].get(store.columns().contact_age) >= time)
          {
            old.push_back(p);
            queries.push_back(store.position(p));
          }
      const auto numbers = [&](const unsigned int   p,
                               std::vector<double> &list) {
        list.push_back(store.body(p));
        list.push_back(store[p].get(store.columns().contact_age));
        append_flat(list, store.area_vector(p));
      };
      const PointList<dim> near = near_points(
        queries, store, {2 + dim, numbers, Ties::lowest_id}, tissue.grid(), 1);
      const NearTree<dim> tree(near.positions);
      const double        h = tissue.grid().box().spacing();
      Fusion              fusion;
      Couples             couples;
      for (std::size_t k = 0; k < old.size(); ++k)
        {
          const unsigned int   body = store.body(old[k]);
          const Tensor<1, dim> area = store.area_vector(old[k]);
          bool                 met  = false;
          for (const unsigned int i : tree.within(queries[k], 0.5 * h))
            {
              const double *const row   = near.row(i).data();
              const auto          other = static_cast<unsigned int>(row[0]);
              const auto          there = Flat<Tensor<1, dim>>::read(row + 2);
              // The two faces of a sheet are behind each other.
              const double gap =
                0.5 * ((there / there.norm() - area / area.norm()) *
                       (queries[k] - near.positions[i]));
              if (row[1] < time || area * there >= 0. ||
                  gap < -behind_another * h)
                continue;
              met = true;
              if (other > body)
                couples.emplace_back(body, other);
            }
          if (met)
            fusion.points.push_back(old[k]);
        }
      fusion.into = joined(couples, tissue.communicator());
      return fusion;
    }


    /** Bodies, or folds of a body, that touch, press on each other, slide and
     *  part again, or fuse in time: doc/theory.md, section 4.3a. */
    template <int dim>
    class Contact : public Interaction<dim>
    {
    public:
      using Parameters = ContactParameters;

      explicit Contact(const ContactParameters &keys)
        : keys(keys)
      {}

      bool
      takes_types_as_bodies() const override
      {
        return keys.bodies == "cell type";
      }

      bool
      acts_within_bodies() const override
      {
        return keys.is_of_all();
      }

      bool
      lets_equations_pass() const override
      {
        return keys.fields_pass;
      }

      void
      check_bodies(const std::vector<BodyMeasures> &bodies,
                   const SceneKeys                 &scene) const override
      {
        // Two sheets on each other that together are thinner than the deepest
        // overlap of a pair would press with their outer faces.
        const double least =
          ContactPoints<dim>::deepest_pair * scene.grid.spacing;
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
                " um thick, and contact needs bodies of at least 0.4 grid "
                "spacings",
              "Choose " + scene.grid.spacing.path() + " below " +
                as_text(2.5 * bodies[b].thickness()) + " um.");
      }

      void
      review_bodies(const std::vector<BodyMeasures> &bodies,
                    std::vector<std::string>        &warnings) const override
      {
        if (!keys.is_of_all() && bodies.size() < 2)
          warnings.push_back(
            "Warning: " + keys.between.path() +
            " = bodies does nothing, as there is only one body: cells closer "
            "to each other than " +
            as_text(widest_bond) + " of their lengths belong together (" +
            keys.bodies.path() +
            "). Leave a wider gap, or define bodies by the type of their cells.");
      }

      std::string
      details_of_bodies(const std::vector<BodyMeasures> &bodies,
                        const double                     h) const override
      {
        double thinnest = std::numeric_limits<double>::infinity();
        for (const BodyMeasures &body : bodies)
          thinnest = std::min(thinnest, body.thickness());
        std::ostringstream text;
        text << "bodies overlap by " << h / keys.stiffness
             << " um at a pressure of E (stiffness " << as_text(keys.stiffness)
             << " E/h); ";
        if (keys.friction > 0.)
          text << "friction " << as_text(keys.friction) << " kPa day/um";
        else
          text << "without friction";
        text << "; surfaces approach by at most " << way(h)
             << " um in a step; the thinnest body is about " << thinnest
             << " um thick, at least " << ContactPoints<dim>::deepest_pair * h
             << " um are needed; fields "
             << (keys.fields_pass ? "pass from body to body" :
                                    "end at each body's surface");
        if (fuses())
          text << "; bodies that touch for " << as_text(keys.fusion_time)
               << " day fuse";
        return text.str();
      }

      std::unique_ptr<const Encounters<dim>>
      encounters(const Tissue<dim> &tissue,
                 SplineSpace<dim>  &space) const override
      {
        return std::make_unique<TouchingPoints<dim>>(
          keys, tissue, space, way(space.box().spacing()));
      }

      bool
      fuses() const override
      {
        return keys.fusion_time > 0.;
      }

      Fusion
      fusion(Tissue<dim> &tissue, const double dt) const override
      {
        age_contact(tissue, dt);
        return find_fusion(tissue, keys.fusion_time);
      }

    private:
      /** How far two points come nearer to each other in a step at most, µm: a
       *  fold that snaps shut moves farther, however short the step is. */
      double
      way(const double h) const
      {
        return keys.is_of_all() ? 2. * h : h;
      }

      const ContactParameters keys;
    };
  } // namespace


  void
  add_contact(Catalogue &catalogue)
  {
    catalogue.add_own<Contact>(
      "contact",
      {"Growth/Law=isotropic",
       "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)",
       "Contact/Between=all",
       "Tissue/Refine surface=true"});
  }
} // namespace Morula
