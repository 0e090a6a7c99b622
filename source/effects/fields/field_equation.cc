// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fields/field_equation.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/spline_moments.h>

#include <deal.II/base/mpi.h>

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

    /** What a boundary point adds: w N_a N_b - a D (∂N_a/∂n N_b + N_a ∂N_b/∂n),
     *  doc/theory.md (11.3). */
    template <int dim>
    void
    add_matrix(const FieldAtSurface<dim> &point,
               const double               weight,
               const SplineValues<dim>   &splines,
               std::vector<double>       &matrix)
    {
      constexpr unsigned int n = BSpline<dim>::n;
      // Only a fixed point has a flux; for a transfer `slope` is zero.
      const auto &N     = splines.value;
      const auto  slope = along(point.flux, splines);
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
      // This is -V D ∇N_a · ∇c* of doc/theory.md (11.2).
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
      // The known field is moved to the right: what is sought makes up for the
      // gap between the prescribed value and the known one.
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
    // One functor makes both sides of doc/theory.md (11.2): the matrix if the
    // assembly asks for a tangent, else the load. First come the cells of the
    // grid cell, then its boundary points.
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
  FieldEquation<dim>::weight(const unsigned int         c,
                             const FieldAtSurface<dim> &point) const
  {
    // The penalty w of doc/theory.md (11.3): the larger of what the grid asks
    // for and what the layer in which the field falls off does, as a root of
    // squares.
    const double of_grid = raised * penalty / surface_places.h;
    return point.weight +
           point.fixed *
             (steepness.empty() ? of_grid : std::hypot(of_grid, steepness[c]));
  }


  template <int dim>
  void
  FieldEquation<dim>::add_cells_matrix(const unsigned int c, Local &local) const
  {
    // All products of splines follow from the moments of the cells,
    // doc/theory.md (11.6).
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
    // A field that is sought as a whole has no known part, and its gradients
    // need not be evaluated.
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
    // This is κ of doc/theory.md (11.3), from the means of each grid cell.
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
        // Without diffusion nothing comes from the surface, so there is no
        // layer.
        if (diffusion > 0.)
          equation.steepness[c] = std::sqrt(rate / diffusion);
      }
  }


  template <int dim>
  void
  mark_lumped(FieldEquation<dim> &equation)
  {
    // The rule is k h² > 6 D, doc/theory.md, section 11.3, here by the
    // steepness sqrt(k/D). Grid cells with a fixed value are left as they are.
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


  MORULA_INSTANTIATE(mark_lumped);
  MORULA_INSTANTIATE(find_steepness);
  template struct FieldEquation<2>;
  template struct FieldEquation<3>;


  namespace
  {
    /** What the cells of one grid cell have: weights times values. */
    struct Content
    {
      /** The content of its positive values. */
      double positive = 0.;
      /** What its negative values lack and others must give. */
      double missing = 0.;

      /** Takes as much of the positive ones as there is. */
      void
      take(const double amount)
      {
        missing  = std::max(0., amount - positive);
        positive = std::max(0., positive - amount);
      }
    };

    /** The contents by grid cell, after each has made up for its own negative
     *  values. */
    template <int dim>
    std::vector<Content>
    contents(const std::vector<double> &values,
             const std::vector<double> &weights,
             const GroupedPoints<dim>  &places,
             std::uint64_t             &n_negative)
    {
      std::vector<Content> result(places.offsets.size() - 1);
      for (unsigned int c = 0; c < result.size(); ++c)
        {
          // Negative values are made up for from the positive ones of the same
          // grid cell first: that is what keeps the correction local.
          double negative = 0.;
          for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1];
               ++p)
            {
              const double amount = weights[p] * values[p];
              if (values[p] < 0.)
                {
                  negative -= amount;
                  ++n_negative;
                }
              else
                result[c].positive += amount;
            }
          result[c].take(negative);
        }
      return result;
    }

    /** Lets grid cells give to those with the same splines, in equal shares to
     *  each spline. @return what is still missing on all ranks */
    template <int dim>
    double
    give_to_neighbors(std::vector<Content>   &contents,
                      const SplineSpace<dim> &space,
                      const MPI_Comm          comm)
    {
      // Each grid cell asks its splines for what it lacks, and offers what it
      // has, in equal shares. A spline adds up both over all grid cells that
      // use it, on all ranks, and takes that part of what is there. Every grid
      // cell then gives the mean of its splines' parts.
      const FieldUnknowns<dim, 1> unknowns(space, comm);
      const unsigned int          n = unknowns.relevant().n_elements();
      std::vector<double>         wanted(n, 0.), there(n, 0.);
      for (unsigned int c = 0; c < contents.size(); ++c)
        for (const auto s : space.grid_cells()[c].unknowns)
          {
            const double n_splines = space.grid_cells()[c].unknowns.size();
            wanted[s] += contents[c].missing / n_splines;
            there[s] += contents[c].positive / n_splines;
          }
      // First what is wanted by each spline, then the part of what is there
      // that is taken.
      auto       taken     = unknowns.sum(wanted);
      const auto of_spline = unknowns.sum(there);
      double     missing   = 0.;
      for (const auto s : unknowns.owned())
        {
          // A spline with too little gives all of it, and the rest is missing.
          const double wants = taken[s], has = of_spline[s];
          missing += std::max(0., wants - has);
          taken[s] = wants >= has ? (has > 0. ? 1. : 0.) : wants / has;
        }
      const std::vector<double> parts = unknowns.fetch(taken);
      for (unsigned int c = 0; c < contents.size(); ++c)
        {
          double part = 0.;
          for (const auto s : space.grid_cells()[c].unknowns)
            part += parts[s];
          contents[c].positive *=
            std::max(0., 1. - part / space.grid_cells()[c].unknowns.size());
        }
      return Utilities::MPI::sum(missing, comm);
    }

    /** Lets all grid cells give. */
    void
    give_to_all(std::vector<Content> &contents,
                const double          missing,
                const MPI_Comm        comm)
    {
      // What is still missing after that is shared by all grid cells in
      // proportion to what they have.
      double positive = 0.;
      for (const Content &content : contents)
        positive += content.positive;
      positive = Utilities::MPI::sum(positive, comm);
      const double factor =
        missing >= positive ? 0. : (positive - missing) / positive;
      for (Content &content : contents)
        content.positive *= factor;
    }
  } // namespace


  template <int dim>
  std::uint64_t
  keep_positive(std::vector<double>       &values,
                const std::vector<double> &weights,
                const GroupedPoints<dim>  &places,
                const SplineSpace<dim>    &space,
                const MPI_Comm             comm)
  {
    // The balance goes grid cell by grid cell, then by splines, then over all
    // of the tissue: doc/theory.md, section 11.3. `after` holds what each grid
    // cell is to have; only in the end values change, by one factor in each
    // grid cell, which keeps their proportions. In most steps nothing is
    // negative, and one reduction shows it.
    std::uint64_t        n_negative = 0;
    std::vector<Content> after = contents(values, weights, places, n_negative);
    n_negative                 = Utilities::MPI::sum(n_negative, comm);
    if (n_negative == 0)
      return 0;
    double missing = 0.;
    for (const Content &content : after)
      missing += content.missing;
    if (Utilities::MPI::sum(missing, comm) > 0.)
      {
        missing = give_to_neighbors(after, space, comm);
        if (missing > 0.)
          give_to_all(after, missing, comm);
      }
    for (unsigned int c = 0; c < after.size(); ++c)
      {
        double before = 0.;
        for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1]; ++p)
          {
            // Cells with a weight of 0, as in a field that still iterates, are
            // only set to zero.
            values[p] = std::max(0., values[p]);
            before += weights[p] * values[p];
          }
        if (after[c].positive < before)
          for (unsigned int p = places.offsets[c]; p < places.offsets[c + 1];
               ++p)
            if (weights[p] > 0.)
              values[p] *= after[c].positive / before;
      }
    return n_negative;
  }


  MORULA_INSTANTIATE(keep_positive);
} // namespace Morula
