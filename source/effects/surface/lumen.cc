// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/lumen_keys.h>
#include <morula/effects/surface/lumen_spaces.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** |Σ a n|/Σ a of a surface that counts as closed: on coarse ones the
     *  patches' vectors do not quite add up to nothing. */
    constexpr double largest_gap = 0.02;

    /** Grid spacings across a lumen, below which splines see too little of it:
     *  doc/theory.md, section 4.3. */
    constexpr double narrowest = 3.;

    /** Compression modulus of the content whose pressure is being found, over
     *  Young's modulus of the tissue: doc/theory.md (4.8j). */
    constexpr double relative_modulus = 100.;

    /** An expression of a lumen, which may depend on the time alone.
     *  @throws InputError */
    std::optional<Expression>
    of_time(const ExpressionKey &key, const unsigned int dim)
    {
      std::optional<Expression> expression = key.optional(dim);
      if (expression)
        for (const Variable place : {Variable::X, Variable::Y, Variable::Z})
          if (expression->uses(place))
            key.refuse("a function of t",
                       "A lumen is the same everywhere: remove X, Y and Z.");
      return expression;
    }

    /**
     * Lumens that the tissue encloses: the volume of each is given, or what the
     * wall secretes, and its pressure follows; or it is filled with a gas.
     * doc/theory.md (4.8g) to (4.8j).
     */
    template <int dim>
    class Lumens : public BoundaryCondition<dim>, public Moments<dim>
    {
    public:
      using Parameters = LumensParameters;

      /** @throws InputError for expressions that cannot be parsed or depend on
       *  places, and unless exactly one of a lumen's ways() is given */
      explicit Lumens(const Parameters &parameters)
      {
        const LumenKeys &one = parameters.one;
        for (const ExpressionKey *const key : one.ways())
          if (one.where.empty() && !key->is_default())
            key->refuse("its default, as " + one.where.path() + " is not set",
                        "Set " + one.where.path() + ", or remove this key.");
        for (const LumenKeys *const lumen : parameters.all())
          {
            const LumenKeys &keys = *lumen;
            if (keys.where.empty())
              keys.where.refuse("a condition that chooses the surface of a "
                                "lumen",
                                "Each lumen needs one.");
            const ExpressionKey *given = nullptr;
            for (const ExpressionKey *const key : keys.ways())
              if (!key->empty() && std::exchange(given, key) != nullptr)
                key->refuse("nothing where another one of its kind is set",
                            "Of a lumen whose volume or secretion is given the "
                            "pressure is found: leave one of them empty.");
            if (given == nullptr)
              keys.volume.refuse("a function of t where " + keys.where.path() +
                                   " is set",
                                 "1 keeps the volume; or set " +
                                   keys.pressure.path() + ".");
            list.push_back({keys,
                            keys.where.expression(dim),
                            of_time(keys.volume, dim),
                            of_time(keys.pressure, dim),
                            of_time(keys.secretion, dim)});
          }
      }

      bool
      acts_on(const Point<dim> &X, const Tensor<1, dim> &) const override
      {
        return lumen_at(X) > 0;
      }

      void
      add_columns(BoundaryColumns<dim> &columns) const override
      {
        columns.cavity = columns.template add<unsigned int>(
          {"cavity", "", "number of the cavity that the point faces"});
        columns.template add<unsigned int>({"lumen",
                                            "",
                                            "number of the lumen that the "
                                            "point faces",
                                            0,
                                            AtDivision::copied,
                                            !list.front().keys.name.empty()});
      }

      void
      check_surface(const Preview<dim>        &scene,
                    const std::vector<double> &areas) const override
      {
        for (unsigned int l = 0; l < list.size(); ++l)
          check_lumen(l, scene, areas);
      }

      std::vector<std::unique_ptr<PartOfStep<dim>>>
      parts_of_step(const AttemptAtStep<dim> &attempt) const override
      {
        // All ranks find the volumes together. The contents may need
        // expressions, which can fail on one rank.
        const TimerOutput::Scope section(attempt.timer, "lumen");
        const auto spaces = kept_spaces(attempt.kept, list.size());
        std::vector<std::unique_ptr<PartOfStep<dim>>> parts;
        for (unsigned int s = 0; s < spaces.size(); ++s)
          if (spaces[s].is_filled())
            {
              const auto   patches = lumen_patches(s + 1, attempt.tissue);
              const double area    = sums_of(patches, attempt.comm).area;
              LumenContent content{s + 1,
                                   names_in(spaces[s]),
                                   number_of_space(s, "pressure"),
                                   enclosed_volume(patches, attempt.comm)};
              everywhere(attempt.comm,
                         [&]() { fill(spaces[s], area, attempt, content); });
              parts.push_back(lumen_pressure(attempt, content));
            }
        return parts;
      }

      /** Finds the spaces and measures them. The first pressure of a lumen that
       *  keeps its volume is a guess, 0, from which the turns of the first step
       *  begin. */
      void
      settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
      {
        const auto column = space_column(tissue);
        for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
          {
            const auto point = tissue.boundary_point(p);
            point.set(column, lumen_at(point.seed_position()));
          }
        const SpacesOfSurface found =
          find_spaces(std::vector<bool>(list.size(), true), tissue);
        std::vector<LumenSpace> spaces(list.size());
        for (unsigned int s = 0; s < list.size(); ++s)
          {
            spaces[s].held.assign(list.size(), 0.);
            spaces[s].held[s]  = volume_of(s, tissue);
            spaces[s].together = found.n_cavities[s] > 1;
            if (list[s].pressure)
              spaces[s].pressure = value(list[s].pressure, 0.);
          }
        keep_spaces(spaces, moment.kept);
      }

      /** Lets the spaces follow the cavities of the new surface. */
      void
      surfaced(Tissue<dim>            &tissue,
               const MomentOfRun<dim> &moment) const override
      {
        // What two spaces held is added where they are one cavity now. What one
        // held is shared by volume where it has become several. What an open
        // one held is gone.
        auto              spaces = kept_spaces(moment.kept, list.size());
        std::vector<bool> together;
        for (const LumenSpace &space : spaces)
          together.push_back(space.together);
        if (spaces.empty())
          return; // settle() comes later
        SpacesOfSurface found = find_spaces(together, tissue);
        join_spaces(found, tissue);
        for (unsigned int s = 0; s < together.size(); ++s)
          if (found.into[s] != s + 1 && spaces[s].is_filled())
            {
              say(moment,
                  names_in(spaces[s]) + " has " +
                    (found.into[s] > 0 ?
                       "merged with " + names_in(spaces[found.into[s] - 1]) :
                     found.has_opened[s] ?
                       "opened to the outside, and has no pressure and no "
                       "volume to keep any more" :
                       "closed"));
              for (unsigned int l = 0; l < list.size() && found.into[s] > 0;
                   ++l)
                spaces[found.into[s] - 1].held[l] += spaces[s].held[l];
              spaces[s] = LumenSpace{std::vector<double>(list.size(), 0.)};
            }
        for (const unsigned int space : found.joined)
          spaces[space - 1].together = true;
        for (const unsigned int from : found.split_from)
          {
            const double rest  = volume_of(from - 1, tissue);
            const double part  = volume_of(spaces.size(), tissue);
            const double share = part / (part + rest);
            say(moment, names_in(spaces[from - 1]) + " has split");
            spaces.push_back(spaces[from - 1]);
            for (unsigned int l = 0; l < list.size(); ++l)
              {
                spaces[from - 1].held[l] *= 1. - share;
                spaces.back().held[l] *= share;
              }
          }
        keep_spaces(spaces, moment.kept);
      }

      void
      describe(const Tissue<dim>      &tissue,
               const MomentOfRun<dim> &moment) const override
      {
        // Where several lumens have merged each has its part of the volume. The
        // pressure is that of the space with the largest part of a lumen.
        const auto          spaces = kept_spaces(moment.kept, list.size());
        std::vector<double> volumes(list.size(), 0.), pressures(volumes);
        std::vector<double> largest(volumes);
        for (unsigned int s = 0; s < spaces.size(); ++s)
          if (spaces[s].is_filled())
            {
              const double volume = volume_of(s, tissue);
              const double all    = std::accumulate(spaces[s].held.begin(),
                                                 spaces[s].held.end(),
                                                 0.);
              for (unsigned int l = 0; l < list.size(); ++l)
                {
                  const double part = spaces[s].held[l] / all * volume;
                  volumes[l] += part;
                  if (part >
                      std::exchange(largest[l], std::max(largest[l], part)))
                    pressures[l] = spaces[s].pressure;
                }
            }
        for (unsigned int l = 0; l < list.size(); ++l)
          {
            moment.of_step["lumen_volume" + suffix(l)]   = volumes[l];
            moment.of_step["lumen_pressure" + suffix(l)] = pressures[l];
          }
      }

      /** Volumes and pressures in statistics.csv; what the spaces hold and
       *  their last pressures are kept. */
      void
      declare(Tables<dim> &tables) const override
      {
        for (unsigned int l = 0; l < list.size(); ++l)
          for (const std::string what : {"lumen_volume", "lumen_pressure"})
            tables.add_number(what + suffix(l));
        tables.keep_number(number_of_spaces, 0.);
      }

      void
      check(const Preview<dim> &scene) const override
      {
        // Both ends of the run are tried, so that most mistakes show before it.
        for (const Lumen &lumen : list)
          for (const double t : {0., scene.keys.time.end_time.value()})
            for (const auto *const of_time :
                 {&lumen.volume, &lumen.pressure, &lumen.secretion})
              if (*of_time)
                value(*of_time, t);
        for (const Point<dim> &X : scene.boundary_points)
          for (unsigned int l = lumen_at(X); l > 0 && l < list.size(); ++l)
            if (list[l].where.value(X, 0.) > 0.)
              list[l].keys.where.refuse(
                "a condition that chooses no points of " +
                  list[lumen_at(X) - 1].keys.where.path(),
                "Each boundary point faces one lumen.");
      }

      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        // The width is the smallest extent along an axis, over all ranks.
        for (unsigned int l = 0; l < list.size(); ++l)
          {
            double width = std::numeric_limits<double>::infinity();
            for (unsigned int d = 0; d < dim; ++d)
              {
                double lower = std::numeric_limits<double>::max(),
                       upper = -lower;
                for (const Point<dim> &X : scene.boundary_points)
                  if (lumen_at(X) == l + 1)
                    {
                      lower = std::min(lower, X[d]);
                      upper = std::max(upper, X[d]);
                    }
                width = std::min(width,
                                 Utilities::MPI::max(upper, scene.comm) -
                                   Utilities::MPI::min(lower, scene.comm));
              }
            const double         h     = scene.keys.grid.spacing;
            const ExpressionKey &where = list[l].keys.where;
            if (width < narrowest * h)
              review.warn(
                where.path(),
                where.text(),
                "the lumen is only " + as_text(width) + " um wide, " +
                  as_text(std::round(10. * width / h) / 10.) +
                  " times Grid/Spacing; at 2 times its pressure was 20 % "
                  "wrong (doc/theory.md, section 4.3).",
                "Choose a Grid/Spacing of at most a third of its width.");
          }
      }

    private:
      struct Lumen
      {
        LumenKeys                 keys;
        Expression                where;
        std::optional<Expression> volume, pressure, secretion; // one of them
      };

      /** A value, which depends on the time alone. @throws InputError */
      static double
      value(const std::optional<Expression> &of_time, const double t)
      {
        return of_time->value(Point<dim>(), t);
      }

      /** The number of the lumen around which @p X (µm) was at t = 0, from 1
       *  on; 0: there is none. */
      unsigned int
      lumen_at(const Point<dim> &X) const
      {
        for (unsigned int l = 0; l < list.size(); ++l)
          if (list[l].where.value(X, 0.) > 0.)
            return l + 1;
        return 0;
      }

      /** What names of columns end with. */
      std::string
      suffix(const unsigned int lumen) const
      {
        const std::string &name = list[lumen].keys.name;
        return name.empty() ? "" : "_" + name;
      }

      /** The lumens whose content is in a space, in a row of forces.csv. */
      std::string
      names_in(const LumenSpace &space) const
      {
        std::string text;
        for (unsigned int l = 0; l < list.size(); ++l)
          if (space.held[l] != 0.)
            text += (text.empty() ? "" : " + ") +
                    (list[l].keys.name.empty() ? "lumen" : list[l].keys.name);
        return text;
      }

      /** Volume of a space now, µm^dim. Collective. */
      static double
      volume_of(const unsigned int space, const Tissue<dim> &tissue)
      {
        return enclosed_volume(lumen_patches(space + 1, tissue),
                               tissue.communicator());
      }

      static void
      say(const MomentOfRun<dim> &moment, const std::string &what)
      {
        moment.say("Lumens: at t = " + as_text(moment.t) + " day " + what +
                   ".");
      }

      /** Sets what fills a space before the pressure of the step is known.
       *  @param area of its wall at the beginning, µm^(dim-1)
       *  @throws InputError, StepFailed */
      void
      fill(const LumenSpace         &space,
           const double              area,
           const AttemptAtStep<dim> &attempt,
           LumenContent             &content) const
      {
        // A gas has p = p₀V₀/V, which needs only the product. Fluid is secreted
        // as into a lumen that keeps its shape, doc/theory.md, section 4.3.
        // Where the volume is given the content is that of a compressible
        // fluid, doc/theory.md (4.8j), which begins with the pressure of the
        // step before: a good guess saves turns.
        const double t = attempt.t_next, dt = t - attempt.t;
        double       fluid   = 0.;
        bool         has_gas = false;
        for (unsigned int l = 0; l < list.size(); ++l)
          if (const double held = space.held[l]; held != 0.)
            {
              if (list[l].secretion)
                {
                  const double way =
                    value(list[l].secretion, t - 0.5 * dt) * dt;
                  const double factor =
                    std::max(0., 1. + way * area / (dim * content.volume));
                  const double now = Utilities::fixed_power<dim>(factor) * held;
                  content.at_end[number_of_space(content.space - 1,
                                                 std::to_string(l))] = now;
                  fluid += now;
                }
              else if (list[l].volume)
                fluid += value(list[l].volume, t) * held;
              else
                {
                  has_gas = true;
                  content.content.gas += value(list[l].pressure, t) * held;
                }
            }
        if (has_gas)
          {
            content.content.fluid = fluid;
            return;
          }
        if (!(fluid > 0.))
          throw StepFailed("nothing is left of the lumen " + content.name);
        content.content.target             = fluid;
        content.content.pressure_at_target = space.pressure;
        content.content.stiffness_at_target =
          relative_modulus * attempt.typical_stiffness / content.volume;
      }

      /** Refuses a lumen that has no surface at t = 0, or one that is open, or
       *  whose normals point away. Collective. @throws InputError */
      void
      check_lumen(const unsigned int         l,
                  const Preview<dim>        &scene,
                  const std::vector<double> &areas) const
      {
        std::vector<LumenPatch<dim>> patches;
        for (std::size_t i = 0; i < areas.size(); ++i)
          if (lumen_at(scene.boundary_points[i]) == l + 1)
            patches.push_back(
              {scene.boundary_points[i], areas[i] * scene.normals[i]});
        // A surface that is closed has areas that add up to nothing, as
        // vectors; one whose normals point into the lumen has a positive
        // volume. The sums are over all ranks, so all of them refuse the scene.
        const SurfaceSums<dim> sums  = sums_of(patches, scene.comm);
        const ExpressionKey   &where = list[l].keys.where;
        if (sums.area == 0.)
          where.refuse("a condition that holds at some boundary point",
                       "It is positive at none: correct it, or leave it empty. "
                       "Boundary points sit at centers of surface patches.");
        std::ostringstream text;
        if (const double gap = sums.area_vector.norm() / sums.area;
            gap > largest_gap)
          {
            text
              << "It is open: as vectors, the areas of its patches add up to "
              << 100. * gap
              << " % of their sum. Choose all boundary points of the inner "
                 "surface.";
            where.refuse("a condition that chooses a closed surface",
                         text.str());
          }
        if (const double volume = enclosed_volume(patches, scene.comm);
            !(volume > 0.))
          {
            text
              << "It encloses " << volume << (dim == 3 ? " um^3" : " um^2")
              << ": the normals point away from it. Choose the boundary points "
                 "of an inner surface, whose normals point into the lumen.";
            where.refuse("a condition that chooses the surface of a lumen",
                         text.str());
          }
      }

      std::vector<Lumen> list;
    };
  } // namespace


  void
  add_lumen(Catalogue &catalogue)
  {
    catalogue.add_own<Lumens>("lumen",
                              {"Dimension=2",
                               "Tissue/Radius=5",
                               "Tissue/Inner radius=3",
                               "Boundary conditions/Lumen where=X*X + Y*Y < 16",
                               "Boundary conditions/Lumen volume=1 + 0.01*t"});
  }
} // namespace Morula
