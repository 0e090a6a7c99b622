// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/enclosure.h>

#include <array>

namespace Morula
{
  namespace
  {
    /**
     * The volume between an area and where the step moves it, and its
     * derivatives: ψ = u · [A + (tr H A - Hᵀ A)/2 + cof H A/3], where u is the
     * displacement, H its gradient and A the area vector before the step.
     */
    template <int dim>
    struct Prism
    {
      Tensor<1, dim> A, u;
      Tensor<2, dim> H;

      /** cof H A, which in 2-D belongs to no area. */
      Tensor<1, dim>
      cofactor() const
      {
        Tensor<1, dim> c;
        if constexpr (dim == 3)
          for (unsigned int i = 0; i < dim; ++i)
            c[i] = cross_product_3d(H[(i + 1) % 3], H[(i + 2) % 3]) * A;
        return c;
      }

      /** ∂ψ/∂u: ψ is u times it. */
      Tensor<1, dim>
      mean_area() const
      {
        return A + 0.5 * (trace(H) * A - A * H) + cofactor() / 3.;
      }

      /** H (A × g). */
      Tensor<1, dim>
      turned(const Tensor<1, dim> &g) const
      {
        if constexpr (dim == 3)
          return H * cross_product_3d(A, g);
        else
          return Tensor<1, dim>();
      }

      /** ∂ψ/∂H : (e_i ⊗ g) as a vector of i. */
      Tensor<1, dim>
      by_gradient(const Tensor<1, dim> &g) const
      {
        Tensor<1, dim> result = 0.5 * ((u * A) * g - (u * g) * A);
        if constexpr (dim == 3)
          result += cross_product_3d(turned(g), u) / 3.;
        return result;
      }

      /** The change of component i of mean_area() with H_j· = g. */
      Tensor<2, dim>
      change_of_area(const Tensor<1, dim> &g) const
      {
        Tensor<2, dim>       M;
        const Tensor<1, dim> w = turned(g) / 3.;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            M[i][j] = 0.5 * (A[i] * g[j] - A[j] * g[i]);
        if constexpr (dim == 3)
          for (unsigned int i = 0; i < dim; ++i)
            {
              const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
              M[i][j] += w[k];
              M[j][i] -= w[k];
            }
        return M;
      }

      /** ∂²ψ/∂H² : (e_i ⊗ g) : (e_j ⊗ k) is ε_ijl times component l of it. */
      Tensor<1, dim>
      by_gradients(const Tensor<1, dim> &g, const Tensor<1, dim> &k) const
      {
        if constexpr (dim == 3)
          return (A * cross_product_3d(g, k)) / 3. * u;
        else
          return Tensor<1, dim>();
      }
    };


    template <int dim>
    void
    add_tangent(const Prism<dim>                                  &prism,
                const SplineValues<dim>                           &splines,
                const std::array<Tensor<1, dim>, BSpline<dim>::n> &g,
                LocalSystem<dim>                                  &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      // The second derivative of ψ has two kinds of parts. Displacement with
      // gradient: N_a with the change of area by g_b, and the reverse. Gradient
      // with gradient, in 3-D only: an antisymmetric block for each pair. Both
      // enter with a minus sign, as the normals point into the space.
      std::array<Tensor<2, dim>, n> M;
      for (unsigned int a = 0; a < n; ++a)
        M[a] = prism.change_of_area(g[a]);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          {
            Tensor<2, dim> block =
              splines.value[a] * M[b] + splines.value[b] * transpose(M[a]);
            const Tensor<1, dim> both = prism.by_gradients(g[a], g[b]);
            if constexpr (dim == 3)
              for (unsigned int i = 0; i < dim; ++i)
                {
                  const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
                  block[i][j] += both[k];
                  block[j][i] -= both[k];
                }
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                system.matrix[(i * n + a) * n_dofs + j * n + b] -= block[i][j];
          }
    }
  } // namespace


  template <int dim>
  void
  SweptVolume<dim>::add_point(const unsigned int       p,
                              const SplineValues<dim> &splines,
                              const LocalField<dim>   &field,
                              LocalSystem<dim>        &system) const
  {
    // Gradients here are those of the configuration at t, as doc/theory.md
    // (4.8h) integrates from there to u, unlike those of other terms.
    constexpr unsigned int        n = BSpline<dim>::n;
    std::array<Tensor<1, dim>, n> g;
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int k = 0; k < dim; ++k)
        g[a][k] = splines.gradient[k][a];
    Prism<dim> prism{areas[p], field.value(splines), Tensor<2, dim>()};
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        prism.H[i] += field.coefficient[i][a] * g[a];
    if (system.wanted == LocalSystem<dim>::tangent)
      {
        add_tangent(prism, splines, g, system);
        return;
      }
    // Areas point out of the tissue, that is into the space: where they move
    // along their normals, the space gets smaller.
    const Tensor<1, dim> area = prism.mean_area();
    system.add_energy(-(prism.u * area));
    for (unsigned int a = 0; a < n; ++a)
      {
        const Tensor<1, dim> force =
          splines.value[a] * area + prism.by_gradient(g[a]);
        for (unsigned int i = 0; i < dim; ++i)
          system.add_force(i, a, -force[i]);
      }
  }


  template class SweptVolume<2>;
  template class SweptVolume<3>;
} // namespace Morula
