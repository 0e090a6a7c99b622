// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/scene/reviews.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A value may leave the range of the two ends of its step by this part of
     *  its range in time. A wave does so from 3.4 steps a period on. */
    constexpr double most_outside = 0.2;

    /** So often an expression is evaluated at a place, about. */
    constexpr double most_samples = 2e4;

    /** Places of this rank at which an expression is looked at. */
    constexpr std::size_t most_places = 4;

    /** Where in time an expression leaves the range of a step's ends most. */
    struct Excursion
    {
      double outside = 0.; // relative to the range in time
      double begin = 0., end = 0., first = 0., last = 0., between = 0.;
    };

    /** The values of all variables at a place: 1 for what only the run knows,
     *  so that a factor that depends on time is seen. */
    template <int dim>
    VariableValues
    values_at(const Point<dim> &X, const Expression &expression)
    {
      VariableValues values;
      values.fill(1.);
      // No cell is of this type: what types have instead are keys of their own.
      if (!expression.types().empty())
        values[static_cast<unsigned int>(Variable::type)] = 1e6;
      values[static_cast<unsigned int>(Variable::Z)] = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          values[static_cast<unsigned int>(Variable::X) + d] = X[d];
          values[static_cast<unsigned int>(Variable::x) + d] = X[d];
        }
      return values;
    }

    /** The largest excursion of one component at one place.
     *  @throws InputError where it has no value */
    Excursion
    excursion(const Expression  &expression,
              const unsigned int component,
              VariableValues     values,
              const double       step,
              const double       end_time)
    {
      // Each step is cut into equal parts, the more the fewer steps there are.
      // First all values are found, as the range in time decides what counts.
      const auto n_steps = static_cast<std::size_t>(
        std::min(std::ceil(end_time / step - 1e-9), most_samples / 8.));
      const std::size_t parts = std::clamp<std::size_t>(
        static_cast<std::size_t>(most_samples / (n_steps + 1)), 8, 64);
      std::vector<double> all;
      for (std::size_t i = 0; i <= n_steps * parts; ++i)
        {
          values[static_cast<unsigned int>(Variable::t)] =
            std::min(step * i / parts, end_time);
          all.push_back(expression.value(values, component));
        }
      const auto [least, most] = std::minmax_element(all.begin(), all.end());
      const double range       = *most - *least;
      Excursion    worst;
      if (!(range > 1e-9 * std::max(std::abs(*most), std::abs(*least))))
        return worst;
      for (std::size_t n = 0; n < n_steps; ++n)
        {
          const double a = all[n * parts], b = all[(n + 1) * parts];
          for (std::size_t i = n * parts + 1; i < (n + 1) * parts; ++i)
            {
              const double outside =
                std::max(all[i] - std::max(a, b), std::min(a, b) - all[i]) /
                range;
              if (outside > worst.outside)
                worst = {outside,
                         step * n,
                         std::min(step * (n + 1), end_time),
                         a,
                         b,
                         all[i]};
            }
        }
      return worst;
    }

    /** An expression, and how many components of it count. */
    struct Timed
    {
      Expression   expression;
      unsigned int n_components;
    };

    /** The expressions of keys that are evaluated in the run and depend on
     *  time. Those of types are keys as well. */
    std::vector<Timed>
    of_time(const Scene &scene)
    {
      std::vector<Timed> list;
      for (const AnyKey *any : scene.list())
        if (const auto *const key = dynamic_cast<const ExpressionKey *>(any);
            key != nullptr && !key->empty() &&
            key->evaluated() != Evaluated::founder && key->is_changed())
          try
            {
              const Expression  &expression = key->expression(scene.dimension);
              const unsigned int n =
                std::min(key->components(), scene.dimension.value());
              list.push_back({expression, n});
            }
          catch (const std::exception &)
            {} // a word, such as a direction
      list.erase(std::remove_if(list.begin(),
                                list.end(),
                                [](const Timed &one) {
                                  return !one.expression.depends_on_time();
                                }),
                 list.end());
      return list;
    }
  } // namespace


  template <int dim>
  void
  review_steps(const Scene               &scene,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review)
  {
    // A few founders and boundary points of each rank stand for all places.
    // The worst of all ranks is told of, by the rank that has it, so that all
    // print the same. Expressions that have no value somewhere are refused
    // elsewhere.
    std::vector<Point<dim>> places;
    for (const auto *points : {&founders.positions, &surface.positions})
      for (std::size_t i = 0; i < points->size();
           i += std::max<std::size_t>(1, points->size() / most_places))
        places.push_back((*points)[i]);
    for (const auto &[expression, n_components] : of_time(scene))
      {
        Excursion worst;
        for (const Point<dim> &X : places)
          for (unsigned int c = 0; c < n_components; ++c)
            try
              {
                const Excursion here = excursion(expression,
                                                 c,
                                                 values_at(X, expression),
                                                 scene.time.step,
                                                 scene.time.end_time);
                if (here.outside > worst.outside)
                  worst = here;
              }
            catch (const std::exception &)
              {}
        std::array<double, 6> mine = {{worst.outside,
                                       worst.begin,
                                       worst.end,
                                       worst.first,
                                       worst.last,
                                       worst.between}};
        // Ranks have different places: that with the largest excursion counts.
        for (const auto &other : Utilities::MPI::all_gather(comm, mine))
          if (other > mine)
            mine = other;
        const auto &[outside, begin, end, first, last, between] = mine;
        if (outside <= most_outside)
          continue;
        review.warn(expression.key(),
                    expression.text(),
                    "in the step from t = " + as_text(begin) + " to " +
                      as_text(end) + " day it is " + as_text(between) +
                      " in between, and " + as_text(first) + " and " +
                      as_text(last) +
                      " at the ends: what happens between the ends of steps is "
                      "not seen, or in part.",
                    "Let steps end where it changes, and take at least ten "
                    "for a period.");
      }
  }


  MORULA_INSTANTIATE(review_steps);
} // namespace Morula
