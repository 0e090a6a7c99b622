// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_usual_numbers_h
#define morula_effects_usual_numbers_h

#include <morula/base/expression_key.h>
#include <morula/base/review.h>

#include <deal.II/base/point.h>

#include <mpi.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A load per area above so many E tears or crushes any tissue. */
  constexpr double strongest_load = 10.;

  /** The smallest and the largest value of a key. */
  using ValueRange = std::optional<std::pair<double, double>>;

  /** The range of a key at founders of all ranks, as far as it is known before
   *  the run; of numbers by type the largest alone. Collective. */
  template <int dim>
  ValueRange
  range_of(const ExpressionKey           &key,
           const std::vector<Point<dim>> &founders,
           const MPI_Comm                 comm);

  /** The longest extent of the points of all ranks along an axis, µm.
   *  Collective. */
  template <int dim>
  double
  longest_extent(const std::vector<Point<dim>> &points, const MPI_Comm comm);

  /** Warns of a key whose values all look like those of another unit: none is
   *  from @p lower to @p upper. @param usual what tissue has @param question
   *  about the unit */
  void
  review_number(const AnyKey      &key,
                const ValueRange  &range,
                const double       lower,
                const double       upper,
                const std::string &unit,
                const std::string &usual,
                const std::string &question,
                Review            &review);
} // namespace Morula

#endif
