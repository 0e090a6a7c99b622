// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/momentum_balance.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The value for which better(value, others') holds, and its place, over
     *  all ranks; the first rank's of equal ones. */
    template <int dim, typename Better>
    void
    find_best(double        &value,
              Point<dim>    &place,
              const Better  &better,
              const MPI_Comm comm)
    {
      std::vector<double> own = {value};
      for (unsigned int d = 0; d < dim; ++d)
        own.push_back(place[d]);
      const auto  all  = Utilities::MPI::all_gather(comm, own);
      const auto *best = &all[0];
      for (const std::vector<double> &other : all)
        if (better(other[0], (*best)[0]))
          best = &other;
      value = (*best)[0];
      for (unsigned int d = 0; d < dim; ++d)
        place[d] = (*best)[1 + d];
    }
  } // namespace

  template <int dim>
  MomentumBalance<dim>::MomentumBalance(const SplineSpace<dim> &space,
                                        const TermList         &terms,
                                        const double            youngs_modulus,
                                        std::vector<Vector>     null_space,
                                        TimerOutput            &timer,
                                        const MPI_Comm          comm)
    : space(space)
    , terms(terms)
    , youngs_modulus(youngs_modulus)
    , null_space_(std::move(null_space))
    , timer(timer)
    , comm(comm)
    , assembly(space, comm)
  {}

  template <int dim>
  void
  MomentumBalance<dim>::initialize(Vector &vector) const
  {
    vector = assembly.unknowns().zero();
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::sum_up(const Vector                           &u,
                               const typename LocalSystem<dim>::Wanted wanted,
                               Vector &sum) const
  {
    const TimerOutput::Scope section(timer, "residual");
    LocalSystem<dim>         system(wanted);
    double                   energies[3] = {0., 0., 0.};
    extremes_of_rank = {std::numeric_limits<double>::infinity(), {}, -1., {}};
    const auto add   = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      for (const auto &term : terms)
        term->add(c, field, GrowthAt::current, local);
      update_extremes(local, space.grid_cells()[c].number);
      energies[0] += local.energy;
      energies[1] += local.energy_magnitude;
      return !local.inverted;
    };
    const std::vector<double> sums = assembly.residual(u, system, add);
    energies[2]                    = system.inverted;
    double totals[3];
    Utilities::MPI::sum(energies, comm, totals);
    if (totals[2] > 0)
      return {std::numeric_limits<double>::infinity(), 0.};
    sum = assembly.unknowns().sum(sums);
    return {totals[0], totals[1]};
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::residual(const Vector &u, Vector &R) const
  {
    return sum_up(u, LocalSystem<dim>::energy_and_residual, R);
  }

  template <int dim>
  void
  MomentumBalance<dim>::update_extremes(const LocalSystem<dim> &system,
                                        const unsigned int      number) const
  {
    const auto place = [&](const Point<dim> &xi) {
      return space.box().corner(space.box().index(number)) +
             space.box().spacing() * Tensor<1, dim>(xi);
    };
    Extremes<dim> &all = extremes_of_rank;
    if (system.smallest_J.value < all.smallest_J)
      {
        all.smallest_J = system.smallest_J.value;
        all.place_of_J = place(system.smallest_J.xi);
      }
    if (system.largest_gap.value > all.largest_gap)
      {
        all.largest_gap  = system.largest_gap.value;
        all.place_of_gap = place(system.largest_gap.xi);
      }
  }

  template <int dim>
  Extremes<dim>
  MomentumBalance<dim>::extremes() const
  {
    Extremes<dim> all = extremes_of_rank;
    find_best(all.smallest_J, all.place_of_J, std::less<double>(), comm);
    find_best(all.largest_gap, all.place_of_gap, std::greater<double>(), comm);
    return all;
  }

  template <int dim>
  Point<dim>
  MomentumBalance<dim>::place_of_largest(const Vector &R) const
  {
    double     largest = -1.;
    Point<dim> place;
    // An unknown belongs to the place that is its coefficient in the field x.
    std::vector<std::vector<double>> places(space.n_pieces());
    unsigned int                     k = 0;
    for (const auto row : R.locally_owned_elements())
      {
        const unsigned int unknown = k++ / dim;
        if (!(std::abs(R(row)) > largest))
          continue;
        const unsigned int piece = space.pieces_of_unknowns()[unknown];
        if (places[piece].empty())
          places[piece] =
            affine_displacement(space,
                                piece,
                                Tensor<1, dim>(),
                                Tensor<2, dim>(unit_symmetric_tensor<dim>()));
        largest = std::abs(R(row));
        for (unsigned int d = 0; d < dim; ++d)
          place[d] = places[piece][unknown * dim + d];
      }
    find_best(largest, place, std::greater<double>(), comm);
    return place;
  }

  template <int dim>
  std::string
  MomentumBalance<dim>::describe(const Vector &R) const
  {
    const Extremes<dim> all = extremes();
    std::ostringstream  text;
    if (all.smallest_J > 0.)
      text << "The smallest J_e is " << all.smallest_J << ", at ("
           << all.place_of_J << ") um";
    else
      text << "The tissue is inverted at (" << all.place_of_J << ") um";
    text << ", the largest unbalanced force acts near (" << place_of_largest(R)
         << ") um";
    if (all.largest_gap >= 0.)
      text << ", and the largest gap of a held point is " << all.largest_gap
           << " um, at (" << all.place_of_gap << ") um";
    return text.str();
  }

  template <int dim>
  double
  MomentumBalance<dim>::rounding(const Vector &u) const
  {
    Vector sum;
    sum_up(u, LocalSystem<dim>::rounding, sum);
    return sum.size() == 0 ?
             0. :
             10. * std::numeric_limits<double>::epsilon() * sum.l2_norm();
  }

  template <int dim>
  const TrilinosWrappers::SparseMatrix &
  MomentumBalance<dim>::tangent(const Vector &u, const GrowthAt growth)
  {
    if (!assembly.has_pattern())
      {
        const TimerOutput::Scope section(timer, "sparsity pattern");
        assembly.make_pattern();
      }
    const TimerOutput::Scope section(timer, "tangent");
    if (growth == GrowthAt::previous)
      linearisations.clear();
    const auto add = [&](const unsigned int     c,
                         const LocalField<dim> &field,
                         LocalSystem<dim>      &local) {
      local.last = !linearisations.empty() && linearisations[c] ?
                     &*linearisations[c] :
                     nullptr;
      for (const auto &term : terms)
        term->add(c, field, growth, local);
      if (local.linearisation)
        {
          linearisations.resize(space.grid_cells().size());
          linearisations[c] = local.linearisation;
        }
    };
    LocalSystem<dim> system(LocalSystem<dim>::tangent);
    return assembly.matrix(u, system, add);
  }

  template <int dim>
  bool
  MomentumBalance<dim>::is_conservative() const
  {
    for (const auto &term : terms)
      if (!term->is_conservative())
        return false;
    return true;
  }

  template <int dim>
  const std::vector<Equilibrium::Vector> &
  MomentumBalance<dim>::null_space() const
  {
    return null_space_;
  }

  template <int dim>
  IndexSet
  MomentumBalance<dim>::coupled_dofs() const
  {
    return assembly.unknowns().of_extended_splines();
  }

  template <int dim>
  double
  MomentumBalance<dim>::small_force() const
  {
    return 1e-6 * youngs_modulus * std::pow(space.box().spacing(), dim - 1);
  }

  template <int dim>
  double
  MomentumBalance<dim>::typical_length() const
  {
    return space.box().spacing();
  }

  template <int dim>
  double
  MomentumBalance<dim>::stiffness_scale() const
  {
    return youngs_modulus * std::pow(space.box().spacing(), dim - 2);
  }

  template class MomentumBalance<2>;
  template class MomentumBalance<3>;
} // namespace Morula
