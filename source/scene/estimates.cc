// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/estimates.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    // The constants below were fitted to runs of the first scenes of the table
    // "estimates" of doc/performance.md; contrib/upkeep/benchmark estimates
    // measures them anew. The seconds are those of one core of the processor
    // that the text there names, as explain.cc does: others differ by a factor
    // of two or so. The exponents of the direct solver are those of nested
    // dissection.

    /** Bytes of a run with @p n_cells cells and @p n equations, on one rank. */
    template <int dim>
    double
    memory(const Scene &scene, const double n_cells, const double n)
    {
      constexpr double program = 180e6;
      // A cell has its position, reference position, id and place in the grid,
      // which are about 200 bytes, and its columns. The factor is for what a
      // step makes of them.
      const double cell =
        (dim == 2 ? 2.7 : 2.3) *
        (8. * effects_of<dim>(scene).columns.n_numbers() + 200.);
      // A row couples with 5^dim splines, at 12 bytes an entry. The factor is
      // for the matrix, the preconditioner and the positions of the entries.
      const double row     = 2.6 * 12. * dim * std::pow(5., dim);
      const double factors = scene.solver.linear_solver != "direct" ? 0. :
                             dim == 2 ? 370. * n * std::log(n) :
                                        1000. * std::pow(n, 4. / 3.);
      // Boundary points hold less than cells; without a wished number they are
      // fewer, too.
      return program + (n_cells + scene.tissue.boundary_points) * cell +
             n * row + factors;
    }

    /** Whether anything but the clamps acts on the tissue. */
    template <int dim>
    bool
    is_driven(const Scene &scene)
    {
      const SceneEffects<dim> effects = effects_of<dim>(scene);
      return scene.has_active_tissue() || !effects.forces.empty() ||
             std::any_of(effects.conditions.begin(),
                         effects.conditions.end(),
                         [](const auto &named) {
                           return named.condition->moves();
                         });
    }

    /** Seconds of a step of one core with @p n_cells cells, @p n equations. */
    template <int dim>
    double
    step_seconds(const Scene &scene, const double n_cells, const double n)
    {
      // A step without anything that drives it only updates its cells. Else
      // each iteration of Newton's method goes over all quadrature points, all
      // equations and, with a direct solver, the factors.
      if (!is_driven<dim>(scene))
        return 2e-6 * n_cells;
      constexpr double newton_iterations = 4.;
      const bool       is_projected =
        scene.material.volumetric_form() != VolumetricStrain::pointwise;
      const double n_points =
        n_cells * std::pow(scene.grid.points_per_cell.value(), dim);
      const double point    = dim == 2 ? (is_projected ? 0.8e-6 : 0.6e-6) :
                                         (is_projected ? 0.6e-6 : 0.5e-6);
      const double equation = dim == 2 ? 4e-6 : 26e-6;
      const double factors  = scene.solver.linear_solver != "direct" ? 0. :
                              dim == 2 ? 2e-7 * std::pow(n, 1.5) :
                                         6e-8 * n * n;
      return newton_iterations * (n_points * point + n * equation + factors);
    }

    /** Seconds of a step of one core for each cell, of effects that say so. */
    template <int dim>
    std::map<std::string, double>
    seconds_of_effects(const Scene &scene)
    {
      const SceneEffects<dim>       effects = effects_of<dim>(scene);
      std::map<std::string, double> seconds;
      for (const auto &[name, effect] : effects.step_effects)
        if (const double of_one = effect->seconds_per_cell(); of_one > 0.)
          seconds[name] = of_one;
      // Transitions that see neighbours find them within the step.
      if (effects.development.neighbours)
        seconds["transitions"] =
          effects.development.neighbours->seconds_per_cell(dim);
      return seconds;
    }

    /** Equations of a compact tissue of this volume. */
    double
    n_equations(const Scene &scene, const double volume)
    {
      // A cube of this volume is covered by splines: its edge in grid spacings
      // plus two, since quadratic B-splines reach out by one on either side.
      const double dim = scene.dimension;
      return dim *
             std::pow(std::pow(volume, 1. / dim) / scene.grid.spacing + 2.,
                      dim);
    }
  } // namespace


  double
  estimated_memory(const Scene &scene, const SceneSize &size)
  {
    const double n = n_equations(scene, size.volume);
    return scene.dimension == 2 ? memory<2>(scene, size.cells, n) :
                                  memory<3>(scene, size.cells, n);
  }


  template <int dim>
  SizeEstimate
  estimated_size(const Scene                 &scene,
                 const Founders<dim>         &founders,
                 const MPI_Comm               comm,
                 const unsigned int           n_unknowns,
                 const std::optional<double> &free_growth,
                 const double                 cells_per_founder)
  {
    // The number of equations is estimated for the beginning and the end, and
    // scaled if the true one is known. Then memory is that of the end, and the
    // time is that of a mean step.
    SceneSize last = expected_size(scene, founders.positions, comm);
    last.volume *= free_growth.value_or(1.);
    if (cells_per_founder > 0.)
      last.cells = cells_per_founder * founders.n_global;
    const double first_volume =
      founders.n_global * std::pow(scene.tissue.cell_spacing.value(), dim);

    SizeEstimate size;
    size.cells = last.cells;
    size.unknowns_at_start =
      n_unknowns > 0 ? n_unknowns : n_equations(scene, first_volume);
    size.unknowns = size.unknowns_at_start * n_equations(scene, last.volume) /
                    n_equations(scene, first_volume);
    // The slack keeps a quotient like 10.0000000001 from counting as eleven
    // steps.
    size.steps  = std::ceil(scene.time.end_time / scene.time.step - 1e-9);
    size.memory = memory<dim>(scene, size.cells, size.unknowns);

    // This is the mean over a time in which a number grows exponentially from a
    // to b. Where both are nearly equal the quotient loses its digits.
    const auto mean = [](const double a, const double b) {
      return std::abs(b - a) < 1e-3 * a ? a : (b - a) / std::log(b / a);
    };
    const double n_cells = mean(founders.n_global, size.cells);
    size.seconds         = size.steps * step_seconds<dim>(scene,
                                                  n_cells,
                                                  mean(size.unknowns_at_start,
                                                       size.unknowns));
    for (const auto &[name, of_one] : seconds_of_effects<dim>(scene))
      {
        size.of_effects[name] = size.steps * n_cells * of_one;
        size.seconds += size.of_effects[name];
      }
    return size;
  }


  template SizeEstimate
  estimated_size(const Scene &,
                 const Founders<2> &,
                 const MPI_Comm,
                 const unsigned int,
                 const std::optional<double> &,
                 const double);
  template SizeEstimate
  estimated_size(const Scene &,
                 const Founders<3> &,
                 const MPI_Comm,
                 const unsigned int,
                 const std::optional<double> &,
                 const double);
} // namespace Morula
