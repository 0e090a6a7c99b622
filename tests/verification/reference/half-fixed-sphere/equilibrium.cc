// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/numerics/vector_tools.h>

#include <half-fixed-sphere/equilibrium.h>
#include <half-fixed-sphere/neo_hookean.h>

#include <algorithm>
#include <iostream>
#include <limits>
#include <random>

namespace HalfFixedSphere
{
  namespace
  {
    constexpr unsigned int most_iterations    = 60;
    constexpr double       largest_increment  = 0.1;
    constexpr double       smallest_increment = 1e-4;
  } // namespace


  Equilibrium::Equilibrium(const Triangulation<2> &mesh,
                           const Parameters       &parameters)
    : parameters(parameters)
    , lambda(parameters.youngs_modulus * parameters.poissons_ratio /
             ((1. + parameters.poissons_ratio) *
              (1. - 2. * parameters.poissons_ratio)))
    , mu(parameters.youngs_modulus / (2. * (1. + parameters.poissons_ratio)))
    , element(FE_Q<2>(parameters.degree), 2)
    , mapping(parameters.degree)
    , quadratures(parameters.degree, parameters.edge_points)
    , dofs(mesh)
  {
    dofs.distribute_dofs(element);
    make_constraints();
    DynamicSparsityPattern pattern(dofs.n_dofs());
    DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
    sparsity.copy_from(pattern);
    tangent.reinit(sparsity);
    tangent_at_rest.reinit(sparsity);
    residual.reinit(dofs.n_dofs());
    displacement.reinit(dofs.n_dofs());
    assemble(displacement, 1., 1.);
    tangent_at_rest.copy_from(tangent);
  }


  // On the axis u_r = 0. The held surface does not move at all; where nothing
  // is held, the lowest point does not, so that no rigid motion is left.
  void
  Equilibrium::make_constraints()
  {
    const Functions::ZeroFunction<2> zero(2);
    const FEValuesExtractors::Scalar radial(0);
    DoFTools::make_hanging_node_constraints(dofs, constraints);
    VectorTools::interpolate_boundary_values(
      mapping, dofs, axis, zero, constraints, element.component_mask(radial));
    if (parameters.held)
      VectorTools::interpolate_boundary_values(
        mapping, dofs, lower_surface, zero, constraints);
    else
      {
        const Point<2> lowest(0., -parameters.radius);
        for (const auto &cell : dofs.active_cell_iterators())
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(lowest) < 1e-9 * parameters.radius)
              constraints.add_line(cell->vertex_dof_index(v, 1));
      }
    constraints.close();
  }


  double
  Equilibrium::energy(const Vector<double> &u, const double theta) const
  {
    MeridianValues values(mapping, element, quadratures);
    double         sum = 0.;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        values.reinit(cell);
        const std::vector<Tensor<2, 3>> F = values.deformation(u);
        for (unsigned int q = 0; q < values.n_points(); ++q)
          {
            const NeoHookean material(lambda, mu, F[q], theta);
            if (material.inverted())
              return std::numeric_limits<double>::infinity();
            sum += material.energy() * values.volume(q);
          }
      }
    return sum;
  }


  void
  Equilibrium::assemble(const Vector<double> &u,
                        const double          theta,
                        const double          tangent_theta)
  {
    tangent  = 0.;
    residual = 0.;
    MeridianValues     values(mapping, element, quadratures);
    const unsigned int n = element.n_dofs_per_cell();
    FullMatrix<double> cell_matrix(n, n);
    Vector<double>     cell_residual(n);

    std::vector<Tensor<2, 3>>            variations(n);
    std::vector<types::global_dof_index> indices(n);
    for (const auto &cell : dofs.active_cell_iterators())
      {
        values.reinit(cell);
        cell_matrix                       = 0.;
        cell_residual                     = 0.;
        const std::vector<Tensor<2, 3>> F = values.deformation(u);
        for (unsigned int q = 0; q < values.n_points(); ++q)
          {
            const NeoHookean   now(lambda, mu, F[q], theta);
            const NeoHookean   then(lambda, mu, F[q], tangent_theta);
            const Tensor<2, 3> P = now.stress() * values.volume(q);
            for (unsigned int i = 0; i < n; ++i)
              variations[i] = values.gradient(i, q);
            for (unsigned int i = 0; i < n; ++i)
              {
                cell_residual(i) += scalar_product(P, variations[i]);
                const Tensor<2, 3> dP =
                  then.stress_change(variations[i]) * values.volume(q);
                for (unsigned int j = 0; j <= i; ++j)
                  cell_matrix(i, j) += scalar_product(dP, variations[j]);
              }
          }
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = i + 1; j < n; ++j)
            cell_matrix(i, j) = cell_matrix(j, i);
        cell->get_dof_indices(indices);
        constraints.distribute_local_to_global(
          cell_matrix, cell_residual, indices, tangent, residual);
      }
  }


  // Halves the step until the energy falls by a fair part of what its slope
  // promises (Armijo), up to rounding in a sum of terms of the size of E.
  double
  Equilibrium::line_search(const Vector<double> &u,
                           const Vector<double> &step,
                           const double          theta) const
  {
    const double slope = residual * step;
    const double here  = energy(u, theta);
    const double rounding =
      1e-14 * parameters.youngs_modulus * std::pow(parameters.radius, 3);
    Vector<double> trial(u.size());
    for (double factor = 1.; factor > 1e-4; factor *= 0.5)
      {
        trial = u;
        trial.add(factor, step);
        if (energy(trial, theta) <= here + 1e-4 * factor * slope + rounding)
          return factor;
      }
    return 0.;
  }


  // The tangent need not be positive definite away from the solution. Where
  // its step leads uphill, or only a small part of it can be taken, a multiple
  // of the tangent of the body at rest, which is, is added to it: more each
  // time, less after each good step.
  double
  Equilibrium::find_step(const Vector<double> &u,
                         const double          theta,
                         Vector<double>       &step)
  {
    SparseMatrix<double> matrix(sparsity);
    for (unsigned int attempt = 0; attempt < 12; ++attempt)
      {
        matrix.copy_from(tangent);
        if (shift > 0.)
          matrix.add(shift, tangent_at_rest);
        SparseDirectUMFPACK solver;
        solver.initialize(matrix);
        solver.vmult(step, residual);
        step *= -1.;
        constraints.distribute(step);
        const double factor =
          residual * step < 0. ? line_search(u, step, theta) : 0.;
        if (factor < 1. || shift > 0.)
          std::cout << "    factor " << factor << ", shift " << shift
                    << std::endl;
        if (factor > 0.2)
          {
            if (factor == 1.)
              shift = shift < 1e-3 ? 0. : shift / 8.;
            return factor;
          }
        shift = std::max(1e-3, 4. * shift);
      }
    return 0.;
  }


  // The first iteration uses the tangent of the old growth: with the new one
  // the tissue, not yet expanded, is under a pressure that may make the
  // tangent indefinite.
  bool
  Equilibrium::newton(const double new_theta)
  {
    Vector<double> u = displacement;
    Vector<double> step(u.size());
    double         first = 0.;
    shift                = 0.;
    std::cout << "theta = " << new_theta << std::endl;
    for (unsigned int i = 0; i < most_iterations; ++i)
      {
        assemble(u, new_theta, i == 0 ? theta : new_theta);
        const double norm = residual.l2_norm();
        if (i == 0)
          first = norm;
        std::cout << "  iteration " << i << "  residual " << norm << std::endl;
        if (norm <= parameters.tolerance * first)
          {
            displacement = u;
            theta        = new_theta;
            return true;
          }
        ++iterations;
        const double factor = find_step(u, new_theta, step);
        if (factor == 0.)
          break;
        u.add(factor, step);
      }
    std::cout << "  no convergence" << std::endl;
    return false;
  }


  // Increments are halved after a failure and doubled after a success.
  void
  Equilibrium::grow_to(const double target)
  {
    while (theta != target)
      {
        const double distance = target - theta;
        const bool   reaches  = std::abs(distance) < 1.001 * increment;
        if (newton(reaches ? target :
                             theta + std::copysign(increment, distance)))
          {
            increment = std::min(2. * increment, largest_increment);
            continue;
          }
        increment = 0.5 * std::min(increment, std::abs(distance));
        if (increment < smallest_increment)
          throw NoConvergence(
            "Newton's method fails beyond theta = " + std::to_string(theta) +
            ". Coarser grid cells at the edge ('Edge levels') may help.");
      }
  }


  std::array<double, 2>
  Equilibrium::derivative_errors()
  {
    const double grown = 1.05 * theta;
    const double small =
      1e-7 * innermost_size(parameters.radius, parameters.mesh);
    std::mt19937                     generator;
    std::uniform_real_distribution<> random(-1., 1.);
    Vector<double>                   direction(displacement.size());
    for (double &x : direction)
      x = random(generator);
    constraints.distribute(direction);

    std::array<double, 2>         energies;
    std::array<Vector<double>, 2> residuals;
    for (const unsigned int side : {0, 1})
      {
        Vector<double> u = displacement;
        u.add(side == 0 ? -small : small, direction);
        energies[side] = energy(u, grown);
        assemble(u, grown, grown);
        residuals[side] = residual;
      }
    const double   slope  = (energies[1] - energies[0]) / (2. * small);
    Vector<double> change = residuals[1];
    change -= residuals[0];
    change /= 2. * small;

    assemble(displacement, grown, grown);
    Vector<double> free = direction, predicted(direction.size());
    constraints.set_zero(free);
    tangent.vmult(predicted, free);
    constraints.set_zero(predicted);
    change -= predicted;
    return {{std::abs(residual * free - slope) / std::abs(slope),
             change.linfty_norm() / predicted.linfty_norm()}};
  }
} // namespace HalfFixedSphere
