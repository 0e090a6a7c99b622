// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/usual_numbers.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <exception>
#include <limits>

namespace Morula
{
  template <int dim>
  ValueRange
  range_of(const ExpressionKey           &key,
           const std::vector<Point<dim>> &founders,
           const MPI_Comm                 comm)
  {
    if (key.empty() || key.expression(dim).depends_on_state() ||
        key.differs_by_type())
      {
        const std::optional<double> number = key.largest_number(dim);
        return number ? ValueRange({*number, *number}) : ValueRange();
      }
    double smallest = std::numeric_limits<double>::max(), largest = -smallest;
    try
      {
        for (const Point<dim> &X : founders)
          {
            const double value = key.expression(dim).value(X, 0.);
            smallest           = std::min(smallest, value);
            largest            = std::max(largest, value);
          }
      }
    catch (const std::exception &)
      {} // refused elsewhere
    smallest = Utilities::MPI::min(smallest, comm);
    largest  = Utilities::MPI::max(largest, comm);
    return ValueRange({smallest, largest});
  }

  template <int dim>
  double
  longest_extent(const std::vector<Point<dim>> &points, const MPI_Comm comm)
  {
    double extent = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        double lower = std::numeric_limits<double>::max(), upper = -lower;
        for (const Point<dim> &X : points)
          {
            lower = std::min(lower, X[d]);
            upper = std::max(upper, X[d]);
          }
        extent = std::max(extent,
                          Utilities::MPI::max(upper, comm) -
                            Utilities::MPI::min(lower, comm));
      }
    return extent;
  }


  void
  review_number(const AnyKey      &key,
                const ValueRange  &range,
                const double       lower,
                const double       upper,
                const std::string &unit,
                const std::string &usual,
                const std::string &question,
                Review            &review)
  {
    // A key may have many values; a part of the tissue may be unusual, but
    // not all of it. A zero switches something off and is no number of
    // another unit.
    if (range && range->second > 0. &&
        (range->second < lower || range->first > upper))
      review.warn(key.path(),
                  as_text(range->second) + ' ' + unit,
                  usual + ". " + question,
                  "If it is meant so, all is well.");
  }


  MORULA_INSTANTIATE(range_of);
  MORULA_INSTANTIATE(longest_extent);
} // namespace Morula
