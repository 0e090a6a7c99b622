// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fields/field_equation.h>
#include <morula/mechanics/spline_moments.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** Penalty of fixed values in units of D/h: the least one of the mechanical
     *  conditions, doc/theory.md (4.6). */
    constexpr double penalty = 20.;

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
               const double               weight,
               const SplineValues<dim>   &splines,
               std::vector<double>       &matrix)
    {
      constexpr unsigned int n     = BSpline<dim>::n;
      const auto            &N     = splines.value;
      const auto             slope = along(point.flux, splines);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          matrix[a * n + b] +=
            weight * N[a] * N[b] - slope[a] * N[b] - N[a] * slope[b];
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
             const double               weight,
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
                        (weight * splines.value[a] - slope[a]) * gap +
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
        const double            w = weight(c, surface[p]);
        if (is_matrix)
          add_matrix(surface[p], w, splines, local.matrix);
        else
          add_load(surface[p], w, splines, known, local);
      }
    return true;
  }


  template <int dim>
  double
  FieldEquation<dim>::sink() const
  {
    double sum = 0.;
    for (const FieldAtCell &cell : cells)
      sum += cell.volume * cell.rate;
    for (const FieldAtSurface<dim> &point : surface)
      sum += point.weight + point.fixed;
    return sum;
  }


  template <int dim>
  bool
  FieldEquation<dim>::has_fixed_value() const
  {
    return std::any_of(surface.begin(), surface.end(), [](const auto &point) {
      return point.fixed > 0.;
    });
  }


  template <int dim>
  double
  FieldEquation<dim>::weight(const unsigned int         c,
                             const FieldAtSurface<dim> &point) const
  {
    const double of_grid = raised * penalty / surface_places.h;
    return point.weight +
           point.fixed *
             (steepness.empty() ? of_grid : std::hypot(of_grid, steepness[c]));
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
    add_matrix(moments,
               cell_places.h,
               !lumped.empty() && lumped[c],
               local.matrix);
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
  find_steepness(FieldEquation<dim> &equation)
  {
    const GroupedPoints<dim> &places = equation.cell_places;
    equation.steepness.assign(places.offsets.size() - 1, 0.);
    for (unsigned int c = 0; c + 1 < places.offsets.size(); ++c)
      {
        double rate = 0., diffusion = 0.;
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          {
            const FieldAtCell &cell = equation.cells[p];
            rate += cell.volume * cell.rate;
            diffusion += cell.volume * cell.diffusion;
          }
        // Without diffusion nothing comes from the surface.
        if (diffusion > 0.)
          equation.steepness[c] = std::sqrt(rate / diffusion);
      }
  }


  template <int dim>
  void
  mark_lumped(FieldEquation<dim> &equation)
  {
    const double n_lengths = equation.cell_places.h / std::sqrt(6.);
    for (unsigned int c = 0; c < equation.lumped.size(); ++c)
      {
        bool is_fixed = false;
        if (!equation.surface.empty())
          for (unsigned int p = equation.surface_places.offsets[c];
               p < equation.surface_places.offsets[c + 1];
               ++p)
            is_fixed = is_fixed || equation.surface[p].fixed > 0.;
        if (!is_fixed && equation.steepness[c] * n_lengths > 1.)
          equation.lumped[c] = true;
      }
  }


#define INSTANTIATE(dim)                           \
  template struct FieldEquation<dim>;              \
  template void mark_lumped(FieldEquation<dim> &); \
  template void find_steepness(FieldEquation<dim> &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
