// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_state_columns_h
#define morula_effects_state_state_columns_h

#include <morula/base/expression.h>
#include <morula/base/expression_key.h>
#include <morula/particles/cell_state.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** A variable of expressions that tells of a cell's neighbours:
   *  doc/theory.md, section 12.1. */
  struct NeighbourVariable
  {
    /** What it tells. */
    enum Kind
    {
      count,         // neighbours
      count_of_type, // neighbours_NAME
      share_of_type, // touching_NAME
      unlike,        // share of the surface that touches other types
      free,          // share that is free surface
      around,        // around_VAR, a mean over the neighbours
      slope          // slope_NAME, length of a field's gradient
    };

    /** Its name in scenes. */
    std::string name;
    Kind        kind;
    /** Number of the type, or of the field. */
    unsigned int number = 0;
    /** Of which it is the mean. */
    Variable variable = Variable::t;
  };

  /** The variable of this name, if it is one. @param types names of the cells'
   *  types @param own names of the fields, and then of the numbers of cells
   *  @param n_fields how many of them are fields */
  std::optional<NeighbourVariable>
  neighbour_variable(const std::string              &name,
                     const std::vector<std::string> &types,
                     const std::vector<std::string> &own,
                     const unsigned int              n_fields);

  /** Whether a name begins as that of such a variable does, so that it must be
   *  meant to be one. */
  bool
  tells_of_neighbours(const std::string &name);

  /**
   * The columns behind the variables of expressions. A column takes storage
   * only if some expression of the scene uses it: effects pass their
   * expressions to use() when they are made, then declare() is called.
   */
  template <int dim>
  class StateColumns
  {
  public:
    /**
     * @param types  names of the cells' types; empty: there are none
     * @param fields names of the fields by their numbers
     * @param numbers names of the columns that are variables; as these they
     *        follow the fields
     * @param neighbours what expressions say of a cell's neighbours; as
     *        variables they follow the numbers
     */
    explicit StateColumns(
      const std::vector<std::string>       &types      = {},
      const std::vector<std::string>       &fields     = {},
      const std::vector<std::string>       &numbers    = {},
      const std::vector<NeighbourVariable> &neighbours = {});

    /** The key's expression, whose variables cells will have. An effect takes
     *  all its expressions of cells from here. @param by_all whether any cell
     *  may evaluate it: it is tried at all founders. @throws InputError */
    Expression
    use(const ExpressionKey &key, const bool by_all = true)
    {
      // The list stays sorted, as uses() searches it by halves and any_in_use()
      // looks at its last entry.
      const Expression &expression = key.expression(dim);
      for (const Variable variable : expression.used())
        need(variable);
      if (by_all)
        of_all.emplace_back(expression, std::min(key.components(), 1u * dim));
      return expression;
    }

    /** Asks for a variable, for code that reads it without an expression. */
    void
    need(const Variable variable)
    {
      if (!uses(variable))
        used.insert(std::upper_bound(used.begin(), used.end(), variable),
                    variable);
    }

    /** Asks for the outward normal of the surface nearest to the founder, at t
     *  = 0: the column `surface_normal`. */
    void
    need_surface_normal()
    {
      needs_normal = true;
    }

    /** Asks for the gradient of a field at the cells. @return the field's
     *  number */
    unsigned int
    need_gradient(const std::string &field)
    {
      const unsigned int k =
        std::find(names_of_fields.begin(), names_of_fields.end(), field) -
        names_of_fields.begin();
      // An effect that is only made to check its keys may have no fields around
      // it; then the number is past the end and is never used.
      if (k < needs_gradient.size())
        needs_gradient[k] = true;
      return k;
    }

    /** Declares the columns of the fields. */
    void
    declare_fields(CellColumns<dim> &columns);

    /** Declares the column `type`, if there are types. */
    void
    declare_types(CellColumns<dim> &columns)
    {
      // The column of the type comes first of all, before effects are made:
      // their expressions may compare it.
      if (!types.empty())
        type = columns.template add<unsigned int>({"type",
                                                   "",
                                                   "number of the cell's type",
                                                   0,
                                                   AtDivision::copied,
                                                   true});
    }

    /** Declares the other columns that are needed, when all expressions are
     *  known. */
    void
    declare(CellColumns<dim> &columns);

    /** Whether a column needs the surface near the founders. */
    bool
    needs_surface() const
    {
      return depth.exists() || present_depth.exists() ||
             surface_normal.exists();
    }

    /** Whether some expression uses the variable. */
    bool
    uses(const Variable variable) const
    {
      return std::binary_search(used.begin(), used.end(), variable);
    }

    /** Whether some expression depends on a cell's strain, stress or size. */
    bool
    feels_strain() const
    {
      return std::any_of(used.begin(), used.end(), [](const Variable v) {
        return v >= Variable::volume && v <= Variable::energy;
      });
    }

    /** Whether some expression depends on more than place and time, or there
     * are types. */
    bool
    any_in_use() const
    {
      // X, Y, Z and t come first in the order of variables and need no row of
      // the cell. So the last of the sorted variables decides.
      return !types.empty() || (!used.empty() && used.back() > Variable::t);
    }

    /** The expressions that any cell may evaluate, and how many components they
     *  have. */
    const std::vector<std::pair<Expression, unsigned int>> &
    expressions() const
    {
      return of_all;
    }

    /** Names of the types in the order of their numbers. */
    const std::vector<std::string> &
    type_names() const
    {
      return types;
    }

    /** Names of the fields in the order of their numbers. */
    const std::vector<std::string> &
    field_names() const
    {
      return names_of_fields;
    }

    /** What expressions say of a cell's neighbours, by number. */
    const std::vector<NeighbourVariable> &
    neighbour_variables() const
    {
      return of_neighbours;
    }

    /** The columns that are variables, with their names. @param cell whose
     *  values these are; none: 0 */
    std::vector<std::pair<std::string, double>>
    named_numbers(const CellView<dim, const double> *cell = nullptr) const
    {
      std::vector<std::pair<std::string, double>> list;
      for (std::size_t k = 0; k < names_of_numbers.size(); ++k)
        list.emplace_back(names_of_numbers[k],
                          cell != nullptr ? cell->get(numbers[k]) : 0.);
      return list;
    }

    /** How many variables of the scene's own come before those. */
    unsigned int
    n_before_neighbours() const
    {
      return names_of_fields.size() + names_of_numbers.size();
    }

    /** The values of neighbour_variables() at the cell. Slopes of fields follow
     *  from the fields' gradients and have no column. */
    std::vector<Column<double>> neighbours;
    /** Values of the scene's fields at the cell, by the fields' numbers. */
    std::vector<Column<double>> fields;
    /** The columns of effects that are variables. */
    std::vector<Column<double>> numbers;
    /** Whether a cell takes the amount of a field along when it exchanges its
     *  place, by the fields' numbers. */
    std::vector<bool> carried;
    /** The fields' gradients, in the configuration in which they were solved,
     *  per µm. Only columns that need_gradient() asked for exist. */
    std::vector<Column<Tensor<1, dim>>> gradients;
    /** Number of the cell's type. */
    Column<unsigned int> type;
    /** When the cell got its type, day. */
    Column<double> type_since;
    /** When the cell was born, day; founders: 0. */
    Column<double> birth_time;
    /** Distance of the founder from the surface at t = 0, µm. */
    Column<double> depth;
    /** Distance of the cell from the surface at the step's beginning, µm. */
    Column<double> present_depth;
    /** Outward unit normal of the boundary point nearest to the founder, at t =
     *  0. */
    Column<Tensor<1, dim>> surface_normal;

  private:
    std::vector<std::string>       types;
    std::vector<std::string>       names_of_fields, names_of_numbers;
    std::vector<NeighbourVariable> of_neighbours;
    std::vector<bool>              needs_gradient; // by field
    std::vector<std::pair<Expression, unsigned int>> of_all;
    std::vector<Variable>                            used; // sorted
    bool                                             needs_normal = false;
  };

  /** The surface near a place. */
  template <int dim>
  struct NearSurface
  {
    /** Distance from the plane of the nearest boundary point, µm; 0 outside. */
    double depth = 0.;
    /** Outward unit normal there. */
    Tensor<1, dim> normal;
  };

  /**
   * The surface near each place, at t = 0, over all ranks' boundary points.
   * Without boundary points the surface is infinitely far. Collective.
   * @param places  µm
   * @param points  positions of this rank's boundary points, µm
   * @param normals their outward unit normals
   */
  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface(const std::vector<Point<dim>>     &places,
               const std::vector<Point<dim>>     &points,
               const std::vector<Tensor<1, dim>> &normals,
               const MPI_Comm                     comm);
} // namespace Morula

#endif
