// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_cell_growth_h
#define morula_effects_growth_cell_growth_h

#include <morula/effects/growth/isotropic.h>
#include <morula/effects/proliferation/cell_cycle.h>
#include <morula/particles/tissue.h>

#include <optional>
#include <vector>

namespace Morula
{
  /** F_g of all cells of a rank over one step, in the order of
   *  Tissue::cells(). */
  template <int dim>
  struct GrowthOfStep
  {
    bool                        present = false; // else the lists are empty
    std::vector<Tensor<2, dim>> previous;        // at t
    std::vector<Tensor<2, dim>> current;         // at t + dt
  };

  /**
   * All that makes cells grow: the growth law, the cell cycle, or both:
   * F_g = θ F_g,cycle. Knows nothing of the mechanics.
   */
  template <int dim>
  class CellGrowth
  {
  public:
    CellGrowth(std::optional<IsotropicGrowth> isotropic,
               std::optional<CellCycle<dim>>  cycle);

    /** Whether anything grows. */
    bool
    present() const;

    /** The cell cycle, or null. */
    const CellCycle<dim> *
    cycle() const;

    /** Sets a founder's growth slots, at t = 0. */
    void
    initialize(const types::particle_index  id,
               const CellView<dim, double> &cell) const;

    /** The trial growth over (t0, t1]. */
    GrowthOfStep<dim>
    of_step(const Tissue<dim> &tissue, const double t0, const double t1) const;

    /**
     * Commits the growth of one cell whose F is still that at t0.
     * @param F_g the cell's GrowthOfStep::current
     */
    void
    commit(const CellView<dim, double> &cell,
           const double                 t0,
           const double                 t1,
           const Tensor<2, dim>        &F_g) const;

  private:
    /** F_g at t1 of a cell in its state at t0. */
    template <typename Number>
    Tensor<2, dim>
    growth(const CellView<dim, Number> &cell,
           const double                 t0,
           const double                 t1) const;

    std::optional<IsotropicGrowth> isotropic;
    std::optional<CellCycle<dim>>  cycle_;
  };
} // namespace Morula

#endif
