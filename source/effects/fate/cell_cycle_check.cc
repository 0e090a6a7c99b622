// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/fate/cell_cycle.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The unit vector along the key "Fixed axis". */
    template <int dim>
    Tensor<1, dim>
    unit_fixed_axis(const CellCycleParameters &parameters)
    {
      const Key<std::vector<double>> &components = parameters.fixed_axis;

      Tensor<1, dim> axis;
      for (unsigned int d = 0;
           d < std::min<std::size_t>(dim, components.size());
           ++d)
        axis[d] = components[d];

      const double length = axis.norm();
      if (components.size() < dim || !(length > 0.) || !std::isfinite(length))
        components.refuse("a vector of " + std::to_string(dim) +
                            " components that is not zero",
                          "Give the direction along which cells divide, or set "
                          "Division axis = random.");
      return axis / length;
    }


    /** What an expression is at a cell, for the end of "what is allowed". */
    template <int dim>
    std::string
    value_at(const double value, const Point<dim> &X)
    {
      std::ostringstream text;
      text << "; it is " << value << " for the cell at (" << X << ") um";
      return text.str();
    }
  } // namespace


  template <int dim>
  void
  review_cell_cycle(const CellCycleParameters &parameters,
                    const Preview<dim>        &scene,
                    Review                    &review)
  {
    const Expression &duration = parameters.duration.expression(dim);
    const Expression &where    = parameters.where.expression(dim);
    double            shortest = std::numeric_limits<double>::max();
    for (const Point<dim> &X : scene.founders)
      if (where.value(X, 0.) > 0.)
        shortest = std::min(shortest, duration.value(X, 0.));
    shortest = Utilities::MPI::min(shortest, scene.comm);
    if (scene.step > (0.25 + 1e-9) * shortest)
      review.warn(TimeParameters::step_path,
                  as_text(scene.step) + " day",
                  "that is " + as_text(scene.step / shortest) +
                    " of the shortest cell cycle, " + as_text(shortest) +
                    " day; measured are steps of up to a quarter "
                    "(doc/accuracy-and-cost.md, advice; doc/hard-cases.md, "
                    "showcase).",
                  "Shorten the step to 0.1 or 0.2 of the cycle.");
  }


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack)
    : duration(parameters.duration.expression(dim))
    , exit_rate(parameters.exit_rate.expression(dim))
    , size_checkpoint(parameters.size_checkpoint.expression(dim))
    , where(parameters.where.expression(dim))
    , start_together(parameters.start == "together")
    , random_axis(parameters.division_axis != "fixed")
    , axis_follows_rotation(parameters.axis_follows_rotation)
    , seed(seed)
    , slack(slack)
  {
    if (!random_axis)
      fixed_axis = unit_fixed_axis<dim>(parameters);
  }


  template <int dim>
  void
  CellCycle<dim>::check(const std::vector<Point<dim>> &founders,
                        const double                   step) const
  {
    double shortest = std::numeric_limits<double>::infinity();
    for (const Point<dim> &X : founders)
      if (where.value(X, 0.) > 0.)
        {
          const double T = duration.value(X, 0.);
          if (!(T > 0.))
            throw InputError(duration.key(),
                             duration.text(),
                             "a positive duration in days" + value_at(T, X),
                             "Make it positive wherever cells proliferate, or "
                             "exclude these cells by 'Where'.");
          shortest = std::min(shortest, T);

          const double rate = exit_rate.value(X, 0.);
          if (!(rate >= 0.))
            throw InputError(exit_rate.key(),
                             exit_rate.text(),
                             "a rate per day that is not negative" +
                               value_at(rate, X),
                             "Use 0 for cells that never leave G0.");

          const double threshold = size_checkpoint.value(X, 0.);
          if (!(threshold >= 0.))
            throw InputError(size_checkpoint.key(),
                             size_checkpoint.text(),
                             "a volume ratio that is not negative" +
                               value_at(threshold, X),
                             "Use 0 for no checkpoint.");
        }

    if (step > 0.5 * shortest + slack)
      {
        std::ostringstream value, limit;
        value << step;
        limit << "at most half the shortest cell cycle, " << 0.5 * shortest
              << " day";
        throw InputError(TimeParameters::step_path,
                         value.str(),
                         limit.str(),
                         "Shorten the step, or lengthen " + duration.key() +
                           ".");
      }
  }


  template CellCycle<2>::CellCycle(const CellCycleParameters &,
                                   const std::uint64_t,
                                   const double);
  template CellCycle<3>::CellCycle(const CellCycleParameters &,
                                   const std::uint64_t,
                                   const double);
  template void
  CellCycle<2>::check(const std::vector<Point<2>> &, const double) const;
  template void
  CellCycle<3>::check(const std::vector<Point<3>> &, const double) const;
  template void
  review_cell_cycle(const CellCycleParameters &, const Preview<2> &, Review &);
  template void
  review_cell_cycle(const CellCycleParameters &, const Preview<3> &, Review &);
} // namespace Morula
