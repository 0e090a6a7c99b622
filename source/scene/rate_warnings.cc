// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/scene/first_cells.h>
#include <morula/scene/reviews.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A rate times a step above this has an error that is seen: the change of
     *  other cells is felt a step late. */
    constexpr double largest_part = 0.3;
    /** From here on a rate is a switch: cells change in the next step. */
    constexpr double switch_part = 10.;

    /** Whether a value can change in a step by what other cells do, besides
     *  those of its variables that cells see in the step itself. */
    bool
    feels_others(const Expression                          &expression,
                 const std::function<bool(const Variable)> &seen)
    {
      using V                         = Variable;
      constexpr std::array<V, 10> own = {{V::X,
                                          V::Y,
                                          V::Z,
                                          V::t,
                                          V::generation,
                                          V::age,
                                          V::type_age,
                                          V::type,
                                          V::depth,
                                          V::noise}};
      return std::any_of(expression.used().begin(),
                         expression.used().end(),
                         [&](const Variable variable) {
                           return !seen(variable) &&
                                  std::find(own.begin(), own.end(), variable) ==
                                    own.end();
                         });
    }

    /** A rate that depends on what other cells do. */
    struct CoupledRate
    {
      Expression rate;
      /** The type of the cells that it is for; none: all cells. */
      std::optional<unsigned int> type;
      /** The largest value over all founders of this rank, 1/day. */
      double largest = 0.;
    };

    template <int dim>
    std::vector<CoupledRate>
    coupled_rates(const TissueModel<dim> &model)
    {
      // Types have rates of their own, so they are asked type by type; other
      // fates have one list for all cells.
      const auto seen = [&](const Variable variable) {
        return model.sees_neighbours &&
               is_type_around(variable, model.development.state());
      };
      std::vector<CoupledRate> list;
      const auto               add = [&](const Expression                 &rate,
                           const std::optional<unsigned int> type) {
        if (feels_others(rate, seen))
          list.push_back({rate, type});
      };
      if (model.types != nullptr)
        for (unsigned int type = 0; type < model.types->size(); ++type)
          for (const Expression *rate : model.types->rates(type))
            add(*rate, type);
      for (const auto &fate : model.development.fates())
        if (fate.get() != model.types)
          for (const Expression *rate : fate->rates(0))
            add(*rate, {});
      return list;
    }

    void
    warn_of(const Expression &rate,
            const double      largest,
            const double      step,
            Review           &review)
    {
      std::ostringstream why, remedy;
      why << "at t = 0 it is up to " << largest << " /day, " << largest * step
          << " in a step of " << step
          << " day. What other cells become in a step is felt in the next one "
             "only, an error of first order in rate times step.";
      remedy << "Let Time/Step be at most " << largest_part / largest
             << " day, or compare with a run of half the step.";
      review.warn(rate.key(), rate.text(), why.str(), remedy.str());
    }
  } // namespace


  template <int dim>
  void
  review_rates(const TissueModel<dim>    &model,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review)
  {
    // The rates are evaluated at all founders of this rank in their state at t
    // = 0; then the largest over all ranks is compared with the step. A rate
    // far above it is a switch, whose delay of a step is meant.
    const double             step  = model.scene.time.step;
    std::vector<CoupledRate> rates = coupled_rates(model);
    if (rates.empty())
      return;
    const FirstCells<dim> cells(model, founders, surface, comm);
    // An expression may have no value at some founder; then all ranks throw.
    everywhere(comm, [&]() {
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        {
          std::vector<double>    row     = cells.row(i);
          const PresentCell<dim> founder = cells.cell(row, i);
          for (CoupledRate &coupled : rates)
            if (!coupled.type || *coupled.type == founder.type())
              coupled.largest =
                std::max(coupled.largest, founder.value(coupled.rate, 0.));
        }
    });
    for (const CoupledRate &coupled : rates)
      {
        const double largest = Utilities::MPI::max(coupled.largest, comm);
        const double part    = largest * step;
        if (part > largest_part && part < switch_part)
          warn_of(coupled.rate, largest, step, review);
      }
  }


  MORULA_INSTANTIATE(review_rates);
} // namespace Morula
