// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/scene/first_cells.h>
#include <morula/scene/rate_warnings.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** A rate times a step above this has an error that is seen: the change of
     *  other cells is felt a step late. */
    constexpr double largest_part = 0.3;
    /** The same of a rate that reads neighbours: two cells beside each other
     * may change in one step, as if neither saw the other. With this, 4 % of
     * those that inhibit each other stand wrongly. */
    constexpr double largest_part_beside = 0.02;
    /** From here on a rate is a switch: cells change in the next step. */
    constexpr double switch_part = 10.;

    /** Whether a value can change in a step by what other cells do. */
    bool
    feels_others(const Expression &expression)
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
                         [&own](const Variable variable) {
                           return std::find(own.begin(), own.end(), variable) ==
                                  own.end();
                         });
    }

    /** Whether a value depends on the types of the cells beside. */
    bool
    reads_neighbours(const Expression &expression)
    {
      const auto &used = expression.used();
      return std::any_of(
        used.begin(), used.end(), [&](const Variable variable) {
          const std::string name = expression.vocabulary().name_of(variable);
          return is_field(variable) &&
                 (name == "unlike" || name.rfind("neighbours_", 0) == 0 ||
                  name.rfind("touching_", 0) == 0 || name == "around_type");
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
    coupled_rates(const DevelopmentEffects<dim> &effects)
    {
      // Types have rates of their own, so they are asked type by type; other
      // fates have one list for all cells.
      std::vector<CoupledRate> list;
      const auto               add = [&list](const Expression                 &rate,
                               const std::optional<unsigned int> type) {
        if (feels_others(rate))
          list.push_back({rate, type});
      };
      if (effects.types != nullptr)
        for (unsigned int type = 0; type < effects.types->size(); ++type)
          for (const Expression *rate : effects.types->rates(type))
            add(*rate, type);
      for (const auto &fate : effects.fates)
        if (fate.get() != effects.types)
          for (const Expression *rate : fate->rates(0))
            add(*rate, {});
      return list;
    }

    void
    warn_of(const Expression &rate,
            const double      largest,
            const double      step,
            const double      allowed,
            Review           &review)
    {
      std::ostringstream why, remedy;
      why << "at t = 0 it is up to " << largest << " /day, " << largest * step
          << " in a step of " << step
          << " day. What other cells become in a step is felt in the next one "
             "only, an error of first order in rate times step.";
      remedy << "Let Time/Step be at most " << allowed / largest
             << " day, or compare with a run of half the step.";
      review.warn(rate.key(), rate.text(), why.str(), remedy.str());
    }
  } // namespace


  template <int dim>
  void
  review_rates(const Scene               &scene,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review)
  {
    // The rates are evaluated at all founders of this rank in their state at t
    // = 0; then the largest over all ranks is compared with the step. A rate
    // far above it is a switch, whose delay of a step is meant.
    std::vector<CoupledRate> rates =
      coupled_rates(effects_of<dim>(scene).development);
    if (rates.empty())
      return;
    const FirstCells<dim> cells(scene, founders, surface, comm);
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
        const double part    = largest * scene.time.step;
        const double allowed =
          reads_neighbours(coupled.rate) ? largest_part_beside : largest_part;
        if (part > allowed && part < switch_part)
          warn_of(coupled.rate, largest, scene.time.step, allowed, review);
      }
  }


#define INSTANTIATE(dim)                                  \
  template void review_rates(const Scene &,               \
                             const Founders<dim> &,       \
                             const SurfacePatches<dim> &, \
                             const MPI_Comm,              \
                             Review &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
