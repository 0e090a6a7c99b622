// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/numerics/vector_tools.h>

#include <half-fixed-sphere/neo_hookean.h>
#include <half-fixed-sphere/stability.h>

#include <random>

namespace HalfFixedSphere
{
  namespace
  {
    /**
     * The amplitude of the gradient, in the basis (r, phi, z), of the shape
     * function with value @p v in @p component (0: a, 1: b, 2: c) and gradient
     * @p g. Entries that mix phi with r or z go with sin(m phi), the others
     * with cos(m phi); the material never couples the two kinds, so that the
     * integral over phi is the same factor for all.
     */
    Tensor<2, 3>
    amplitude(const unsigned int  component,
              const double        v,
              const Tensor<1, 2> &g,
              const double        r,
              const double        m)
    {
      Tensor<2, 3> D;
      D[component][0] = g[0];
      D[component][2] = g[1];
      D[component][1] = component == 1 ? m * v / r : -m * v / r;
      if (component == 0)
        D[1][1] = v / r;
      else if (component == 1)
        D[0][1] = -v / r;
      return D;
    }


    /** The matrices of the second variation, now and before growth. */
    class SecondVariation
    {
    public:
      SecondVariation(const Equilibrium &body, const unsigned int m);

      double
      smallest_eigenvalue() const;

    private:
      void
      make_constraints();

      void
      assemble();

      const Equilibrium        &body;
      const unsigned int        m;
      FESystem<2>               element;
      DoFHandler<2>             dofs;
      AffineConstraints<double> constraints;
      SparsityPattern           sparsity;
      SparseMatrix<double>      now, before;
    };


    SecondVariation::SecondVariation(const Equilibrium &body,
                                     const unsigned int m)
      : body(body)
      , m(m)
      , element(FE_Q<2>(body.element.degree), 3)
      , dofs(body.dofs.get_triangulation())
    {
      AssertThrow(m >= 2, ExcMessage("modes below 2 move the axis"));
      dofs.distribute_dofs(element);
      make_constraints();
      DynamicSparsityPattern pattern(dofs.n_dofs());
      DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
      sparsity.copy_from(pattern);
      now.reinit(sparsity);
      before.reinit(sparsity);
      assemble();
    }


    // For m >= 2 only fields that vanish on the axis are smooth there.
    void
    SecondVariation::make_constraints()
    {
      const Functions::ZeroFunction<2> zero(3);
      DoFTools::make_hanging_node_constraints(dofs, constraints);
      VectorTools::interpolate_boundary_values(
        body.mapping, dofs, axis, zero, constraints);
      if (body.parameters.held)
        VectorTools::interpolate_boundary_values(
          body.mapping, dofs, lower_surface, zero, constraints);
      constraints.close();
    }


    void
    SecondVariation::assemble()
    {
      const unsigned int n = element.n_dofs_per_cell();
      FullMatrix<double> cell_now(n, n), cell_before(n, n);

      std::vector<Tensor<2, 3>>            variations(n);
      std::vector<types::global_dof_index> indices(n);
      MeridianValues     state(body.mapping, body.element, body.quadratures);
      MeridianValues     values(body.mapping, element, body.quadratures);
      const Tensor<2, 3> I(unit_symmetric_tensor<3>());
      auto               state_cell = body.dofs.begin_active();
      for (const auto &cell : dofs.active_cell_iterators())
        {
          state.reinit(state_cell++);
          values.reinit(cell);
          cell_now    = 0.;
          cell_before = 0.;
          const std::vector<Tensor<2, 3>> F =
            state.deformation(body.displacement);
          for (unsigned int q = 0; q < values.n_points(); ++q)
            {
              if (values.r(q) == 0.)
                continue;
              const NeoHookean grown(body.lambda,
                                     body.mu,
                                     F[q],
                                     body.growth_stretch());
              const NeoHookean rest(body.lambda, body.mu, I, 1.);
              for (unsigned int i = 0; i < n; ++i)
                variations[i] =
                  amplitude(element.system_to_component_index(i).first,
                            values.value(i, q),
                            values.scalar_gradient(i, q),
                            values.r(q),
                            m);
              for (unsigned int i = 0; i < n; ++i)
                {
                  const Tensor<2, 3> dP =
                    grown.stress_change(variations[i]) * values.volume(q);
                  const Tensor<2, 3> dP_rest =
                    rest.stress_change(variations[i]) * values.volume(q);
                  for (unsigned int j = 0; j < n; ++j)
                    {
                      cell_now(i, j) += scalar_product(dP, variations[j]);
                      cell_before(i, j) +=
                        scalar_product(dP_rest, variations[j]);
                    }
                }
            }
          cell->get_dof_indices(indices);
          constraints.distribute_local_to_global(cell_now, indices, now);
          constraints.distribute_local_to_global(cell_before, indices, before);
        }
    }


    // Inverse iteration about a value that is below the smallest eigenvalue
    // unless the body is far beyond losing stability.
    double
    SecondVariation::smallest_eigenvalue() const
    {
      const double         below = -0.2;
      SparseMatrix<double> shifted(sparsity);
      shifted.copy_from(now);
      shifted.add(-below, before);
      SparseDirectUMFPACK solver;
      solver.initialize(shifted);

      std::mt19937                     generator;
      std::uniform_real_distribution<> random(-1., 1.);
      Vector<double>                   x(dofs.n_dofs()), y(dofs.n_dofs());
      for (double &entry : x)
        entry = random(generator);
      constraints.set_zero(x);
      double value = 0.;
      for (unsigned int i = 0; i < 500; ++i)
        {
          before.vmult(y, x);
          constraints.set_zero(y);
          solver.vmult(x, y);
          constraints.set_zero(x);
          const double norm = before.matrix_norm_square(x);
          const double next = now.matrix_norm_square(x) / norm;
          x /= std::sqrt(norm);
          if (std::abs(next - value) < 1e-6)
            return next;
          value = next;
        }
      return value;
    }
  } // namespace


  double
  smallest_eigenvalue(const Equilibrium &body, const unsigned int m)
  {
    return SecondVariation(body, m).smallest_eigenvalue();
  }
} // namespace HalfFixedSphere
