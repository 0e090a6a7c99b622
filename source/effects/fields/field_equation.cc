// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fields/field_equation.h>

namespace Morula
{
  namespace
  {
    /** Adds V (D ∇N_a·∇N_b + k N_a N_b), or with the last term lumped. */
    template <int dim>
    void
    add_matrix(const FieldAtCell       &cell,
               const SplineValues<dim> &splines,
               const bool               lumped,
               std::vector<double>     &matrix)
    {
      constexpr unsigned int n    = BSpline<dim>::n;
      const double           rate = cell.volume * cell.rate;
      const double           D    = cell.volume * cell.diffusion;
      // The gradients, and last the values where they are not lumped: each row
      // is read and written once.
      const double *factors[dim + 1];
      for (unsigned int d = 0; d < dim; ++d)
        factors[d] = splines.gradient[d];
      factors[dim]           = splines.value;
      const double of_values = lumped ? 0. : rate;
      for (unsigned int a = 0; a < n; ++a)
        {
          double *const row = &matrix[a * n];
          double        of[dim + 1];
          for (unsigned int d = 0; d < dim; ++d)
            of[d] = D * factors[d][a];
          of[dim] = of_values * factors[dim][a];
          // Symmetric: complete() fills the rest.
          for (unsigned int b = 0; b <= a; ++b)
            {
              double sum = 0.;
              for (unsigned int d = 0; d <= dim; ++d)
                sum += of[d] * factors[d][b];
              row[b] += sum;
            }
          if (lumped)
            row[a] += rate * splines.value[a];
        }
    }

    /** The upper triangle of the cells' symmetric matrix from the lower one. */
    template <int dim>
    void
    complete(std::vector<double> &matrix)
    {
      constexpr unsigned int n = BSpline<dim>::n;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < a; ++b)
          matrix[b * n + a] = matrix[a * n + b];
    }

    /** g·∇N_a of all splines. */
    template <int dim>
    std::array<double, BSpline<dim>::n>
    along(const Tensor<1, dim> &g, const SplineValues<dim> &splines)
    {
      std::array<double, BSpline<dim>::n> result{};
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          result[a] += g[d] * splines.gradient[d][a];
      return result;
    }

    /** Of a boundary point: w N_a N_b - a D (∂N_a/∂n N_b + N_a ∂N_b/∂n). */
    template <int dim>
    void
    add_matrix(const FieldAtSurface<dim> &point,
               const SplineValues<dim>   &splines,
               std::vector<double>       &matrix)
    {
      constexpr unsigned int n     = BSpline<dim>::n;
      const auto            &N     = splines.value;
      const auto             slope = along(point.flux, splines);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          matrix[a * n + b] +=
            point.weight * N[a] * N[b] - slope[a] * N[b] - N[a] * slope[b];
    }

    template <int dim>
    void
    add_load(const FieldAtCell        &cell,
             const SplineValues<dim>  &splines,
             const LocalField<dim, 1> &known,
             LocalEquations<dim, 1>   &local)
    {
      const Tensor<1, dim> gradient = known.gradients(splines)[0];
      const auto flux = along(cell.volume * cell.diffusion * gradient, splines);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        local.add_force(0,
                        a,
                        cell.volume * cell.load * splines.value[a] - flux[a]);
    }

    template <int dim>
    void
    add_load(const FieldAtSurface<dim> &point,
             const SplineValues<dim>   &splines,
             const LocalField<dim, 1>  &known,
             LocalEquations<dim, 1>    &local)
    {
      const auto   slope = along(point.flux, splines);
      const double gap   = point.value - known.value(splines)[0];
      const double flux  = point.flux * known.gradients(splines)[0];
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        local.add_force(0,
                        a,
                        (point.weight * splines.value[a] - slope[a]) * gap +
                          flux * splines.value[a]);
    }
  } // namespace


  template <int dim>
  bool
  FieldEquation<dim>::operator()(const unsigned int c,
                                 const Known       &known,
                                 Local             &local) const
  {
    const bool is_matrix = local.wanted == Local::tangent;
    for (unsigned int p = cell_places.offsets[c];
         p < cell_places.offsets[c + 1];
         ++p)
      {
        const SplineValues<dim> splines(cell_places.xi[p], cell_places.h);
        if (is_matrix)
          add_matrix(cells[p], splines, lumped[c], local.matrix);
        else
          add_load(cells[p], splines, known, local);
      }
    if (is_matrix)
      complete<dim>(local.matrix);
    if (surface.empty())
      return true;
    for (unsigned int p = surface_places.offsets[c];
         p < surface_places.offsets[c + 1];
         ++p)
      {
        const SplineValues<dim> splines(surface_places.xi[p], surface_places.h);
        if (is_matrix)
          add_matrix(surface[p], splines, local.matrix);
        else
          add_load(surface[p], splines, known, local);
      }
    return true;
  }


  template <int dim>
  void
  mark_lumped(FieldEquation<dim> &equation, const double dt)
  {
    const GroupedPoints<dim> &places = equation.cell_places;
    const double              h2     = places.h * places.h;
    for (unsigned int c = 0; c + 1 < places.offsets.size(); ++c)
      {
        double volume = 0., rate = 0., diffusion = 0.;
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          {
            const FieldAtCell &cell = equation.cells[p];
            volume += cell.volume;
            rate += cell.volume * cell.rate;
            diffusion += cell.volume * cell.diffusion;
          }
        if (dt > 0.)
          rate += volume / dt;
        if (rate * h2 > 6. * diffusion)
          equation.lumped[c] = true;
      }
  }


#define INSTANTIATE(dim)              \
  template struct FieldEquation<dim>; \
  template void mark_lumped(FieldEquation<dim> &, const double);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
