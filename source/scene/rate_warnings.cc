// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/rate_warnings.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Of a rate times a step. */
    constexpr double largest_part = 0.3;
    /** From here on a rate is a switch: cells change in the next step. */
    constexpr double switch_part = 10.;

    /** Whether a value can change in a step by what other cells do. */
    bool
    feels_others(const Expression &expression)
    {
      using V         = Variable;
      const auto own  = {V::X, V::Y, V::Z, V::t, V::generation, V::age};
      const auto kept = {V::type_age, V::type, V::depth, V::noise};
      return std::any_of(expression.used().begin(),
                         expression.used().end(),
                         [&](const Variable variable) {
                           return std::count(own.begin(), own.end(), variable) +
                                    std::count(kept.begin(),
                                               kept.end(),
                                               variable) ==
                                  0;
                         });
    }

    /** The rates that are looked at. */
    template <int dim>
    std::vector<const Expression *>
    coupled_rates(const DevelopmentEffects<dim> &effects,
                  const unsigned int             type)
    {
      std::vector<const Expression *> rates;
      if (effects.types)
        rates = effects.types->rates(type);
      if (effects.death)
        rates.push_back(&effects.death->rate());
      rates.erase(std::remove_if(rates.begin(),
                                 rates.end(),
                                 [](const Expression *rate) {
                                   return !feels_others(*rate);
                                 }),
                  rates.end());
      return rates;
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
  review_rates(const Scene         &scene,
               const Founders<dim> &founders,
               const MPI_Comm       comm,
               Review              &review)
  {
    const SceneEffects<dim>                      made = effects_of<dim>(scene);
    const DevelopmentEffects<dim>               &effects = made.development;
    std::vector<std::vector<const Expression *>> rates;
    for (std::size_t type = 0;
         type < std::max<std::size_t>(1, scene.cell_types.types.size());
         ++type)
      rates.push_back(coupled_rates(effects, type));
    if (std::all_of(rates.begin(), rates.end(), [](const auto &list) {
          return list.empty();
        }))
      return;

    const TissueMaterial                 material(scene.material);
    const CellReader<dim>                reader{made.state,
                                 material,
                                 effects.clock ? &*effects.clock : nullptr,
                                 effects.cycle ? &*effects.cycle : nullptr,
                                 scene.random_seed,
                                 0.};
    std::map<const Expression *, double> largest;
    for (std::size_t i = 0; i < founders.positions.size(); ++i)
      {
        const Point<dim>    X   = founders.positions[i];
        std::vector<double> row = made.columns.founder(X, founders.volumes[i]);
        const CellView<dim, double> cell(make_array_view(row), made.columns);
        made.fields.begin(cell);
        if (effects.types)
          cell.set(made.state.type,
                   founders.types.empty() ? effects.types->founder_type(X) :
                                            founders.types[i]);
        const PresentCell<dim> founder(cell, founders.first_id + i, X, reader);
        for (const Expression *rate : rates[founder.type()])
          largest[rate] = std::max(largest[rate], founder.value(*rate, 0.));
      }
    std::set<const Expression *> seen;
    for (const auto &list : rates)
      for (const Expression *rate : list)
        {
          const double all  = Utilities::MPI::max(largest[rate], comm);
          const double part = all * scene.time.step;
          if (seen.insert(rate).second && part > largest_part &&
              part < switch_part)
            warn_of(*rate, all, scene.time.step, review);
        }
  }


  template void
  review_rates(const Scene &, const Founders<2> &, const MPI_Comm, Review &);
  template void
  review_rates(const Scene &, const Founders<3> &, const MPI_Comm, Review &);
} // namespace Morula
