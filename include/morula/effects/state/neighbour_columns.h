// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_neighbour_columns_h
#define morula_effects_state_neighbour_columns_h

#include <morula/base/expression_key.h>
#include <morula/effects/effect.h>
#include <morula/effects/state/state_columns.h>
#include <morula/particles/neighbours.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** A cell beside another. */
  struct CellBeside
  {
    /** Number of its type. */
    unsigned int type;
    /** S of the facet between them, µm^(dim-1). */
    double area;
  };

  /** The value of a variable that follows from the types of a cell and of those
   *  beside it, doc/theory.md, section 12.1; nothing if it does not.
   *  @param own     number of the cell's type
   *  @param surface area of all of its surface */
  std::optional<double>
  of_types(const NeighbourVariable       &told,
           const unsigned int             own,
           const std::vector<CellBeside> &beside,
           const double                   surface);

  /** Whether of_types() has a value for it. */
  bool
  follows_types(const NeighbourVariable &told);

  /** Whether of_types() has a value for a variable of expressions. */
  template <int dim>
  bool
  is_type_around(const Variable variable, const StateColumns<dim> &columns);

  /** Whether an expression has such a variable. */
  template <int dim>
  bool
  reads_types_around(const Expression        &expression,
                     const StateColumns<dim> &columns);

  /**
   * The types of the cells around one in a step, in which they may change:
   * doc/theory.md, section 12.1. Refers to columns that must outlive it.
   */
  template <int dim>
  class TypesAround
  {
  public:
    /** A change of the type of one of them. */
    struct Change
    {
      double       time; // day
      unsigned int which, type;
      /** Whether it counts for an event of the cell at the same time. */
      bool comes_first;
    };

    /** @param beside  with their types at the beginning of the step
     *  @param changes in any order
     *  @param surface as in of_types() */
    TypesAround(const StateColumns<dim> &columns,
                std::vector<CellBeside>  beside,
                std::vector<Change>      changes,
                const double             surface);

    /** Number of changes. */
    std::size_t
    size() const
    {
      return changes.size();
    }

    /** How many changes count at the beginning @p t (day) of the step. */
    std::size_t
    n_before(const double t) const
    {
      const auto end =
        std::find_if(changes.begin(), changes.end(), [t](const Change &change) {
          return change.time > t || !change.comes_first;
        });
      return end - changes.begin();
    }

    /** When change number @p k happens, day. */
    double
    time(const std::size_t k) const
    {
      return changes[k].time;
    }

    /** Sets the columns of the cell as they are after its first @p k changes.
     */
    void
    set(const CellView<dim, double> &row, const std::size_t k) const;

  private:
    const StateColumns<dim> &columns;
    std::vector<CellBeside>  beside;
    std::vector<Change>      changes;
    double                   surface;
  };

  /** Section "Neighbours". */
  struct NeighbourParameters : public EffectKeys
  {
    Key<std::string> found_by{
      {this, "Neighbours/Found by"},
      "facets",
      "Which cells are neighbours: facets: those whose Voronoi cells "
      "touch; radius: those that are near, in 3-D much cheaper, but "
      "shares of the surface are estimates then.",
      {"facets|radius"}};

    Key<double> reach{
      {this, "Neighbours/Reach"},
      1.8,
      "Distance of the farthest neighbour across a gap: beyond it no free "
      "surface may lie between. With Found by = radius that of any, 1.5 "
      "unless it is set. At most 2.5. Units: mean cell spacings.",
      {},
      {[](const double value) { return value > 0. && value <= 2.5; },
       "a value > 0, at most 2.5",
       "Cells that far apart do not touch."}};

    /** What the scene's expressions say of neighbours. */
    std::vector<NeighbourVariable> variables;

    /** How they are found. */
    NeighbourSearch
    search() const;

    bool
    is_on() const override
    {
      return std::any_of(variables.begin(),
                         variables.end(),
                         [](const NeighbourVariable &told) {
                           return told.kind != NeighbourVariable::slope;
                         });
    }
    /**
     * Looks for names of such variables in the texts of keys, and lets the keys
     * use them besides the fields.
     * @param keys of cells
     * @throws InputError for one that does not exist, or stands in a key on
     *         which the stress depends
     */
    void
    see(const SceneKeys                    &scene,
        const std::vector<ExpressionKey *> &keys) override;
  };
} // namespace Morula

#endif
