// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_effects_lone_cell_h
#define morula_tests_effects_lone_cell_h


namespace Morula
{
  /** What a scene of one cell has: effects are made with setting(), then the
   *  cell with place(), and its columns set. */
  template <int dim>
  struct LoneCell
  {
    explicit LoneCell(
      const MaterialParameters &parameters = MaterialParameters())
      : material(parameters)
      , reader{state, material, nullptr, 42, 0.}
    {
      columns.need_growth();
    }

    EffectSetting<dim>
    setting()
    {
      return {42, 1e-9, columns, state};
    }

    /** The cell from @p X, at t = 0. To be called once. */
    void
    place(const Point<dim> &X)
    {
      state.declare(columns);
      row = columns.founder(X, 1000.);
    }

    CellView<dim, double>
    cell()
    {
      return {make_array_view(row), columns};
    }

    PresentCell<dim>
    present()
    {
      return PresentCell<dim>(cell(), 0, cell().founder_position(), reader);
    }

    CellColumns<dim>    columns;
    StateColumns<dim>   state;
    TissueMaterial      material;
    CellReader<dim>     reader;
    std::vector<double> row;
  };
} // namespace Morula

#endif
