// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fields/field_equation.h>
#include <morula/effects/fields/spline_moments.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
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

    /** Takes what a cell loses by the diffusion of the known field. */
    template <int dim>
    void
    add_diffusion(const FieldAtCell        &cell,
                  const SplineValues<dim>  &splines,
                  const LocalField<dim, 1> &known,
                  LocalEquations<dim, 1>   &local)
    {
      const Tensor<1, dim> gradient = known.gradients(splines)[0];
      const auto flux = along(cell.volume * cell.diffusion * gradient, splines);
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        local.add_force(0, a, -flux[a]);
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
                          (flux + point.inflow) * splines.value[a]);
    }
  } // namespace


  template <int dim>
  bool
  FieldEquation<dim>::operator()(const unsigned int c,
                                 const Known       &known,
                                 Local             &local) const
  {
    const bool is_matrix = local.wanted == Local::tangent;
    if (is_matrix)
      add_cells_matrix(c, local);
    else
      add_cells_load(c, known, local);
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
  FieldEquation<dim>::add_cells_matrix(const unsigned int c, Local &local) const
  {
    MatrixMoments<dim> moments;
    for (unsigned int p = cell_places.offsets[c];
         p < cell_places.offsets[c + 1];
         ++p)
      moments.add(cell_places.xi[p],
                  {{cells[p].volume * cells[p].diffusion,
                    cells[p].volume * cells[p].rate}});
    add_matrix(moments, cell_places.h, lumped[c], local.matrix);
  }


  template <int dim>
  void
  FieldEquation<dim>::add_cells_load(const unsigned int c,
                                     const Known       &known,
                                     Local             &local) const
  {
    const auto      &coefficients = known.coefficient[0];
    const bool       is_zero      = std::all_of(std::begin(coefficients),
                                     std::end(coefficients),
                                     [](const double u) { return u == 0.; });
    LoadMoments<dim> moments;
    for (unsigned int p = cell_places.offsets[c];
         p < cell_places.offsets[c + 1];
         ++p)
      {
        moments.add(cell_places.xi[p], {{cells[p].volume * cells[p].load}});
        if (!is_zero)
          add_diffusion(cells[p],
                        SplineValues<dim>(cell_places.xi[p], cell_places.h),
                        known,
                        local);
      }
    const auto loads = spline_sums(moments);
    for (unsigned int a = 0; a < loads.size(); ++a)
      local.add_force(0, a, loads[a]);
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
