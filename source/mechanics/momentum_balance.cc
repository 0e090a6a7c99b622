// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>
#include <morula/mechanics/displacement_field.h>
#include <morula/mechanics/momentum_balance.h>

#include <deal.II/base/mpi.h>

#include <limits>

namespace Morula
{
  template <int dim>
  MomentumBalance<dim>::MomentumBalance(const SplineSpace<dim> &space,
                                        const TermList         &terms,
                                        const double            youngs_modulus,
                                        const RigidModes<dim>  &rigid_modes,
                                        TimerOutput            &timer,
                                        const MPI_Comm          comm)
    : space(space)
    , terms(terms)
    , youngs_modulus(youngs_modulus)
    , null_space_(rigid_modes.null_space())
    , timer(timer)
    , comm(comm)
  {}

  template <int dim>
  void
  MomentumBalance<dim>::initialize(Vector &vector) const
  {
    vector.reinit(space.owned_dofs(), comm);
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::assemble_residual(
    const Vector                           &u,
    const typename LocalSystem<dim>::Wanted wanted,
    Vector                                 &sum) const
  {
    const TimerOutput::Scope section(timer, "residual");
    const bool               magnitudes = wanted == LocalSystem<dim>::rounding;
    const DisplacementField<dim> displacement(space, u, comm);
    LocalSystem<dim>             system(wanted);
    std::vector<double>          sums(space.relevant_dofs().n_elements(), 0.);
    double                       energies[3] = {0., 0., 0.};
    for (unsigned int c = 0; c < space.cells().size() && !system.inverted; ++c)
      {
        const LocalField<dim> field = displacement.on_cell(c);
        system.clear();
        for (const auto &term : terms)
          term->add(c, field, GrowthAt::current, system);
        energies[0] += system.energy;
        energies[1] += system.energy_magnitude;

        const auto               &unknowns = space.cells()[c].unknowns;
        const std::vector<double> condensed =
          Condensation<dim>(space.cells()[c])
            .condense(magnitudes ? system.magnitude : system.residual,
                      magnitudes);
        for (unsigned int s = 0; s < unknowns.size(); ++s)
          for (unsigned int i = 0; i < dim; ++i)
            sums[unknowns[s] * dim + i] += condensed[i * unknowns.size() + s];
      }
    energies[2] = system.inverted;
    double totals[3];
    Utilities::MPI::sum(energies, comm, totals);
    if (totals[2] > 0)
      return {std::numeric_limits<double>::infinity(), 0.};

    sum.reinit(space.owned_dofs(), space.relevant_dofs(), comm, true);
    std::vector<types::global_dof_index> dofs;
    space.relevant_dofs().fill_index_vector(dofs);
    sum.add(dofs, sums);
    sum.compress(VectorOperation::add);
    return {totals[0], totals[1]};
  }

  template <int dim>
  typename MomentumBalance<dim>::Evaluation
  MomentumBalance<dim>::residual(const Vector &u, Vector &R) const
  {
    Vector           sum;
    const Evaluation evaluation =
      assemble_residual(u, LocalSystem<dim>::energy_and_residual, sum);
    if (std::isfinite(evaluation.energy))
      R = sum;
    return evaluation;
  }

  template <int dim>
  double
  MomentumBalance<dim>::rounding(const Vector &u) const
  {
    Vector sum;
    assemble_residual(u, LocalSystem<dim>::rounding, sum);
    return sum.size() == 0 ?
             0. :
             10. * std::numeric_limits<double>::epsilon() * sum.l2_norm();
  }

  template <int dim>
  const TrilinosWrappers::SparseMatrix &
  MomentumBalance<dim>::tangent(const Vector &u, const GrowthAt growth)
  {
    if (!scatter)
      {
        const TimerOutput::Scope section(timer, "sparsity pattern");
        scatter.emplace(space, matrix, comm);
      }
    const TimerOutput::Scope section(timer, "tangent");
    matrix = 0.;
    const DisplacementField<dim> displacement(space, u, comm);
    LocalSystem<dim>             system(LocalSystem<dim>::tangent);
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      {
        const LocalField<dim> field = displacement.on_cell(c);
        system.clear();
        for (const auto &term : terms)
          term->add(c, field, growth, system);
        scatter->add(
          c, Condensation<dim>(space.cells()[c]).condense(system.matrix));
      }
    matrix.compress(VectorOperation::add);
    return matrix;
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
  double
  MomentumBalance<dim>::small_force() const
  {
    return 1e-6 * youngs_modulus * std::pow(space.box().spacing(), dim - 1);
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
