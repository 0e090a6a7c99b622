// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_state_columns_h
#define morula_effects_state_state_columns_h

#include <morula/base/expression_key.h>
#include <morula/particles/cell_state.h>

#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * The columns behind the variables of expressions. Only what some expression
   * of the scene uses takes storage: effects name their expressions to use()
   * when they are made, then declare() is called.
   */
  template <int dim>
  class StateColumns
  {
  public:
    /** @param types names of the cells' types; empty: there are none */
    explicit StateColumns(const std::vector<std::string> &types = {});

    /** The key's expression, whose variables cells will have. An effect takes
     *  all its expressions of cells from here. @throws InputError */
    Expression
    use(const ExpressionKey &key);

    /** Asks for the outward normal of the surface nearest to the founder, at t
     *  = 0: the column `surface_normal`. */
    void
    need_surface_normal();

    /** Declares the column `type`, if there are types. */
    void
    declare_types(CellColumns<dim> &columns);

    /** Declares the other columns that are needed, when all expressions are
     *  known. */
    void
    declare(CellColumns<dim> &columns);

    /** Whether founders need to know the surface near them. */
    bool
    needs_surface() const;

    /** Whether some expression uses the variable. */
    bool
    uses(const Variable variable) const;

    /** Whether some expression depends on more than place and time, or there
     * are types. */
    bool
    any_in_use() const;

    /** Names of the types in the order of their numbers. */
    const std::vector<std::string> &
    type_names() const;

    /** Number of the cell's type. */
    Column<unsigned int> type;
    /** When the cell got its type, day. */
    Column<double> type_since;
    /** When the cell was born, day; founders: 0. */
    Column<double> birth_time;
    /** Distance of the founder from the surface at t = 0, µm. */
    Column<double> depth;
    /** Outward unit normal of the boundary point nearest to the founder, at t =
     *  0. */
    Column<Tensor<1, dim>> surface_normal;

  private:
    std::vector<std::string> types;
    std::vector<Variable>    used; // sorted
    bool                     needs_normal = false;
  };
} // namespace Morula

#endif
