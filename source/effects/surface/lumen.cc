// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/lumen.h>
#include <morula/effects/surface/lumen_pressure.h>
#include <morula/effects/tables.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

    /** Sums of a surface's patches. */
    template <int dim>
    struct SurfaceSums
    {
      double         area = 0.;   // µm^(dim-1)
      Tensor<1, dim> area_vector; // likewise
      Point<dim>     center;      // µm, the mean by area
    };

    template <int dim>
    SurfaceSums<dim>
    sums_of(const std::vector<LumenPatch<dim>> &patches, const MPI_Comm comm)
    {
      // All sums take one reduction.
      std::vector<double> mine(2 * dim + 1, 0.);
      for (const LumenPatch<dim> &patch : patches)
        {
          const double a = patch.area.norm();
          mine[2 * dim] += a;
          for (unsigned int d = 0; d < dim; ++d)
            {
              mine[d] += patch.area[d];
              mine[dim + d] += a * patch.x[d];
            }
        }
      std::vector<double> all(2 * dim + 1);
      Utilities::MPI::sum(mine, comm, all);
      SurfaceSums<dim> result;
      result.area = all[2 * dim];
      for (unsigned int d = 0; d < dim; ++d)
        {
          result.area_vector[d] = all[d];
          result.center[d] = result.area > 0. ? all[dim + d] / result.area : 0.;
        }
      return result;
    }
  } // namespace


  std::string
  LumenParameters::details() const
  {
    return volume.empty() ?
             "; gas, " + pressure.text() + " kPa at the volume of t = 0" :
             "; volume " + volume.text() + " times that at t = 0";
  }


  template <int dim>
  double
  enclosed_volume(const std::vector<LumenPatch<dim>> &patches,
                  const MPI_Comm                      comm)
  {
    // This is doc/theory.md (4.8g): seen from its middle, the volume does not
    // change where the lumen moves as a whole, though patches may leave small
    // gaps.
    const Point<dim> center = sums_of(patches, comm).center;
    double           volume = 0.;
    for (const LumenPatch<dim> &patch : patches)
      volume -= (patch.x - center) * patch.area / dim;
    return Utilities::MPI::sum(volume, comm);
  }


  template <int dim>
  Lumen<dim>::Lumen(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
    , where(parameters.where)
    , volume_(of_time(parameters.volume, dim))
    , pressure_(of_time(parameters.pressure, dim))
  {
    // A gas has a pressure and finds its volume, or the other way round.
    if (volume_ && pressure_)
      parameters.pressure.refuse("nothing where " + parameters.volume.path() +
                                   " is set",
                                 "Of a lumen whose volume is given the "
                                 "pressure is found: leave one of them empty.");
    if (!volume_ && !pressure_)
      parameters.volume.refuse("a function of t where " +
                                 parameters.where.path() + " is set",
                               "1 keeps the volume; or set " +
                                 parameters.pressure.path() + ".");
  }


  template <int dim>
  double
  Lumen<dim>::volume(const double t, const double at_start) const
  {
    // The expression at the time of the step; the rule of the key is applied
    // here, with the time in the message.
    // The place does not matter, as of_time() has refused expressions of it.
    const double factor = volume_->value(Point<dim>(), t);
    if (factor > 0.)
      return factor * at_start;
    std::ostringstream place;
    place << "It is " << factor << " at t = " << t << " day.";
    throw InputError(volume_->key(),
                     volume_->text(),
                     "a value > 0 times the volume at t = 0",
                     place.str());
  }


  template <int dim>
  void
  Lumen<dim>::check_surface(const std::vector<LumenPatch<dim>> &patches,
                            const MPI_Comm                      comm) const
  {
    // A surface that is closed has areas that add up to nothing, as vectors;
    // one whose normals point into the lumen has a positive volume. The sums
    // are over all ranks, so all of them refuse the scene.
    const SurfaceSums<dim> sums = sums_of(patches, comm);
    if (sums.area == 0.)
      return; // which is refused for all conditions
    std::ostringstream text;
    if (const double gap = sums.area_vector.norm() / sums.area;
        gap > largest_gap)
      {
        text << "It is open: as vectors, the areas of its patches add up to "
             << 100. * gap
             << " % of their sum. Choose all boundary points of the inner "
                "surface.";
        where.refuse("a condition that chooses a closed surface", text.str());
      }
    if (const double volume = enclosed_volume(patches, comm); !(volume > 0.))
      {
        text << "It encloses " << volume << (dim == 3 ? " um^3" : " um^2")
             << ": the normals point away from it. Choose the boundary points "
                "of an inner surface, whose normals point into the lumen.";
        where.refuse("a condition that chooses the surface of a lumen",
                     text.str());
      }
  }


  template <int dim>
  void
  Lumen<dim>::check_surface(const Preview<dim>        &scene,
                            const std::vector<double> &areas) const
  {
    std::vector<LumenPatch<dim>> patches;
    for (std::size_t i = 0; i < areas.size(); ++i)
      if (this->acts_on(scene.boundary_points[i], scene.normals[i]))
        patches.push_back(
          {scene.boundary_points[i], areas[i] * scene.normals[i]});
    check_surface(patches, scene.comm);
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  Lumen<dim>::term(const LoadedPoints<dim> &, const double) const
  {
    // The momentum balance has the content of the lumen as a whole, as it
    // depends on all points.
    return nullptr;
  }


  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  Lumen<dim>::part_of_step(const AttemptAtStep<dim> &attempt) const
  {
    const TimerOutput::Scope section(attempt.timer, "lumen");
    return std::make_unique<LumenPressure<dim>>(*this, attempt);
  }


  template <int dim>
  void
  Lumen<dim>::settle(Tissue<dim> &tissue, const MomentOfRun<dim> &moment) const
  {
    moment.kept["lumen_at_start"] =
      enclosed_volume(lumen_patches(*this, tissue), tissue.communicator());
    moment.kept["lumen_pressure"] = keeps_volume() ? 0. : pressure(0.);
  }


  template <int dim>
  void
  Lumen<dim>::describe(const Tissue<dim>      &tissue,
                       const MomentOfRun<dim> &moment) const
  {
    moment.of_step["lumen_volume"] =
      enclosed_volume(lumen_patches(*this, tissue), tissue.communicator());
    moment.of_step["lumen_pressure"] = moment.kept.at("lumen_pressure");
  }


  template <int dim>
  void
  Lumen<dim>::check(const Preview<dim> &scene) const
  {
    // Both ends of the run are tried, so that most mistakes show before it.
    for (const double t : {0., scene.keys.time.end_time.value()})
      if (keeps_volume())
        volume(t, 1.);
      else
        pressure(t);
  }


  template <int dim>
  void
  Lumen<dim>::review(const Preview<dim> &scene, Review &review) const
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


  template <int dim>
  void
  Lumen<dim>::declare(Tables<dim> &tables) const
  {
    tables.add_number("lumen_volume");
    tables.add_number("lumen_pressure");
    tables.keep_number("lumen_at_start", 0.);
    tables.keep_number("lumen_pressure", 0.);
  }


  MORULA_INSTANTIATE(enclosed_volume);
  template class Lumen<2>;
  template class Lumen<3>;
} // namespace Morula
