// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// An equation on the grid: cells that share a grid cell share what they have
// of something. Its amount stays.

#ifndef own_effects_sharing_h
#define own_effects_sharing_h

#include <morula/base/expression_key.h>
#include <morula/effects/equation.h>

namespace Own
{
  using namespace Morula;

  struct SharingKeys : public EffectKeys
  {
    ExpressionKey initial{{this, "Initial"},
                          "0",
                          "Of a founder, per volume. An expression of X, Y, Z.",
                          Evaluated::founder};

    bool
    is_on() const override
    {
      return !initial.is_default();
    }
  };

  template <int dim>
  class SharingInRun : public EquationInRun<dim>
  {
  public:
    explicit SharingInRun(const Column<double> &density)
      : density(density)
    {}

    void
    settle(Tissue<dim> &tissue, const SplineSpace<dim> &, const double) override
    {
      const Cells<dim> &cells = tissue.cells();
      for (const auto &grid_cell : cells.grid_cells())
        {
          double amount = 0., volume = 0.;
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            {
              amount += cells[p].get(density) * cells.volume(p);
              volume += cells.volume(p);
            }
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            tissue.cell(p).set(density, amount / volume);
        }
    }

  private:
    const Column<double> density;
  };

  template <int dim>
  class Sharing : public Equation<dim>
  {
  public:
    using Parameters = SharingKeys;

    Sharing(const Parameters &parameters, const EffectSetting<dim> &setting)
      : initial(parameters.initial.expression(dim))
      , density(setting.columns.template add<double>(
          {"shared",
           "",
           "what the cells of a grid cell share",
           0.,
           AtDivision::copied,
           true}))
    {}

    std::unique_ptr<EquationInRun<dim>>
    in_run(const RunTools<dim> &) const override
    {
      return std::make_unique<SharingInRun<dim>>(density);
    }

    bool
    is_steady() const override
    {
      return true;
    }

    bool
    is_transient() const override
    {
      return false;
    }

    void
    begin(const PresentCell<dim> &,
          const CellView<dim, double> &cell) const override
    {
      cell.set(density, initial.value(cell.founder_position(), 0.));
    }

    std::vector<Column<double>>
    densities() const override
    {
      return {density};
    }

    void
    declare(Tables<dim> &tables) const override
    {
      tables.add_sum("amount_shared", [this](const PresentCell<dim> &cell) {
        return cell.cell().get(density) * cell.cell().volume();
      });
    }

  private:
    Expression     initial;
    Column<double> density;
  };
} // namespace Own

#endif
