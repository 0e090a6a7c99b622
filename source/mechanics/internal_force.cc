// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/internal_force.h>

namespace Morula
{
  namespace
  {
    /** Spatial gradients g_a = f⁻ᵀ ∇N_a, by direction. */
    template <int dim>
    struct SpatialGradients
    {
      static constexpr unsigned int n = BSpline<dim>::n;

      double g[dim][n];

      SpatialGradients(const SplineValues<dim> &splines,
                       const Tensor<2, dim>    &f_inverse)
      {
        // f⁻ᵀ maps gradients in the configuration at t to those in the trial
        // configuration.
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int a = 0; a < n; ++a)
            {
              double sum = 0.;
              for (unsigned int k = 0; k < dim; ++k)
                sum += f_inverse[k][j] * splines.gradient[k][a];
              g[j][a] = sum;
            }
      }
    };

    /** @param tau W τ */
    template <int dim>
    void
    add_stress(const SpatialGradients<dim>   &gradients,
               const SymmetricTensor<2, dim> &tau,
               LocalSystem<dim>              &system)
    {
      // This is the force on each spline, doc/theory.md (2.4).
      constexpr unsigned int n = BSpline<dim>::n;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          {
            double force = 0.;
            for (unsigned int j = 0; j < dim; ++j)
              force += tau[i][j] * gradients.g[j][a];
            system.residual[i * n + a] += force;
          }
      // A loop of its own keeps the one above free of a branch.
      if (system.wanted == LocalSystem<dim>::rounding)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < n; ++a)
            for (unsigned int j = 0; j < dim; ++j)
              system.magnitude[i * n + a] +=
                std::abs(tau[i][j] * gradients.g[j][a]);
    }

    /** The coefficients of (2.5), times W. */
    struct TangentCoefficients
    {
      double A, c, alpha, B, C; // c = α - γ
    };

    /**
     * Adds the blocks (i, j), i <= j, of the tangent (2.5). The inner loops run
     * over contiguous columns, so that the compiler vectorises them.
     */
    template <int dim>
    void
    add_blocks(const SpatialGradients<dim>   &gradients,
               const SymmetricTensor<2, dim> &b,
               const TangentCoefficients     &of,
               const bool                     coupled,
               double                        *matrix)
    {
      // With b_e g_a in a table of its own, the block (i, j) of doc/theory.md
      // (2.5) is an outer product of rows by a and by c. The loop runs over
      // rows a, components i and j ≥ i, and innermost over all columns c. The
      // terms with C, and the rest of B, exist for coupled laws only.
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const auto            &g      = gradients.g;

      double b_g[dim][n];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          {
            b_g[i][a] = b[i][0] * g[0][a];
            for (unsigned int j = 1; j < dim; ++j)
              b_g[i][a] += b[i][j] * g[j][a];
          }
      for (unsigned int a = 0; a < n; ++a)
        {
          // α g_a · b_e g_c is the same for all blocks on the diagonal.
          double alpha_b_g[dim], geometric[n];
          for (unsigned int j = 0; j < dim; ++j)
            alpha_b_g[j] = of.alpha * b_g[j][a];
          for (unsigned int c = 0; c < n; ++c)
            {
              geometric[c] = 0.;
              for (unsigned int j = 0; j < dim; ++j)
                geometric[c] += alpha_b_g[j] * g[j][c];
            }
          for (unsigned int i = 0; i < dim; ++i)
            {
              double *const rows  = matrix + (i * n + a) * n_dofs;
              const double  first = of.A * g[i][a] + of.B * b_g[i][a];
              const double  both  = first + of.c * g[i][a];
              for (unsigned int c = 0; c < n; ++c)
                rows[i * n + c] += both * g[i][c] + geometric[c];
              for (unsigned int j = i + 1; j < dim; ++j)
                {
                  const double second = of.c * g[j][a];
                  for (unsigned int c = 0; c < n; ++c)
                    rows[j * n + c] += first * g[j][c] + second * g[i][c];
                }
              const double of_b_g = of.B * g[i][a] + of.C * b_g[i][a];
              if (coupled)
                for (unsigned int j = i; j < dim; ++j)
                  for (unsigned int c = 0; c < n; ++c)
                    rows[j * n + c] += of_b_g * b_g[j][c];
            }
        }
    }

    /** Fills the blocks (j, i), j > i, from symmetry. */
    template <int dim>
    void
    add_lower_blocks(const std::vector<double> &upper,
                     std::vector<double>       &matrix)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          // The blocks on the diagonal are symmetric in themselves;
          // add_blocks() has filled them whole.
          for (unsigned int j = i; j < dim; ++j)
            for (unsigned int c = 0; c < n; ++c)
              {
                const unsigned int row = i * n + a, column = j * n + c;
                matrix[row * n_dofs + column] += upper[row * n_dofs + column];
                if (j > i)
                  matrix[column * n_dofs + row] += upper[row * n_dofs + column];
              }
    }
  } // namespace


  template <int dim>
  template <typename Visit>
  bool
  InternalForce<dim>::for_each_point(const Range           &range,
                                     const LocalField<dim> &field,
                                     const GrowthAt         growth,
                                     LocalSystem<dim>      &system,
                                     const Visit           &visit) const
  {
    const auto &states = points.states(growth);
    for (unsigned int p = range.first; p < range.last; ++p)
      {
        // f is the step's deformation, the reference being the configuration at
        // t; with A = F_t F_g⁻¹ it gives F_e: doc/theory.md (1.3).
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Tensor<2, dim>    f     = field.step_deformation(splines);
        const Tensor<2, dim>    F_e   = f * states[p].A;
        const double            det_f = determinant(f);
        if (!system.admits(det_f, determinant(F_e), points.xi[p]))
          return false;
        visit(SpatialGradients<dim>(splines, invert(f)),
              ElasticPoint<dim>(F_e, points.lame_of(p), *points.material),
              states[p].W,
              points.carried.empty() ? 0. : points.carried[p],
              det_f);
      }
    return true;
  }

  template <int dim>
  bool
  InternalForce<dim>::add_forces(const Range           &range,
                                 const LocalField<dim> &field,
                                 const GrowthAt         growth,
                                 PoolVolume<dim>       *volume,
                                 LocalSystem<dim>      &system) const
  {
    return for_each_point(
      range,
      field,
      growth,
      system,
      [&](const SpatialGradients<dim> &gradients,
          const ElasticPoint<dim>     &state,
          const double                 W,
          const double                 c,
          const double                 det_f) {
        const auto &response = state.response();
        // Without a pool the law acts as a whole.
        if (volume == nullptr)
          {
            add_stress(gradients, W * state.kirchhoff_stress(), system);
            system.add_energy(W * state.energy(), W * state.energy_magnitude());
            return;
          }
        // With one, only the distortional part does; add() adds the volumetric
        // part once the pool's volume is known.
        add_stress(gradients, W * state.distortional_stress(), system);
        system.add_energy(W * response.energy, W * response.magnitude);
        const double weight = volume->pressed() ? c : c * det_f;
        volume->v += volume->pressed() ? c * std::log(det_f) : weight;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            volume->gradients[i][a] += weight * gradients.g[i][a];
      });
  }

  template <int dim>
  bool
  InternalForce<dim>::add_tangent(const Range           &range,
                                  const LocalField<dim> &field,
                                  const GrowthAt         growth,
                                  const PressureOfPool  *pressure,
                                  LocalSystem<dim>      &system) const
  {
    // The upper blocks are summed in an array of their own, since the matrix
    // may already hold terms that are not symmetric. A point that is inverted
    // leaves the matrix as it was. The pressure of a pool acts on the volume
    // that a point carries, in A and in γ: doc/theory.md (2.8).
    std::vector<double> upper(system.matrix.size(), 0.);
    const bool          coupled = points.material->coupled();
    const bool          valid =
      for_each_point(range,
                     field,
                     growth,
                     system,
                     [&](const SpatialGradients<dim> &gradients,
                         const ElasticPoint<dim>     &state,
                         const double                 W,
                         const double                 c,
                         const double                 det_f) {
                       const auto  &r      = state.response();
                       const bool   pooled = pressure != nullptr;
                       const double A      = pooled ? r.A : r.total_A(),
                                    gamma  = pooled ? r.gamma : r.total_gamma();
                       double of_A = 0., of_gamma = 0.;
                       if (pooled)
                         {
                           of_gamma = pressure->mean_stress * c *
                                      (pressure->pressed ? 1. : det_f);
                           of_A = pressure->pressed ? 0. : of_gamma;
                         }
                       add_blocks(gradients,
                                  state.b(),
                                  {W * A + of_A,
                                   W * (r.alpha - gamma) - of_gamma,
                                   W * r.alpha,
                                   W * r.B,
                                   W * r.C},
                                  coupled,
                                  upper.data());
                     });
    if (valid)
      add_lower_blocks<dim>(upper, system.matrix);
    return valid;
  }

  template <int dim>
  void
  InternalForce<dim>::add_tangent_of_pool(const Pool            &pool,
                                          const LocalField<dim> &field,
                                          const GrowthAt         growth,
                                          LocalSystem<dim>      &system) const
  {
    // The volume comes first, since the tangent at the points needs the
    // pressure. ϑ is what the last tangent foresaw, if there was one; see the
    // class. After the points' part the product V_a V_b completes doc/theory.md
    // (2.8).
    const PoolVolume<dim> volume =
      with_points(volume_without_points(pool, growth), pool, field, growth);
    const std::size_t        ordinal = system.linearisations.size();
    const double             theta   = system.last != nullptr ?
                                         (*system.last)[ordinal].at(field) :
                                         volume.theta(grown(pool, growth));
    const Volumetric<double> U =
      pool_energy(points.pools, pool, growth, theta, *points.material).U;
    const PressureOfPool pressure = volume.pressure(U);
    if (!add_tangent({pool.first, pool.last}, field, growth, &pressure, system))
      return;
    volume.add_tangent(U, system);
    // The next residual has the growth at t + dt, so the linearisation starts
    // from ϑ with that growth, also where this tangent has the growth at t.
    system.linearisations.push_back(
      {field,
       volume.derivative(),
       volume.theta(grown(pool, GrowthAt::current))});
  }

  template <int dim>
  void
  InternalForce<dim>::add(const unsigned int     grid_cell,
                          const LocalField<dim> &field,
                          const GrowthAt         growth,
                          LocalSystem<dim>      &system) const
  {
    const bool wants_tangent = system.wanted == LocalSystem<dim>::tangent;
    if (form == VolumetricStrain::pointwise)
      {
        // No pool is asked for: one pass over the points does all.
        const Range all{points.offsets[grid_cell],
                        points.offsets[grid_cell + 1]};
        if (wants_tangent)
          add_tangent(all, field, growth, nullptr, system);
        else
          add_forces(all, field, growth, nullptr, system);
        return;
      }
    const Pools &pools = points.pools;
    for (unsigned int k = pools.offsets[grid_cell];
         k < pools.offsets[grid_cell + 1];
         ++k)
      {
        const Pool &pool = pools.list[k];
        if (wants_tangent)
          {
            add_tangent_of_pool(pool, field, growth, system);
            continue;
          }
        // The points' pass leaves the sums; then the volumetric part is one
        // force for the whole pool.
        PoolVolume<dim> volume = volume_without_points(pool, growth);
        if (add_forces({pool.first, pool.last}, field, growth, &volume, system))
          volume.add_forces(pool_energy(pools,
                                        pool,
                                        growth,
                                        volume.theta(grown(pool, growth)),
                                        *points.material)
                              .U,
                            system);
      }
  }

  template class InternalForce<2>;
  template class InternalForce<3>;
} // namespace Morula
