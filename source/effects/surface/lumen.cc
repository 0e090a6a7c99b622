// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/lumen_pressure.h>
#include <morula/effects/surface/placed_condition.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The keys of the lumen, in section "Boundary conditions". */
    struct LumenParameters : public ConditionKeys
    {
      LumenParameters()
        : ConditionKeys(
            "Boundary conditions/Lumen where",
            "Expression of X, Y, Z: the boundary points for which it "
            "is > 0 enclose a lumen; empty: there is none.")
      {}

      /** relative to that at t = 0 */
      ExpressionKey volume{
        {this, "Boundary conditions/Lumen volume"},
        "",
        "Volume of the lumen relative to that at t = 0, a function of t; "
        "> 0. The pressure that it takes is found, and stands in "
        "statistics.csv. Empty: what fills the lumen is a gas.",
        Evaluated::place,
        positive("times the volume at t = 0", "1 keeps the volume.")};

      ExpressionKey pressure{
        {this, "Boundary conditions/Lumen pressure"},
        "",
        "Pressure of a gas in the lumen at the volume that this has at "
        "t = 0, V0, a function of t; at the volume V the pressure is V0/V "
        "times it. Empty: the volume is given. Units: kPa.",
        Evaluated::place};
      std::string
      details() const override
      {
        return volume.empty() ?
                 "; gas, " + pressure.text() + " kPa at the volume of t = 0" :
                 "; volume " + volume.text() + " times that at t = 0";
      }
    };


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
     * A lumen that the tissue encloses: its volume is given, and its pressure
     * follows; or it is filled with a gas. doc/theory.md (4.8g) to (4.8j).
     */
    template <int dim>
    class Lumen : public PlacedCondition<dim>, public Moments<dim>
    {
    public:
      using Parameters = LumenParameters;

      /** @throws InputError for expressions that cannot be parsed or depend on
       *  places, and unless exactly one of volume and pressure is given */
      explicit Lumen(const Parameters &parameters)
        : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
        , where(parameters.where)
        , volume_(of_time(parameters.volume, dim))
        , pressure_(of_time(parameters.pressure, dim))
      {
        // A gas has a pressure and finds its volume, or the other way round.
        if (volume_ && pressure_)
          parameters.pressure.refuse(
            "nothing where " + parameters.volume.path() + " is set",
            "Of a lumen whose volume is given the "
            "pressure is found: leave one of them empty.");
        if (!volume_ && !pressure_)
          parameters.volume.refuse("a function of t where " +
                                     parameters.where.path() + " is set",
                                   "1 keeps the volume; or set " +
                                     parameters.pressure.path() + ".");
      }

      void
      check_surface(const Preview<dim>        &scene,
                    const std::vector<double> &areas) const override
      {
        std::vector<LumenPatch<dim>> patches;
        for (std::size_t i = 0; i < areas.size(); ++i)
          if (this->acts_on(scene.boundary_points[i], scene.normals[i]))
            patches.push_back(
              {scene.boundary_points[i], areas[i] * scene.normals[i]});
        // A surface that is closed has areas that add up to nothing, as
        // vectors; one whose normals point into the lumen has a positive
        // volume. The sums are over all ranks, so all of them refuse the scene.
        const SurfaceSums<dim> sums = sums_of(patches, scene.comm);
        if (sums.area == 0.)
          return; // which is refused for all conditions
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

      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &, const double) const override
      {
        // The momentum balance has the content of the lumen as a whole, as it
        // depends on all points.
        return nullptr;
      }

      std::unique_ptr<PartOfStep<dim>>
      part_of_step(const AttemptAtStep<dim> &attempt) const override
      {
        // All ranks find the volume together. The content may need expressions,
        // which can fail on one rank.
        const TimerOutput::Scope section(attempt.timer, "lumen");
        const double             volume =
          enclosed_volume(lumen_patches(*this, attempt.tissue), attempt.comm);
        EnclosedContent content;
        everywhere(attempt.comm,
                   [&]() { content = content_of(attempt, volume); });
        return lumen_pressure(*this, attempt, volume, content);
      }

      /** Measures the volume. The first pressure of a lumen that keeps it is a
       *  guess, 0, from which the turns of the first step begin. */
      void
      settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const override
      {
        moment.kept["lumen_at_start"] =
          enclosed_volume(lumen_patches(*this, tissue), tissue.communicator());
        moment.kept["lumen_pressure"] = keeps_volume() ? 0. : pressure(0.);
      }

      void
      describe(const Tissue<dim>      &tissue,
               const MomentOfRun<dim> &moment) const override
      {
        moment.of_step["lumen_volume"] =
          enclosed_volume(lumen_patches(*this, tissue), tissue.communicator());
        moment.of_step["lumen_pressure"] = moment.kept.at("lumen_pressure");
      }

      /** Volume and pressure in statistics.csv; what it had at t = 0 and its
       * last pressure are kept. */
      void
      declare(Tables<dim> &tables) const override
      {
        tables.add_number("lumen_volume");
        tables.add_number("lumen_pressure");
        tables.keep_number("lumen_at_start", 0.);
        tables.keep_number("lumen_pressure", 0.);
      }

      void
      check(const Preview<dim> &scene) const override
      {
        // Both ends of the run are tried, so that most mistakes show before it.
        for (const double t : {0., scene.keys.time.end_time.value()})
          if (keeps_volume())
            volume(t, 1.);
          else
            pressure(t);
      }
      void
      review(const Preview<dim> &scene, Review &review) const override
      {
        // The width is the smallest extent along an axis, over all ranks.
        double width = std::numeric_limits<double>::infinity();
        for (unsigned int d = 0; d < dim; ++d)
          {
            double lower = std::numeric_limits<double>::max(), upper = -lower;
            for (std::size_t i = 0; i < scene.boundary_points.size(); ++i)
              if (this->acts_on(scene.boundary_points[i], scene.normals[i]))
                {
                  lower = std::min(lower, scene.boundary_points[i][d]);
                  upper = std::max(upper, scene.boundary_points[i][d]);
                }
            width = std::min(width,
                             Utilities::MPI::max(upper, scene.comm) -
                               Utilities::MPI::min(lower, scene.comm));
          }
        const double h = scene.keys.grid.spacing;
        if (width < narrowest * h)
          review.warn(where.path(),
                      where.text(),
                      "the lumen is only " + as_text(width) + " um wide, " +
                        as_text(std::round(10. * width / h) / 10.) +
                        " times Grid/Spacing; at 2 times its pressure was 20 % "
                        "wrong (doc/theory.md, section 4.3).",
                      "Choose a Grid/Spacing of at most a third of its width.");
      }

    private:
      /** Whether the volume is given. */
      bool
      keeps_volume() const
      {
        return volume_.has_value();
      }

      /** V*, µm^dim, at @p t (day), if it was @p at_start at t = 0. */
      double
      volume(const double t, const double at_start) const
      {
        // The place does not matter, as of_time() has refused expressions of
        // it.
        return volume_->value(Point<dim>(), t) * at_start;
      }

      /** Pressure at the volume of t = 0, kPa. @throws InputError */
      double
      pressure(const double t) const
      {
        return pressure_->value(Point<dim>(), t);
      }

      /** The lumen's content before the pressure of the step is known.
       *  @param at_beginning the volume then, µm^dim
       *  @throws InputError */
      EnclosedContent
      content_of(const AttemptAtStep<dim> &attempt,
                 const double              at_beginning) const
      {
        // A gas has p = p₀V₀/V, which needs only the product. Where the volume
        // is given the content is that of a compressible fluid, doc/theory.md
        // (4.8j), which begins with the pressure of the step before: a good
        // guess saves turns.
        const double    at_start = attempt.kept.at("lumen_at_start");
        EnclosedContent content;
        if (!keeps_volume())
          {
            content.gas = pressure(attempt.t_next) * at_start;
            return content;
          }
        content.target             = volume(attempt.t_next, at_start);
        content.pressure_at_target = attempt.kept.at("lumen_pressure");
        content.stiffness_at_target =
          relative_modulus * attempt.typical_stiffness / at_beginning;
        return content;
      }

      const ExpressionKey             where;
      const std::optional<Expression> volume_;
      const std::optional<Expression> pressure_;
    };
  } // namespace


  void
  add_lumen(Catalogue &catalogue)
  {
    catalogue.add_own<Lumen>("lumen",
                             {"Dimension=2",
                              "Tissue/Radius=5",
                              "Tissue/Inner radius=3",
                              "Boundary conditions/Lumen where=X*X + Y*Y < 16",
                              "Boundary conditions/Lumen volume=1 + 0.01*t"});
  }
} // namespace Morula
